// Where the scanners stood, said or found: 05_viewpoints SOURCE TARGET
#include <igsp/igsp.hpp>
#include <iostream>

igsp::Scan with_viewpoint(const igsp::LoadedCloud& cloud) {
  // What the file says, else its origin if the cloud looks like one scan from there.
  const igsp::ViewpointFinding found = igsp::find_viewpoint(cloud.points, {}, cloud.viewpoint);
  std::cout << found.reason << "\n";
  return {cloud.points, found.viewpoint};
}

int main(int, char** argv) {
  const igsp::LoadedCloud source = igsp::read_points(argv[1]), target = igsp::read_points(argv[2]);
  const igsp::Result result = igsp::align(with_viewpoint(source), with_viewpoint(target));
  std::cout << result.reason << "\n";
  // Of the points that the other scanner had in view, how many lie in space that it saw through.
  if (result.evidence.free_space.source) std::cout << result.evidence.free_space.violation() << "\n";
  return result.registered ? 0 : 1;
}
