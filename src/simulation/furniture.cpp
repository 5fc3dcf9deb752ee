#include "simulation/furniture.hpp"

#include "simulation/vegetation.hpp"

namespace igsp::simulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Frustum rod(const Isometry3d& at, const Vector3d& from, const Vector3d& to, double radius) {
  return make_frustum(at * from, at * to, radius, radius);
}

}  // namespace

void add_clutter(Primitives& surfaces, const Isometry3d& at, Footprint size, double y, double z, int pieces,
                 Random& random) {
  for (int i = 0; i < pieces; ++i) {
    const double px = random.uniform(-0.4, 0.4) * size.width, py = y + random.uniform(-0.35, 0.35) * size.depth;
    const Isometry3d place = at * standing_at(px, py, z, random.angle());
    const double a = random.uniform(0.06, 0.3), b = random.uniform(0.06, 0.22), c = random.uniform(0.02, 0.25);
    if (random.chance(0.65)) {
      surfaces.push_back(make_box(place, {0, 0, 0.5 * c}, {a, b, c}));
    } else {
      surfaces.push_back(make_frustum(place * Vector3d::Zero(), place * Vector3d{0, 0, c + 0.05}, 0.05, 0.04));
    }
  }
}

void add_table(Primitives& surfaces, const Isometry3d& at, Footprint size, double height, bool round, Random& random) {
  const Isometry3d middle = at * Eigen::Translation3d(0, 0.5 * size.depth, 0);
  if (round) {
    const double radius = 0.5 * std::min(size.width, size.depth);
    surfaces.push_back(rod(middle, {0, 0, height - 0.03}, {0, 0, height}, radius));
    surfaces.push_back(rod(middle, {0, 0, 0}, {0, 0, height}, 0.05));
    surfaces.push_back(rod(middle, {0, 0, 0}, {0, 0, 0.04}, 0.6 * radius));
  } else {
    surfaces.push_back(make_box(middle, {0, 0, height - 0.02}, {size.width, size.depth, 0.04}));
    for (const double x : {-0.46, 0.46}) {
      for (const double y : {-0.44, 0.44}) {
        const Vector3d leg{x * size.width, y * size.depth, 0.5 * height - 0.02};
        surfaces.push_back(make_box(middle, leg, {0.06, 0.06, height - 0.04}));
      }
    }
  }
  add_clutter(surfaces, at, size, 0.5 * size.depth, height, random.integer(0, 6), random);
}

void add_chair(Primitives& surfaces, const Isometry3d& at, Random& random) {
  const Isometry3d seat = at * Eigen::Translation3d(0, 0.25, 0);
  surfaces.push_back(make_box(seat, {0, 0, 0.45}, {0.44, 0.44, 0.05}));
  if (random.chance(0.5)) {
    for (const double x : {-0.19, 0.19}) {
      for (const double y : {-0.19, 0.19}) surfaces.push_back(rod(seat, {x, y, 0}, {x, y, 0.45}, 0.018));
      surfaces.push_back(rod(seat, {x, -0.2, 0.45}, {x, -0.24, 0.92}, 0.016));
    }
  } else {
    surfaces.push_back(rod(seat, {0, 0, 0.08}, {0, 0, 0.45}, 0.03));
    for (int i = 0; i < 5; ++i) {
      const double azimuth = 1.2566 * i;
      surfaces.push_back(rod(seat, {0, 0, 0.1}, {0.28 * std::cos(azimuth), 0.28 * std::sin(azimuth), 0.05}, 0.02));
    }
    surfaces.push_back(rod(seat, {0, -0.2, 0.4}, {0, -0.24, 0.75}, 0.03));
  }
  surfaces.push_back(make_box(seat, {0, -0.24, 0.78}, {0.42, 0.04, 0.34}));
}

void add_desk(Primitives& surfaces, const Isometry3d& at, Footprint size, Random& random) {
  add_table(surfaces, at, size, 0.74, false, random);
  const double drawer = random.sign() * (0.5 * size.width - 0.27);
  surfaces.push_back(make_box(at, {drawer, 0.5 * size.depth, 0.3}, {0.42, 0.55, 0.56}));
  const int monitors = random.integer(1, 2);
  for (int i = 0; i < monitors; ++i) {
    const double x = 0.6 * (i - 0.5 * (monitors - 1)) + 0.1 * random.normal();
    const Isometry3d stand = at * standing_at(x, 0.22, 0.74, 0.2 * random.normal());
    surfaces.push_back(make_box(stand, {0, 0, 0.34}, {0.54, 0.04, 0.33}));
    surfaces.push_back(make_box(stand, {0, -0.02, 0.12}, {0.06, 0.03, 0.24}));
    surfaces.push_back(make_box(stand, {0, 0, 0.01}, {0.24, 0.18, 0.02}));
  }
  const double x = 0.2 * random.normal(), turn = 3.1416 + 0.5 * random.normal();
  add_chair(surfaces, at * standing_at(x, size.depth + 0.45, 0, turn), random);
}

