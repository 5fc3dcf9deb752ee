#include "features/reference_frame.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace igsp {
namespace {

Eigen::Matrix3d weighted_covariance(const Support& support, double descriptor_radius) {
  const double reach = std::sqrt(3.0) * descriptor_radius;
  double weight_sum = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < support.size(); ++i) mean += Eigen::Vector3d(support.x[i], support.y[i], support.z[i]);
  if (support.size() > 0) mean /= static_cast<double>(support.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < support.size(); ++i) {
    const Eigen::Vector3d p(support.x[i], support.y[i], support.z[i]);
    const double weight = std::max(0.0, reach - p.norm());
    weight_sum += weight;
    covariance += weight * (p - mean) * (p - mean).transpose();
  }
  return weight_sum > 0 ? Eigen::Matrix3d(covariance / weight_sum) : covariance;
}

}  // namespace

Eigen::Matrix3d reference_frame(const Support& support, double descriptor_radius) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(weighted_covariance(support, descriptor_radius));
  Eigen::Matrix3d frame;
  frame.col(0) = solver.eigenvectors().col(2);
  frame.col(2) = solver.eigenvectors().col(0);
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

Eigen::Matrix3d levelled_reference_frame(const Support& support, double descriptor_radius) {
  const Eigen::Matrix3d c = weighted_covariance(support, descriptor_radius);
  const double azimuth = 0.5 * std::atan2(2 * c(0, 1), c(0, 0) - c(1, 1));  // of the larger principal axis in xy
  Eigen::Matrix3d frame = Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return frame;
}

}  // namespace igsp
