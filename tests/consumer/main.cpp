// Uses every part of the library that drags in a dependency: simulation, registration, files.
#include <filesystem>
#include <iostream>

#include "igsp/igsp.hpp"

int main() {
  igsp::SimulationOptions simulation;
  simulation.points = 20000;
  const auto scans = igsp::simulate("object", simulation);

  const std::filesystem::path path = "source.pcd";
  igsp::write_points(path, scans[0].points, {.format = igsp::FileFormat::pcd_binary_compressed});
  const igsp::LoadedCloud source = igsp::read_points(path);

  const igsp::Result result = igsp::align(source.points, scans[1].points);
  const igsp::Transformation truth = scans[1].world_from_scanner.inverse() * scans[0].world_from_scanner;
  const igsp::PoseError error = igsp::pose_error(result.target_from_source, truth, Eigen::Vector3d::Zero());
  std::cout << "igsp " << igsp::version << ": " << (result.registered ? "registered" : "not registered") << ", "
            << result.reason << "\n"
            << result.target_from_source.matrix() << "\nerror " << error.rotation_rad << " rad, " << error.translation
            << " m\n";
  return result.registered && error.rotation_rad < 0.01 && error.translation < 0.002 ? 0 : 1;
}
