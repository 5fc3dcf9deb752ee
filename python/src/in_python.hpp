#pragma once

#include <new>
#include <stdexcept>
#include <string>

#include "bindings.hpp"
#include "igsp/errors.hpp"
#include "network/engine.hpp"

namespace igsp::python {

/// Without the "[Errno 2] " that Python puts before what the system says of a file.
std::string message_of(nb::handle error);

/// True of one of the classes that only Python code can name: igsp.errors.NAME.
bool is_igsp_error(const nb::python_error& error, const char* name);

/// Runs `body` with the interpreter lock. What Python raises becomes the error that the command knows how to tell.
template <typename Body>
auto in_python(const Body& body) {
  nb::gil_scoped_acquire lock;
  try {
    return body();
  } catch (nb::python_error& error) {
    const std::string message = message_of(error.value());
    if (error.matches(PyExc_KeyboardInterrupt) || is_igsp_error(error, "Cancelled")) throw Cancelled();
    if (is_igsp_error(error, "EngineLost")) throw cli::EngineLost(message);
    if (error.matches(PyExc_OSError) || error.matches(PyExc_ImportError)) throw FileError(message);
    if (error.matches(PyExc_MemoryError)) throw std::bad_alloc();
    if (error.matches(PyExc_ValueError)) throw InvalidArgument(message);
    throw std::runtime_error(error.what());  // its text must be made now, with the lock
  }
}

}  // namespace igsp::python
