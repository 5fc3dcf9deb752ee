#include "pairs.hpp"

#include <array>

#include "igsp/errors.hpp"
#include "simulation/random.hpp"

namespace igsp::calibration {
namespace {

using simulation::Random;

constexpr double degree = std::numbers::pi / 180.0;

struct Ordinary {
  const char* name;
  double noise, min_distance, max_distance;  // [m]
};
// Distances from nearly the same place to where the scene ends, so that the overlap runs from 1 to 0.
constexpr std::array<Ordinary, 3> ordinary_scenes{
    {{"park", 0.005, 1.0, 30.0}, {"indoor", 0.005, 0.3, 14.0}, {"object", 0.0001, 0.05, 1.1}}};

// Two seeds of one scene are the hard ones: the same architecture elsewhere.
constexpr std::array<std::array<const char*, 2>, 8> different_scenes{{{"park", "park"},
                                                                      {"indoor", "indoor"},
                                                                      {"object", "object"},
                                                                      {"indoor", "park"},
                                                                      {"indoor", "indoor"},
                                                                      {"object", "object"},
                                                                      {"noise", "noise"},
                                                                      {"indoor", "square_room"}}};

constexpr std::array<const char*, 6> ambiguous_scenes{
    "square_room", "repetitive_corridor", "corridor", "plane", "sphere", "cylinder"};

std::uint64_t scene_seed(Random& random) {
  return random.bits() % 1'000'000;
}

bool sees_all_around(std::string_view scene) {
  return scene == "park" || scene == "indoor";
}

Recipe make_ordinary(std::uint64_t turn, Random& random) {
  const Ordinary& scene = ordinary_scenes[turn % ordinary_scenes.size()];
  Recipe recipe;
  recipe.source_scene = recipe.target_scene = scene.name;
  recipe.source_seed = recipe.target_seed = scene_seed(random);
  recipe.station_distance = random.uniform(scene.min_distance, scene.max_distance);
  recipe.noise = scene.noise * std::exp(random.uniform(std::log(0.2), std::log(5.0)));
  return recipe;
}

Recipe make_different(std::uint64_t turn, Random& random) {
  const auto& scenes = different_scenes[turn % different_scenes.size()];
  Recipe recipe;
  recipe.source_scene = scenes[0];
  recipe.target_scene = scenes[1];
  recipe.kind = recipe.source_scene == "noise" ? Kind::ambiguous : Kind::different;  // two boxes fit in 24 ways
  recipe.source_seed = scene_seed(random);
  recipe.target_seed = scene_seed(random);
  recipe.noise = recipe.source_scene == "object" ? 0.0001 : 0.005;
  return recipe;
}

Recipe make_ambiguous(std::uint64_t turn, Random& random) {
  Recipe recipe;
  recipe.kind = Kind::ambiguous;
  recipe.source_scene = recipe.target_scene = ambiguous_scenes[turn % ambiguous_scenes.size()];
  recipe.source_seed = recipe.target_seed = scene_seed(random);
  recipe.noise = recipe.source_scene == "sphere" || recipe.source_scene == "cylinder" ? 0.0001 : 0.005;
  return recipe;
}

// Of 20 pairs 12 are ordinary, 4 different, 4 ambiguous; within each kind the scenes take turns.
Recipe make_recipe(std::uint64_t number, Random& random) {
  const std::uint64_t round = number / 20, place = number % 20;
  Recipe recipe = place < 12   ? make_ordinary(12 * round + place, random)
                  : place < 16 ? make_different(4 * round + place - 12, random)
                               : make_ambiguous(4 * round + place - 16, random);
  recipe.points = static_cast<int>(std::exp(random.uniform(std::log(1'000.0), std::log(200'000.0))));
  if (random.chance(0.3)) recipe.thinning = random.uniform(0.1, 1.0);
  const bool is_sector = sees_all_around(recipe.source_scene) && sees_all_around(recipe.target_scene);
  if (is_sector && random.chance(0.4)) recipe.field_of_view_deg = random.uniform(90.0, 200.0);
  return recipe;
}

SimulationOptions options_of(const Recipe& recipe, std::uint64_t seed, int stations) {
  SimulationOptions options;
  options.stations = stations;
  options.points = recipe.points;
  // A sector keeps the number of points, as a camera would.
  if (recipe.field_of_view_deg > 0) {
    options.points = static_cast<int>(recipe.points * 360.0 / recipe.field_of_view_deg);
  }
  options.noise = recipe.noise;
  options.station_distance = recipe.station_distance;
  options.seed = seed;
  return options;
}

// Where the scene has no places so far apart, nearer ones.
std::vector<SimulatedScan> two_stations(Recipe& recipe) {
  for (;;) {
    try {
      return simulate(recipe.source_scene, options_of(recipe, recipe.source_seed, 2));
    } catch (const InvalidArgument&) {
      if (recipe.station_distance < 0.1) throw;
      recipe.station_distance *= 0.7;
    }
  }
}

template <typename Keep>
void filter(SimulatedScan& scan, const Keep& keep) {
  std::erase_if(scan.points, [&](const Eigen::Vector3d& point) { return !keep(point); });
}

void keep_sector(SimulatedScan& scan, double field_of_view_deg, Random& random) {
  const double middle = random.angle(), least = std::cos(0.5 * field_of_view_deg * degree);
  const Eigen::Vector2d ahead{std::cos(middle), std::sin(middle)};
  filter(scan, [&](const Eigen::Vector3d& p) { return p.head<2>().dot(ahead) > least * p.head<2>().norm(); });
}

void move(SimulatedScan& scan, Random& random) {
  Transformation motion = Transformation::Identity();
  motion.linear() = random.rotation();
  motion.translation() = 20.0 * random.direction();
  for (Eigen::Vector3d& point : scan.points) point = motion * point;
  if (scan.viewpoint) scan.viewpoint = motion * *scan.viewpoint;
  scan.world_from_scanner = scan.world_from_scanner * motion.inverse();
}

}  // namespace

std::string_view to_string(Kind kind) {
  return kind == Kind::ordinary ? "ordinary" : kind == Kind::different ? "different" : "ambiguous";
}

Pair make_pair(std::uint64_t number, std::uint64_t seed) {
  Random random(seed, number);
  Pair pair;
  pair.recipe = make_recipe(number, random);
  Recipe& recipe = pair.recipe;
  if (!recipe.is_one_scene()) {
    pair.source = simulate(recipe.source_scene, options_of(recipe, recipe.source_seed, 1)).front();
    pair.target = simulate(recipe.target_scene, options_of(recipe, recipe.target_seed, 1)).front();
  } else {
    std::vector<SimulatedScan> scans = two_stations(recipe);
    pair.source = std::move(scans[1]);
    pair.target = std::move(scans[0]);
  }
  if (recipe.field_of_view_deg > 0) {
    keep_sector(pair.source, recipe.field_of_view_deg, random);
    keep_sector(pair.target, recipe.field_of_view_deg, random);
  }
  if (recipe.thinning < 1) filter(pair.source, [&](const Eigen::Vector3d&) { return random.chance(recipe.thinning); });
  move(pair.source, random);
  pair.truth = pair.target.world_from_scanner.inverse() * pair.source.world_from_scanner;
  return pair;
}

}  // namespace igsp::calibration
