#include "report/page.hpp"

#include "report/scene.hpp"

namespace igsp::cli {

std::string inside_script(const Json& data) {
  std::string text;
  for (const char letter : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (letter == '<') {
      text += "\\u003c";
    } else {
      text += letter;
    }
  }
  return text;
}

std::string report_page(const Json& run, const Scan& source, const Scan& target) {
  const Json data = {{"run", run}, {"scene", report_scene(run, source, target)}};
  return std::string(report_page_head) + inside_script(data) + std::string(report_page_tail);
}

}  // namespace igsp::cli
