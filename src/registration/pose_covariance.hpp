#pragma once

#include <span>

#include "registration/point_to_plane.hpp"

namespace igsp {

/// What the pairs of a refined pose say of it. Order and frame as in Precision.
struct PoseCovariance {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();                              ///< of the pairs
  double residual_variance = 0;                                                  ///< [units of the cloud ^ 2]
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< 0 where not determined
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();

  // What both are made of, for whoever adds several pairs of scans up: H over the variance of the residuals, and the
  // covariance of the gradient in the same unit, which would be the same if residuals were independent.
  Eigen::Matrix<double, 6, 6> curvature = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> gradient_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The covariance of the robust least squares estimate, with residuals that are alike where they lie near each other:
/// H^-1 B H^-1 with H = sum of w J J^T and B = sum over patches of g g^T, g = sum of w r J over the pairs of a patch
/// (the cluster-robust covariance of Liang and Zeger 1986). Few patches say little of B, so it is drawn towards what
/// independent residuals would give. `radius`: at which the pairs were found. With 4 degrees of freedom the four that
/// are estimated have a covariance of their own, not correlated with the tilt.
PoseCovariance pose_covariance(std::span<const PlanePair> pairs, double radius, double voxel_size,
                               int degrees_of_freedom = 6);

}  // namespace igsp
