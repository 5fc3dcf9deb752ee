// Options, progress, and giving up in time: 03_options_and_progress SOURCE TARGET
#include <chrono>
#include <igsp/igsp.hpp>
#include <iostream>

int main(int, char** argv) {
  igsp::Options options = igsp::preset("default");
  options.degrees_of_freedom = 4;  // levelled scanners: yaw and translation only
  options.scale.voxel_size = 0.3;  // in the unit of the clouds; 0 chooses it
  options.threads = 2;             // the answer is the same for any number

  const auto start = std::chrono::steady_clock::now();
  const igsp::ProgressCallback progress = [&](const igsp::Progress& now) {
    std::cerr << now.stage << " " << static_cast<int>(100 * now.fraction) << " %\r";
    return std::chrono::steady_clock::now() - start < std::chrono::minutes(1);  // false: igsp::Cancelled is thrown
  };
  try {
    const igsp::Result result = igsp::align(igsp::read_points(argv[1]), igsp::read_points(argv[2]), options, progress);
    std::cout << result.reason << "\n";
    return result.registered ? 0 : 1;
  } catch (const igsp::Cancelled&) {
    std::cout << "given up after a minute\n";
    return 1;
  }
}
