#include "simulation/scene.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "igsp/errors.hpp"

namespace igsp::simulation {
namespace {

using Build = Scene (*)(Random&);
constexpr std::array<std::pair<std::string_view, Build>, 10> scenes{{{"park", build_park},
                                                                     {"indoor", build_indoor},
                                                                     {"object", build_object},
                                                                     {"plane", build_plane},
                                                                     {"sphere", build_sphere},
                                                                     {"cylinder", build_cylinder},
                                                                     {"corridor", build_corridor},
                                                                     {"square_room", build_square_room},
                                                                     {"repetitive_corridor", build_repetitive_corridor},
                                                                     {"noise", build_noise}}};

}  // namespace

Scene build_scene(std::string_view name, std::uint64_t seed) {
  std::string known;
  for (const auto& [scene_name, build] : scenes) {
    if (scene_name == name) {
      Random random(seed);
      return build(random);
    }
    known += fmt::format("{}{}", known.empty() ? "" : ", ", scene_name);
  }
  throw InvalidArgument(fmt::format("scene '{}' is unknown; choose one of: {}", name, known));
}

}  // namespace igsp::simulation
