#pragma once

#include <vector>

#include "registration/prepared_cloud.hpp"

namespace igsp {

/// Turns after which a cloud lies on itself again, to a voxel, but for a few of its points and keypoints and what a
/// scan has not seen; of each turn and its inverse one: a table turned by half, a stool of three legs by a third, an
/// empty room. Most clouds have none. In the coordinates of the cloud.
std::vector<Transformation> turns_onto_itself(const PreparedCloud& cloud);

}  // namespace igsp
