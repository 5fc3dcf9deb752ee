#include "shell/standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "igsp/errors.hpp"

namespace igsp::cli {

void open_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is taken: this one. Nothing can be written to a stream that is opened for reading.
    ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void check_standard_output() {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && !std::ferror(stdout) && std::cout.good()) return;
  const int reason = errno;
  const bool closed = (fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY;  // open_closed_streams() did it
  throw FileError(fmt::format("standard output: {}; the answer is lost",
                              closed        ? "closed"
                              : reason == 0 ? "cannot be written"  // an earlier flush met the reason
                                            : std::generic_category().message(reason)));
}

}  // namespace igsp::cli
