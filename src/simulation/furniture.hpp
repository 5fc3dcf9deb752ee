#pragma once

#include "simulation/primitives.hpp"
#include "simulation/random.hpp"

namespace igsp::simulation {

// Each piece stands in the frame `at`: origin on the floor at the middle of its back, x along its width, y out of the
// wall into the room.

struct Footprint {
  double width, depth;
};

void add_table(Primitives& surfaces, const Eigen::Isometry3d& at, Footprint size, double height, bool round,
               Random& random);
void add_chair(Primitives& surfaces, const Eigen::Isometry3d& at, Random& random);
void add_desk(Primitives& surfaces, const Eigen::Isometry3d& at, Footprint size, Random& random);
void add_shelf(Primitives& surfaces, const Eigen::Isometry3d& at, Footprint size, double height, Random& random);
void add_cabinet(Primitives& surfaces, const Eigen::Isometry3d& at, Footprint size, double height, Random& random);
void add_sofa(Primitives& surfaces, const Eigen::Isometry3d& at, Footprint size, Random& random);
void add_radiator(Primitives& surfaces, const Eigen::Isometry3d& at, double width);
void add_potted_plant(Primitives& surfaces, const Eigen::Isometry3d& at, Random& random);
void add_picture(Primitives& surfaces, const Eigen::Isometry3d& at, Random& random);

/// Boxes, mugs and balls on a surface of the given size around (0, y, z).
void add_clutter(Primitives& surfaces, const Eigen::Isometry3d& at, Footprint size, double y, double z, int pieces,
                 Random& random);

}  // namespace igsp::simulation
