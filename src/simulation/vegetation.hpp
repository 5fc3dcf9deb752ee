#pragma once

#include "simulation/primitives.hpp"
#include "simulation/random.hpp"

namespace igsp::simulation {

/// A leaning trunk that branches twice, a clump of leaves at every branch's end; 5-13 m. `leafiness` scales the number
/// of leaves: 0 is a winter tree.
void add_broadleaf(Primitives& surfaces, const Eigen::Vector3d& foot, double leafiness, Random& random);

/// A straight trunk with whorls of drooping, needled branches; 6-14 m.
void add_conifer(Primitives& surfaces, const Eigen::Vector3d& foot, Random& random);

/// Stems and clumps of leaves within about `radius` of its middle.
void add_bush(Primitives& surfaces, const Eigen::Vector3d& foot, double radius, Random& random);

/// `leaves` leaves of about `size`, Gaussian around `centre`.
void add_clump(Primitives& surfaces, const Eigen::Vector3d& centre, double radius, int leaves, double size,
               Random& random);

}  // namespace igsp::simulation
