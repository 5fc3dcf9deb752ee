// One scan against many: what depends on a cloud alone is computed once. 04_features_once TARGET SOURCE...
#include <igsp/igsp.hpp>
#include <iostream>

int main(int argc, char** argv) {
  igsp::Options options;
  options.scale.voxel_size = 0.5;  // one for all clouds
  const igsp::Features target = igsp::extract_features(igsp::read_points(argv[1]), options);
  igsp::write_features("target.features", target);  // for another process, another day

  int refused = 0;
  for (int i = 2; i < argc; ++i) {
    const igsp::Features source = igsp::extract_features(igsp::read_points(argv[i]), options);
    const igsp::Result result = igsp::align(source, target, options);
    std::cout << argv[i] << ": " << result.reason << "\n";
    refused += !result.registered;
  }
  return refused;
}
