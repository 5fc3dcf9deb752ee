#pragma once

#include "features/support.hpp"

namespace igsp {

/// Local reference frame of a keypoint: columns x, y, n with y = n cross x, a proper rotation. From the covariance of
/// the support about its mean, weighted by sqrt(3) R - distance to the keypoint, which never is negative on the
/// support. x is the eigenvector of the largest and n of the smallest eigenvalue; signs are arbitrary, see frame_flips.
Eigen::Matrix3d reference_frame(const Support& support, double descriptor_radius);

/// The same for levelled scans (4 degrees of freedom): n is the z axis and x the dominant direction in the xy plane.
Eigen::Matrix3d levelled_reference_frame(const Support& support, double descriptor_radius);

}  // namespace igsp
