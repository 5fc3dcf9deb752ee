#pragma once

#include <vector>

#include "registration/prepared_cloud.hpp"

namespace igsp {

/// Turns about the principal axes of a cloud after which it lies on itself again, to a voxel, but for one in a hundred
/// of its points and one in ten of its keypoints; of each turn and its inverse one: a table turned by half, a stool of
/// three legs by a third. Most clouds have none. In the coordinates of the cloud.
std::vector<Transformation> turns_onto_itself(const PreparedCloud& cloud);

}  // namespace igsp
