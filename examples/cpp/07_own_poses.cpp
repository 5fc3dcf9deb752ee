// Your own search, igsp's judgement: poses from elsewhere are refined and judged. 07_own_poses SOURCE TARGET
#include <igsp/igsp.hpp>
#include <iostream>
#include <numbers>
#include <optional>

int main(int, char** argv) {
  igsp::Options options;
  options.scale.voxel_size = 0.5;
  const igsp::Features source = igsp::extract_features(igsp::read_points(argv[1]), options),
                       target = igsp::extract_features(igsp::read_points(argv[2]), options);

  // Stands for what you have: odometry, a floor plan, another program. Here: the answer, wrong by up to 3 degrees and
  // 0.6 units, among eight poses that are far off.
  const igsp::Transformation right = igsp::align(source, target, options).target_from_source;
  std::optional<igsp::Result> best;
  for (int i = 0; i < 9; ++i) {
    igsp::Transformation guess = right;
    guess.rotate(Eigen::AngleAxisd((i == 4 ? 3 : 40.0 * i) * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()));
    guess.pretranslate(Eigen::Vector3d(i == 4 ? 0.6 : 2.0 * (i + 1), 0, 0));
    const igsp::Result result = igsp::align(source, target, guess, options);
    std::cout << "guess " << i << ": " << result.reason << "\n";
    if (result.registered && (!best || result.confidence > best->confidence)) best = result;
  }
  if (!best) return 1;
  std::cout << best->target_from_source.matrix() << "\n";
}