void add_shelf(Primitives& surfaces, const Isometry3d& at, Footprint size, double height, Random& random) {
  const double board = 0.025, y = 0.5 * size.depth;
  for (const double x : {-0.5, 0.5}) {
    surfaces.push_back(make_box(at, {x * (size.width - board), y, 0.5 * height}, {board, size.depth, height}));
  }
  const int boards = random.integer(3, 6);
  for (int i = 0; i <= boards; ++i) {
    const double z = 0.05 + (height - 0.07) * i / boards, space = (height - 0.07) / boards;
    surfaces.push_back(make_box(at, {0, y, z}, {size.width, size.depth, board}));
    if (i == boards) break;
    for (double x = -0.5 * size.width + 0.03; x < 0.5 * size.width - 0.35;) {  // books and boxes in a row, with gaps
      const double width = random.chance(0.7) ? random.uniform(0.02, 0.08) : random.uniform(0.15, 0.32);
      const double tall = space * random.uniform(0.4, 0.85), deep = size.depth * random.uniform(0.5, 0.9);
      surfaces.push_back(make_box(at, {x + 0.5 * width, 0.5 * deep + 0.01, z + 0.5 * tall}, {width, deep, tall}));
      x += width + (random.chance(0.2) ? random.uniform(0.05, 0.35) : 0.004);
    }
  }
  if (random.chance(0.6)) surfaces.push_back(make_box(at, {0, 0.01, 0.5 * height}, {size.width, 0.02, height}));
}

void add_cabinet(Primitives& surfaces, const Isometry3d& at, Footprint size, double height, Random& random) {
  const double y = 0.5 * size.depth;
  surfaces.push_back(make_box(at, {0, y - 0.02, 0.04}, {size.width - 0.04, size.depth - 0.04, 0.08}));
  surfaces.push_back(make_box(at, {0, y, 0.5 * height + 0.04}, {size.width, size.depth, height - 0.08}));
  const int doors = std::max(1, static_cast<int>(size.width / 0.5));
  for (int i = 0; i < doors; ++i) {
    const double x = size.width * ((i + 0.5) / doors - 0.5), leaf = size.width / doors - 0.03;
    surfaces.push_back(make_box(at, {x, size.depth + 0.01, 0.5 * height + 0.04}, {leaf, 0.02, height - 0.14}));
    surfaces.push_back(make_box(at, {x + 0.4 * leaf, size.depth + 0.04, 0.55 * height}, {0.02, 0.04, 0.15}));
  }
  add_clutter(surfaces, at, size, y, height, random.integer(0, 3), random);
}

void add_sofa(Primitives& surfaces, const Isometry3d& at, Footprint size, Random& random) {
  surfaces.push_back(make_box(at, {0, 0.5 * size.depth, 0.22}, {size.width, size.depth, 0.32}));
  surfaces.push_back(make_box(at, {0, 0.1, 0.6}, {size.width, 0.2, 0.5}));
  for (const double x : {-0.5, 0.5}) {
    surfaces.push_back(make_box(at, {x * (size.width - 0.18), 0.5 * size.depth, 0.45}, {0.18, size.depth, 0.3}));
  }
  const int cushions = random.integer(0, 3);
  for (int i = 0; i < cushions; ++i) {
    const Vector3d place{random.uniform(-0.4, 0.4) * size.width, 0.32, 0.55};
    const Eigen::Matrix3d tilted = at.linear() * Eigen::AngleAxisd(0.4, Vector3d::UnitX()).toRotationMatrix();
    surfaces.push_back(make_ellipsoid(at * place, tilted, {0.22, 0.09, 0.2}));
  }
}

void add_radiator(Primitives& surfaces, const Isometry3d& at, double width) {
  surfaces.push_back(make_box(at, {0, 0.06, 0.42}, {width, 0.03, 0.5}));
  for (double x = -0.5 * width + 0.05; x < 0.5 * width; x += 0.1) {
    surfaces.push_back(make_box(at, {x, 0.09, 0.42}, {0.05, 0.05, 0.55}));
  }
}

void add_potted_plant(Primitives& surfaces, const Isometry3d& at, Random& random) {
  const double height = random.uniform(0.7, 1.5);
  const Isometry3d pot = at * Eigen::Translation3d(0, 0.25, 0);
  surfaces.push_back(make_frustum(pot * Vector3d::Zero(), pot * Vector3d{0, 0, 0.35}, 0.14, 0.19));
  surfaces.push_back(rod(pot, {0, 0, 0.3}, {0, 0, 0.7 * height}, 0.02));
  for (int i = 0; i < 6; ++i) {
    const double x = 0.12 * random.normal(), y = 0.12 * random.normal(), z = height * random.uniform(0.6, 1.0);
    add_clump(surfaces, pot * Vector3d{x, y, z}, 0.2, 25, 0.1, random);
  }
}

void add_picture(Primitives& surfaces, const Isometry3d& at, Random& random) {
  const double width = random.uniform(0.3, 1.4), height = random.uniform(0.3, 1.0), z = random.uniform(1.3, 1.8);
  surfaces.push_back(make_box(at, {0, 0.02, z}, {width, 0.04, height}));
}

}  // namespace igsp::simulation
