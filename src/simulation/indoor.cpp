#include <numbers>
#include <optional>

#include "simulation/building.hpp"
#include "simulation/furniture.hpp"
#include "simulation/scene.hpp"

namespace igsp::simulation {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double inner_wall = 0.14, outer_wall = 0.35;  // thickness [m]

enum Wall { corridor_wall, right_wall, window_wall, left_wall };

/// A room's floor [0, width] x [0, depth] in its frame `at`, and what already stands on it.
struct Room {
  Isometry3d at;
  double width, depth, height;
  std::vector<AlignedBox2d> occupied;

  /// Reserves the footprint under `frame` (as in furniture.hpp); false when it does not fit.
  bool reserve(const Isometry3d& frame, Footprint size, double gap) {
    AlignedBox2d box;
    for (const double x : {-0.5 * size.width - gap, 0.5 * size.width + gap}) {
      for (const double y : {0.0, size.depth + gap}) box.extend((frame * Vector3d{x, y, 0}).head<2>());
    }
    const Vector2d margin = Vector2d::Constant(gap + 1e-6);
    if (!AlignedBox2d(-margin, Vector2d{width, depth} + margin).contains(box)) return false;
    for (const AlignedBox2d& other : occupied) {
      if (other.intersects(box)) return false;
    }
    occupied.push_back(box);
    return true;
  }
};

std::optional<Isometry3d> place_at_wall(Room& room, Wall wall, Footprint size, Random& random) {
  const double half_turn = std::numbers::pi;
  for (int i = 0; i < 12; ++i) {
    const double x = random.uniform(0.0, room.width), y = random.uniform(0.0, room.depth);
    const Isometry3d frame = wall == corridor_wall ? standing_at(x, 0, 0, 0)
                             : wall == right_wall  ? standing_at(room.width, y, 0, 0.5 * half_turn)
                             : wall == window_wall ? standing_at(x, room.depth, 0, half_turn)
                                                   : standing_at(0, y, 0, -0.5 * half_turn);
    if (room.reserve(frame, size, 0.03)) return room.at * frame;
  }
  return {};
}

std::optional<Isometry3d> place_free(Room& room, Footprint size, Random& random) {
  for (int i = 0; i < 12; ++i) {
    const double x = random.uniform(0.6, room.width - 0.6), y = random.uniform(0.3, room.depth - 1.0);
    const Isometry3d frame = standing_at(x, y, 0, random.chance(0.7) ? 0.0 : random.angle());
    if (room.reserve(frame, size, 0.2)) return room.at * frame;
  }
  return {};
}

Wall tall_wall(Random& random) {
  constexpr Wall walls[] = {corridor_wall, right_wall, left_wall};
  return walls[random.integer(0, 2)];
}

void add_tall_pieces(Primitives& surfaces, Room& room, int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    const double width = random.uniform(0.6, 1.6), height = random.uniform(0.9, 2.2), deep = random.uniform(0.3, 0.5);
    const auto frame = place_at_wall(room, tall_wall(random), {width, deep}, random);
    if (!frame) continue;
    if (random.chance(0.55)) {
      add_shelf(surfaces, *frame, {width, deep}, height, random);
    } else {
      add_cabinet(surfaces, *frame, {width, deep}, height, random);
    }
  }
}

void add_table_with_chairs(Primitives& surfaces, Room& room, Random& random) {
  const Footprint size{random.uniform(1.0, 2.4), random.uniform(0.8, 1.1)};
  const bool round = random.chance(0.3);
  const auto frame = place_free(room, {size.width + 0.6, size.depth + 1.2}, random);
  if (!frame) return;
  const Isometry3d table = *frame * Eigen::Translation3d(0, 0.6, 0);
  add_table(surfaces, table, size, 0.74, round, random);
  for (double x = -0.5 * size.width + 0.4; x < 0.5 * size.width - 0.2; x += 0.65) {
    const double near = 0.15 * random.normal() - 0.35, far = size.depth + 0.35 + 0.15 * random.normal();
    const double turn = 0.4 * random.normal();
    if (random.chance(0.8)) add_chair(surfaces, table * standing_at(x, near, 0, turn), random);
    if (random.chance(0.8)) add_chair(surfaces, table * standing_at(x, far, 0, std::numbers::pi - turn), random);
  }
}

