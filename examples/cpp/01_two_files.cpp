// Two files, one call: 01_two_files SOURCE TARGET
#include <igsp/igsp.hpp>
#include <iostream>

int main(int, char** argv) {
  const igsp::Result result = igsp::align(igsp::read_points(argv[1]), igsp::read_points(argv[2]));
  std::cout << result.reason << "\n";
  if (!result.registered) return 1;
  std::cout << result.target_from_source.matrix() << "\n";  // p_target = target_from_source * p_source
}
