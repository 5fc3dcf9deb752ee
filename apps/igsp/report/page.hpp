#pragma once

#include <string>
#include <string_view>

#include "igsp/point_cloud.hpp"
#include "report/json.hpp"

namespace igsp::cli {

/// One HTML file that opens offline: the run in words, in 3-D and in plots. `run` is what align_report gives; the
/// clouds are those of the run, thinned for the page. Throws Cancelled after an interrupt.
std::string report_page(const Json& run, const Scan& source, const Scan& target);

/// JSON as the text of a script element of a page: nothing in it may end the element.
std::string inside_script(const Json& data);

// The page before and after its data, assembled from report/ and the drawing libraries when igsp is built.
extern const std::string_view report_page_head;
extern const std::string_view report_page_tail;

}  // namespace igsp::cli
