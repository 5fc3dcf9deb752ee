#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace igsp::peers {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct Settings {
  double voxel_size = 0.0;  ///< [units of the cloud]
  int threads = 1;
  double overlap = 0.5;   ///< kfpcs
  int time_limit_s = 60;  ///< kfpcs
};

struct Answer {
  std::string label;  ///< "" for the method itself, "icp" after point-to-plane ICP
  Eigen::Matrix4f target_from_source = Eigen::Matrix4f::Identity();
  bool converged = false;  ///< what PCL says
  double score = 0.0;      ///< PCL's own: see the method
};

std::vector<std::string> method_names();

/// Both clouds about their centroids. Hands out every answer as soon as it is there.
void register_clouds(const std::string& method, const Cloud::Ptr& source, const Cloud::Ptr& target,
                     const Settings& settings, const std::function<void(const Answer&)>& hand_out);

}  // namespace igsp::peers
