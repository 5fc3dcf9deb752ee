#include "simulation/building.hpp"

#include <algorithm>

namespace igsp::simulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d middle(const Opening& o, double y) {
  return {0.5 * (o.begin + o.end), y, 0.5 * (o.bottom + o.top)};
}

void add_balcony(Primitives& surfaces, const Isometry3d& at, const Opening& opening) {
  const double left = opening.begin - 0.4, right = opening.end + 0.4, out = -1.2;
  const double z = opening.bottom - 0.1, width = right - left;
  surfaces.push_back(make_box(at, {0.5 * (left + right), 0.5 * out, z}, {width, -out, 0.18}));
  surfaces.push_back(make_box(at, {0.5 * (left + right), out + 0.03, z + 1.1}, {width, 0.06, 0.06}));
  for (const double x : {left, right}) {
    surfaces.push_back(make_box(at, {x, 0.5 * out, z + 1.1}, {0.06, -out, 0.06}));
  }
  for (double x = left; x <= right + 0.01; x += width / 12.0) {
    const Vector3d foot{x, out + 0.03, z};
    surfaces.push_back(make_frustum(at * foot, at * (foot + 1.1 * Vector3d::UnitZ()), 0.02, 0.02));
  }
}

/// Windows side by side on one floor, with gaps and widths that vary.
std::vector<Opening> window_row(double length, double bottom, double top, Random& random) {
  std::vector<Opening> row;
  for (double x = random.uniform(0.6, 1.8); x + 2.2 < length;) {
    const double width = random.uniform(0.8, 1.8);
    if (random.chance(0.88)) row.push_back({x, x + width, bottom, top + random.uniform(-0.15, 0.15)});
    x += width + random.uniform(0.9, 2.4);
  }
  return row;
}

void add_entrance(Primitives& surfaces, const Isometry3d& at, const Opening& door) {
  const double x = 0.5 * (door.begin + door.end), width = door.end - door.begin;
  add_door(surfaces, at * Eigen::Translation3d(0, 0.15, 0), door, 0.0, false);
  for (int step = 0; step < 3; ++step) {
    const double out = 1.4 - 0.35 * step, top = 0.15 * (step + 1) - 0.45;
    surfaces.push_back(make_box(at, {x, -0.5 * out, top - 0.4}, {width + 1.0, out, 0.8}));
  }
  surfaces.push_back(make_box(at, {x, -0.6, door.top + 0.35}, {width + 0.8, 1.2, 0.12}));
}

void add_floor(Primitives& surfaces, const Isometry3d& at, double length, double height, bool ground, Random& random) {
  auto openings = window_row(length, ground ? 1.0 : random.uniform(0.7, 1.0), height - 0.6, random);
  std::size_t door = openings.size();
  if (ground && !openings.empty()) {
    door = random.integer(0, static_cast<int>(openings.size()) - 1);
    openings[door].bottom = 0.0;
  }
  add_wall(surfaces, at, length, height, 0.35, openings);
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (i == door) {
      add_entrance(surfaces, at, openings[i]);
      continue;
    }
    add_window(surfaces, at, openings[i], 0.2, random.integer(0, 2));
    const double width = openings[i].end - openings[i].begin, x = openings[i].begin + 0.5 * width;
    surfaces.push_back(make_box(at, {x, -0.05, openings[i].bottom - 0.04}, {width + 0.2, 0.25, 0.08}));  // sill
    if (!ground && random.chance(0.12)) add_balcony(surfaces, at, openings[i]);
  }
}

void add_roof(Primitives& surfaces, const Isometry3d& at, double length, double depth, Random& random) {
  const double ridge = random.uniform(0.0, 3.5), eaves = 0.5;  // 0: nearly flat
  const Vector3d along{length + 2.0 * eaves, 0, 0}, up{0, 0.5 * depth + eaves, ridge};
  surfaces.push_back(make_parallelogram(at, {-eaves, -eaves, 0}, along, up));
  surfaces.push_back(make_parallelogram(at, {-eaves, depth + eaves, 0}, along, {0, -up.y(), ridge}));
  surfaces.push_back(make_box(at, {0.5 * length, -0.2, -0.15}, {length + 0.4, 0.4, 0.3}));  // cornice
  const int chimneys = random.integer(0, 3);
  for (int i = 0; i < chimneys; ++i) {
    const double x = random.uniform(1.0, length - 1.0), y = random.uniform(0.2, 0.6) * depth;
    surfaces.push_back(make_box(at, {x, y, ridge}, {0.8, 0.6, 2.4}));
  }
}

}  // namespace

