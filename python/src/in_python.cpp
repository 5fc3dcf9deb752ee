#include "in_python.hpp"

#include <fmt/format.h>

namespace igsp::python {

std::string message_of(nb::handle error) {
  const nb::object file = nb::getattr(error, "filename", nb::none()),
                   reason = nb::getattr(error, "strerror", nb::none());
  if (file.is_none() || reason.is_none()) return nb::str(error).c_str();
  return fmt::format("{}: {}", nb::str(file).c_str(), nb::str(reason).c_str());
}

bool is_igsp_error(const nb::python_error& error, const char* name) {
  return error.matches(nb::module_::import_("igsp.errors").attr(name));
}

}  // namespace igsp::python