void add_ceiling(Primitives& surfaces, const Room& room, Random& random) {
  const double hang = random.chance(0.5) ? 0.05 : random.uniform(0.2, 0.5), step = random.uniform(1.8, 2.8);
  const bool round = random.chance(0.3);
  for (double x = 0.5 * step; x < room.width; x += step) {
    const Isometry3d lamp = room.at * standing_at(x, 0.5 * room.depth, room.height - hang, 0);
    if (round) {
      surfaces.push_back(make_frustum(lamp.translation(), lamp * Vector3d{0, 0, 0.12}, 0.22, 0.1));
    } else {
      surfaces.push_back(make_box(lamp, {0, 0, 0.02}, {0.3, 1.2, 0.07}));
    }
    surfaces.push_back(make_frustum(lamp.translation(), lamp * Vector3d{0, 0, hang}, 0.01, 0.01));
  }
  if (random.chance(0.3)) {  // a beam across the room
    const double x = random.uniform(0.2, 0.8) * room.width;
    surfaces.push_back(make_box(room.at, {x, 0.5 * room.depth, room.height - 0.15}, {0.3, room.depth, 0.3}));
  }
}

void add_columns(Primitives& surfaces, Room& room, int count, Random& random) {
  const double side = random.uniform(0.3, 0.5);
  const bool round = random.chance(0.5);
  for (int i = 0; i < count; ++i) {
    const auto frame = place_free(room, {side, side}, random);
    if (!frame) continue;
    const Isometry3d at = *frame * Eigen::Translation3d(0, 0.5 * side, 0);
    if (round) {
      surfaces.push_back(make_frustum(at.translation(), at * Vector3d{0, 0, room.height}, 0.5 * side, 0.5 * side));
    } else {
      surfaces.push_back(make_box(at, {0, 0, 0.5 * room.height}, {side, side, room.height}));
    }
  }
}

void furnish(Primitives& surfaces, Room& room, Random& random) {
  const double area = room.width * room.depth, crowd = random.uniform(0.6, 1.3);
  const auto pieces = [&](double per_area) { return static_cast<int>(std::lround(crowd * per_area * area)); };
  add_columns(surfaces, room, area > 25.0 ? random.integer(0, 2) : 0, random);
  add_table_with_chairs(surfaces, room, random);
  for (int i = pieces(0.08); i > 0; --i) {
    const Footprint size{random.uniform(1.2, 1.8), random.uniform(0.65, 0.85)};
    const Wall wall = random.chance(0.5) ? window_wall : tall_wall(random);
    const auto frame = place_at_wall(room, wall, {size.width, size.depth + 0.8}, random);
    if (frame) add_desk(surfaces, *frame, size, random);
  }
  add_tall_pieces(surfaces, room, pieces(0.16), random);
  if (random.chance(0.4)) {
    const Footprint size{random.uniform(1.4, 2.2), 0.85};
    const auto frame = place_at_wall(room, tall_wall(random), size, random);
    if (frame) add_sofa(surfaces, *frame, size, random);
  }
  if (const auto frame = place_at_wall(room, window_wall, {1.2, 0.15}, random)) add_radiator(surfaces, *frame, 1.1);
  for (int i = random.integer(0, 2); i > 0; --i) {
    const auto frame = place_at_wall(room, tall_wall(random), {0.5, 0.5}, random);
    if (frame) add_potted_plant(surfaces, *frame, random);
  }
  for (int i = random.integer(1, 3); i > 0; --i) {
    const auto frame = place_at_wall(room, tall_wall(random), {1.4, 0.05}, random);
    if (frame) add_picture(surfaces, *frame, random);
  }
  for (int i = pieces(0.06); i > 0; --i) {  // boxes left on the floor
    const double a = random.uniform(0.25, 0.6), b = random.uniform(0.25, 0.5), c = random.uniform(0.2, 0.6);
    const auto frame = place_free(room, {a, b}, random);
    if (frame) surfaces.push_back(make_box(*frame, {0, 0.5 * b, 0.5 * c}, {a, b, c}));
  }
  add_ceiling(surfaces, room, random);
}

