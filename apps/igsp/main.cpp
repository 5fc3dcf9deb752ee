#include "command_line.hpp"

int main(int argc, char** argv) {
  return igsp::cli::run(argc, argv);
}
