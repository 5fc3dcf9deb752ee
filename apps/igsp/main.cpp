#include <cstdlib>  // tells whether this is glibc
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "command_line.hpp"

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // What one stage gives back the next one takes again: to ask the system anew, page by page, is a fortieth of a run.
  mallopt(M_MMAP_THRESHOLD, 8 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  mallopt(M_TOP_PAD, 1 << 20);
#endif
  return igsp::cli::run(argc, argv);
}