/// The way a door or window opens onto one room's floor stays free.
void keep_free(Room& room, double begin, double end, double depth) {
  room.occupied.emplace_back(Vector2d{begin, -1.0}, Vector2d{end, depth});
}

/// The door of a room from the corridor: leaf open, ajar or closed; sometimes a wide passage without a leaf.
Opening add_room_door(Primitives& surfaces, const Isometry3d& side, double from, double width, Random& random) {
  const bool passage = random.chance(0.2) && width > 3.5;
  const double wide = passage ? random.uniform(1.8, 2.6) : random.uniform(0.85, 1.05);
  const double begin = from + random.uniform(0.25, width - wide - 0.25);
  const Opening door{begin, begin + wide, 0.0, passage ? 2.4 : 2.1};
  if (!passage) {
    const double angle = random.chance(0.75) ? random.uniform(0.9, 1.9) : 0.0;  // into the room
    add_door(surfaces, side * Eigen::Translation3d(0, inner_wall - 0.05, 0), door, angle, random.chance(0.5));
  }
  return door;
}

std::vector<Opening> add_room_windows(Primitives& surfaces, const Isometry3d& outer, double from, double width,
                                      Random& random) {
  std::vector<Opening> windows;
  const double sill = random.uniform(0.75, 1.0), top = random.uniform(2.0, 2.4);
  for (double x = from + random.uniform(0.3, 0.9); x + 1.0 < from + width;) {
    const double end = std::min(x + random.uniform(0.8, 1.7), from + width - 0.2);
    windows.push_back({x, end, sill, top});
    add_window(surfaces, outer, windows.back(), 0.25, random.integer(0, 1));
    x = end + random.uniform(0.4, 1.5);
  }
  return windows;
}

/// One side of the corridor in the frame `side` (x along the corridor, y away from it): rooms, walls, doors, windows.
/// The corridor's floor before each door is kept free; `mirrored` says that the corridor's frame runs the other way.
void add_side(Primitives& surfaces, const Isometry3d& side, double height, Room& corridor, bool mirrored,
              Random& random) {
  const double length = corridor.width, depth = random.uniform(4.0, 6.5);
  const Isometry3d outer = side * Eigen::Translation3d(0, inner_wall + depth, 0);
  std::vector<Opening> doors, windows;
  for (double x = 0.0; x < length - 0.1;) {
    double width = random.uniform(3.2, 7.0);
    if (length - x - width < 3.4) width = length - x;  // no leftover too narrow for a room
    Room room{side * Eigen::Translation3d(x, inner_wall, 0), width - inner_wall, depth, height, {}};
    doors.push_back(add_room_door(surfaces, side, x, room.width, random));
    const Opening& door = doors.back();
    keep_free(room, door.begin - x - 0.2, door.end - x + 0.2, 1.2);
    const auto before = [&](double along) { return mirrored ? length - along : along; };
    const double a = before(door.begin), b = before(door.end);
    corridor.occupied.emplace_back(Vector2d{std::min(a, b), -1.0}, Vector2d{std::max(a, b), 10.0});
    const auto more = add_room_windows(surfaces, outer, x, room.width, random);
    windows.insert(windows.end(), more.begin(), more.end());
    std::vector<Opening> passages;
    if (x + width < length - 0.1 && random.chance(0.35)) {
      const double begin = random.uniform(1.3, depth - 1.6);
      passages.push_back({begin, begin + random.uniform(0.9, 1.5), 0.0, 2.1});
      room.occupied.emplace_back(Vector2d{room.width - 0.8, begin}, Vector2d{room.width + 1.0, passages[0].end});
    }
    const Isometry3d across = side * standing_at(x + width, inner_wall, 0, 0.5 * std::numbers::pi);
    add_wall(surfaces, across, depth, height, inner_wall, passages);
    furnish(surfaces, room, random);
    x += width;
  }
  add_wall(surfaces, side, length, height, inner_wall, doors);
  add_wall(surfaces, outer, length, height, outer_wall, windows);
  add_wall(surfaces, side * standing_at(0, inner_wall, 0, 0.5 * std::numbers::pi), depth, height, outer_wall, {});
}

