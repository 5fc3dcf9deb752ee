#include "report/page.hpp"

#include "report/scene.hpp"

namespace igsp::cli {

std::string report_page(const Json& run, PointView source, PointView target) {
  const Json data = {{"run", run}, {"scene", report_scene(run, source, target)}};
  std::string page(report_page_head);
  for (const char letter : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (letter == '<') {
      page += "\\u003c";  // nothing in the data may end the script element that it stands in
    } else {
      page += letter;
    }
  }
  page += report_page_tail;
  return page;
}

}  // namespace igsp::cli
