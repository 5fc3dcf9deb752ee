// Points that your program holds, and what the answer says of them: 02_points_in_memory
#include <igsp/igsp.hpp>
#include <iostream>

int main() {
  // Any contiguous doubles x y z will do; here two scans of a made-up room.
  const auto scans = igsp::simulate("indoor", {.points = 60000, .seed = 1});
  const igsp::Points &source = scans[1].points, &target = scans[0].points;

  const igsp::Result result = igsp::align(source, target);
  std::cout << (result.registered ? "registered" : "not registered") << ", confidence " << result.confidence
            << ", overlap " << result.overlap() << ", RMSE " << result.rmse << "\n";
  if (!result.registered) return 1;

  igsp::Points moved = source;
  for (Eigen::Vector3d& point : moved) point = result.target_from_source * point;
  igsp::write_points("aligned.ply", moved);

  // How well the surfaces fix the pose: standard deviations of a small motion in the target's frame.
  std::cout << "deviations " << result.precision.covariance.diagonal().cwiseSqrt().transpose() << "\n";
}