void add_wall(Primitives& surfaces, const Isometry3d& at, double length, double height, double thickness,
              std::vector<Opening> openings) {
  std::sort(openings.begin(), openings.end(), [](const Opening& a, const Opening& b) { return a.begin < b.begin; });
  const auto add = [&](double begin, double end, double bottom, double top) {
    if (end - begin < 1e-6 || top - bottom < 1e-6) return;
    surfaces.push_back(make_box(at, {0.5 * (begin + end), 0.5 * thickness, 0.5 * (bottom + top)},
                                {end - begin, thickness, top - bottom}));
  };
  double done = 0.0;
  for (const Opening& opening : openings) {
    add(done, opening.begin, 0.0, height);
    add(opening.begin, opening.end, 0.0, opening.bottom);
    add(opening.begin, opening.end, opening.top, height);
    done = opening.end;
  }
  add(done, length, 0.0, height);
}

void add_window(Primitives& surfaces, const Isometry3d& at, const Opening& opening, double recess, int bars) {
  const double width = opening.end - opening.begin, height = opening.top - opening.bottom, frame = 0.07;
  surfaces.push_back(make_parallelogram(at, {opening.begin, recess, opening.bottom}, {width, 0, 0}, {0, 0, height}));
  const Vector3d centre = middle(opening, recess - 0.03);
  for (const double side : {-0.5, 0.5}) {
    surfaces.push_back(make_box(at, centre + Vector3d{side * (width - frame), 0, 0}, {frame, 0.06, height}));
    surfaces.push_back(make_box(at, centre + Vector3d{0, 0, side * (height - frame)}, {width, 0.06, frame}));
  }
  for (int i = 1; i <= bars; ++i) {
    const double x = width * (static_cast<double>(i) / (bars + 1) - 0.5);
    surfaces.push_back(make_box(at, centre + Vector3d{x, 0, 0}, {0.05, 0.05, height}));
  }
}

void add_door(Primitives& surfaces, const Isometry3d& at, const Opening& opening, double angle, bool hinge_at_end) {
  const double width = opening.end - opening.begin, height = opening.top - opening.bottom;
  const double hinge = hinge_at_end ? opening.end : opening.begin, away = hinge_at_end ? -1.0 : 1.0;
  const Isometry3d leaf = at * standing_at(hinge, 0, opening.bottom, away * angle);
  surfaces.push_back(make_box(leaf, {away * 0.5 * width, 0.02, 0.5 * height}, {width - 0.02, 0.04, height - 0.02}));
  surfaces.push_back(make_box(leaf, {away * (width - 0.1), 0.02, 1.05}, {0.12, 0.16, 0.03}));  // handles, both sides
}

void add_building(Primitives& surfaces, const Isometry3d& at, double length, Random& random) {
  const int floors = random.integer(2, 4);
  const double floor_height = random.uniform(2.9, 3.6), plinth = 0.45, depth = random.uniform(8.0, 12.0);
  surfaces.push_back(make_box(at, {0.5 * length, 0.15, plinth - 0.75}, {length + 0.1, 0.5, 1.5}));
  for (int floor = 0; floor < floors; ++floor) {
    const Isometry3d level = at * Eigen::Translation3d(0, 0, plinth + floor * floor_height);
    add_floor(surfaces, level, length, floor_height, floor == 0, random);
    surfaces.push_back(make_box(level, {0.5 * length, -0.04, floor_height - 0.1}, {length + 0.2, 0.14, 0.12}));
  }
  const double height = plinth + floors * floor_height;
  for (const double x : {0.0, length}) {
    surfaces.push_back(make_box(at, {x, 0.5 * depth, 0.5 * height - 0.5}, {0.3, depth, height + 1.0}));
  }
  const int pipes = random.integer(1, 3);
  for (int i = 0; i < pipes; ++i) {
    const double x = random.uniform(0.2, length - 0.2);
    surfaces.push_back(make_frustum(at * Vector3d{x, -0.12, -0.5}, at * Vector3d{x, -0.12, height}, 0.06, 0.06));
  }
  add_roof(surfaces, at * Eigen::Translation3d(0, 0, height), length, depth, random);
}

}  // namespace igsp::simulation
