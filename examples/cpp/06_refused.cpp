// A pair that cannot be registered, and why: 06_refused
#include <igsp/igsp.hpp>
#include <iostream>

int main() {
  const auto scans = igsp::simulate("park", {.points = 60000, .seed = 1});
  igsp::Points left_handed = scans[1].points;
  for (Eigen::Vector3d& point : left_handed) point.y() = -point.y();  // as some programs export

  const igsp::Result result = igsp::align(left_handed, scans[0].points);
  std::cout << (result.registered ? "registered: " : "not registered: ") << result.reason << "\n";
  for (const igsp::Diagnosis& cause : igsp::diagnose(left_handed, scans[0].points, result)) {
    std::cout << cause.description << "\n";
  }
  return result.registered ? 1 : 0;
}
