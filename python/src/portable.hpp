#pragma once

#include <fmt/format.h>

#include <new>
#include <string_view>

#include "archive/archive.hpp"
#include "bindings.hpp"
#include "igsp/errors.hpp"

namespace igsp::python {

/// A class whose objects can be copied, and pickled into what another process or machine reads back bit for bit.
template <typename Class>
nb::class_<Class> portable_class(nb::module_& module, const char* name, const char* doc) {
  nb::class_<Class> bound(module, name, doc);
  bound
      .def("__getstate__",
           [](const Class& self) {
             const std::string bytes = archive::pack(self);
             return nb::bytes(bytes.data(), bytes.size());
           })
      .def("__setstate__",
           [](Class& self, const nb::bytes& state) {
             try {
               new (&self) Class(archive::unpack<Class>(std::string_view(state.c_str(), state.size())));
             } catch (const archive::Fault& fault) {
               throw InvalidArgument(fmt::format("pickled {}: {}", archive::Layout<Class>::name, fault.what()));
             }
           })
      .def("__copy__", [](const Class& self) { return Class(self); })
      .def(
          "__deepcopy__", [](const Class& self, nb::handle) { return Class(self); }, nb::arg("memo").none());
  return bound;
}

}  // namespace igsp::python