void add_corridor(Primitives& surfaces, Room& corridor, Random& random) {
  for (int i = random.integer(2, 5); i > 0; --i) {
    const double width = random.uniform(0.6, 1.2), height = random.uniform(0.7, 2.0);
    const auto frame = place_at_wall(corridor, random.chance(0.5) ? corridor_wall : window_wall, {width, 0.4}, random);
    if (frame) add_cabinet(surfaces, *frame, {width, 0.4}, height, random);
  }
  const auto plant = place_at_wall(corridor, window_wall, {0.5, 0.5}, random);
  if (plant) add_potted_plant(surfaces, *plant, random);
  const double y = random.uniform(0.3, corridor.depth - 0.3), z = corridor.height - random.uniform(0.2, 0.35);
  surfaces.push_back(make_box(corridor.at, {0.5 * corridor.width, y, z}, {corridor.width, 0.35, 0.25}));  // air duct
  add_ceiling(surfaces, corridor, random);
  // One end has a window, the other a closed door.
  const double middle = 0.5 * corridor.depth, height = corridor.height;
  const Isometry3d left = corridor.at * standing_at(0, 0, 0, 0.5 * std::numbers::pi);
  const Isometry3d right = corridor.at * standing_at(corridor.width, corridor.depth, 0, -0.5 * std::numbers::pi);
  const Opening window{middle - 0.6, middle + 0.6, 0.9, 2.2}, door{middle - 0.5, middle + 0.5, 0.0, 2.1};
  add_wall(surfaces, left, corridor.depth, height, outer_wall, {window});
  add_window(surfaces, left, window, 0.25, 1);
  add_wall(surfaces, right, corridor.depth, height, outer_wall, {door});
  add_door(surfaces, right * Eigen::Translation3d(0, 0.1, 0), door, 0.0, false);
}

}  // namespace

Scene build_indoor(Random& random) {
  const double length = random.uniform(12.0, 22.0), width = random.uniform(1.7, 2.8), height = random.uniform(2.6, 3.2);
  Primitives surfaces;
  Room corridor{standing_at(-0.5 * length, -0.5 * width, 0, 0), length, width, height, {}};
  add_side(surfaces, standing_at(-0.5 * length, 0.5 * width, 0, 0), height, corridor, false, random);
  add_side(surfaces, standing_at(0.5 * length, -0.5 * width, 0, std::numbers::pi), height, corridor, true, random);
  add_corridor(surfaces, corridor, random);
  const Isometry3d at = Isometry3d::Identity();
  const Vector3d x{length + 2.0, 0, 0}, y{0, 20.0, 0};
  for (const double z : {0.0, height}) {
    surfaces.push_back(make_parallelogram(at, {-0.5 * length - 1.0, -10.0, z}, x, y));
  }

  Scene scene;
  scene.surfaces = BoundingVolumeHierarchy(surfaces);
  const Vector2d corner{0.5 * length, 0.5 * width + 6.5};
  scene.station_area = AlignedBox2d(-corner, corner);
  scene.station_distance = random.uniform(3.0, 5.0);
  scene.max_range = 40.0;
  scene.min_clearance = 0.45;
  return scene;
}

}  // namespace igsp::simulation
