#pragma once

#include <vector>

#include "simulation/primitives.hpp"
#include "simulation/random.hpp"

namespace igsp::simulation {

/// A hole in a wall, along the wall and up; openings of one wall must not overlap along it.
struct Opening {
  double begin, end, bottom, top;
};

/// A wall of boxes with holes: from the origin of `at` along its x, y is its thickness, z up.
void add_wall(Primitives& surfaces, const Eigen::Isometry3d& at, double length, double height, double thickness,
              std::vector<Opening> openings);

/// Frame, bars and pane in an opening of a wall in the same frame; the pane lies `recess` behind the face y = 0.
void add_window(Primitives& surfaces, const Eigen::Isometry3d& at, const Opening& opening, double recess, int bars);

/// A leaf hinged at one side of an opening, turned by `angle` radians (0: closed).
void add_door(Primitives& surfaces, const Eigen::Isometry3d& at, const Opening& opening, double angle,
              bool hinge_at_end);

/// A building with a front of `length` along x of `at`, facing -y: two to four floors of unequal windows with sills,
/// ledges, a door with steps, some balconies, drainpipes and a roof.
void add_building(Primitives& surfaces, const Eigen::Isometry3d& at, double length, Random& random);

}  // namespace igsp::simulation
