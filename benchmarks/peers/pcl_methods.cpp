#include "pcl_methods.hpp"

#include <pcl/common/io.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/keypoints/iss_3d.h>
#include <pcl/recognition/cg/geometric_consistency.h>
#include <pcl/registration/correspondence_estimation.h>
#include <pcl/registration/ia_kfpcs.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <algorithm>
#include <map>

namespace igsp::peers {
namespace {

using Normals = pcl::PointCloud<pcl::Normal>;
using PointNormals = pcl::PointCloud<pcl::PointNormal>;
using Descriptors = pcl::PointCloud<pcl::FPFHSignature33>;

Cloud::Ptr filtered(const Cloud::Ptr& cloud, double voxel_size) {
  Cloud::Ptr result(new Cloud);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  const auto size = static_cast<float>(voxel_size);
  grid.setLeafSize(size, size, size);
  grid.filter(*result);
  return result;
}

// Towards the centroid, here the origin: a scan that was moved no longer knows where its scanner stood.
Normals::Ptr normals_of(const Cloud::Ptr& cloud, const Settings& settings) {
  Normals::Ptr normals(new Normals);
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(settings.threads);
  estimation.setInputCloud(cloud);
  estimation.setRadiusSearch(2.0 * settings.voxel_size);
  estimation.setViewPoint(0, 0, 0);
  estimation.compute(*normals);
  return normals;
}

// A voxel-filtered cloud, without the points that have no normal.
struct Prepared {
  Cloud::Ptr points{new Cloud};
  Normals::Ptr normals{new Normals};

  PointNormals::Ptr together() const {
    PointNormals::Ptr both(new PointNormals);
    pcl::concatenateFields(*points, *normals, *both);
    return both;
  }
};

Prepared prepare(const Cloud::Ptr& cloud, const Settings& settings) {
  const Cloud::Ptr points = filtered(cloud, settings.voxel_size);
  const Normals::Ptr normals = normals_of(points, settings);
  Prepared prepared;
  for (std::size_t i = 0; i < points->size(); ++i) {
    if (!pcl::isFinite((*normals)[i])) continue;
    prepared.points->push_back((*points)[i]);
    prepared.normals->push_back((*normals)[i]);
  }
  return prepared;
}

Descriptors::Ptr describe(const Prepared& cloud, const Settings& settings) {
  Descriptors::Ptr descriptors(new Descriptors);
  pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation(settings.threads);
  estimation.setInputCloud(cloud.points);
  estimation.setInputNormals(cloud.normals);
  estimation.setRadiusSearch(5.0 * settings.voxel_size);
  estimation.compute(*descriptors);
  return descriptors;
}

// The score of every ICP is the mean squared distance of its correspondences.
Answer icp_after(const Prepared& source, const Prepared& target, const Eigen::Matrix4f& start,
                 const Settings& settings) {
  Answer answer{.label = "icp", .target_from_source = start};
  for (const double distance : {2.0, 1.0}) {  // [voxels]: first to reach the place, then for the accuracy
    pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
    icp.setInputSource(source.together());
    icp.setInputTarget(target.together());
    icp.setMaxCorrespondenceDistance(distance * settings.voxel_size);
    icp.setMaximumIterations(30);
    PointNormals moved;
    icp.align(moved, answer.target_from_source);
    answer.target_from_source = icp.getFinalTransformation();
    answer.converged = icp.hasConverged();
    answer.score = icp.getFitnessScore(distance * settings.voxel_size);
  }
  return answer;
}

using HandOut = std::function<void(const Answer&)>;

void icp(const Cloud::Ptr& source, const Cloud::Ptr& target, const Settings& settings, const HandOut& hand_out) {
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(filtered(source, settings.voxel_size));
  icp.setInputTarget(filtered(target, settings.voxel_size));
  icp.setMaximumIterations(100);
  icp.setTransformationEpsilon(1e-10);
  Cloud moved;
  icp.align(moved);
  hand_out({.target_from_source = icp.getFinalTransformation(),
            .converged = icp.hasConverged(),
            .score = icp.getFitnessScore()});
}

// The proportions of PCL's tutorial: cells of five voxels, steps of half of one. Score: transformation likelihood.
void ndt(const Cloud::Ptr& source, const Cloud::Ptr& target, const Settings& settings, const HandOut& hand_out) {
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt;
  ndt.setResolution(static_cast<float>(5.0 * settings.voxel_size));
  ndt.setStepSize(0.5 * settings.voxel_size);
  ndt.setTransformationEpsilon(0.05 * settings.voxel_size);
  ndt.setMaximumIterations(100);
  ndt.setInputSource(filtered(source, settings.voxel_size));
  ndt.setInputTarget(target);
  Cloud moved;
  ndt.align(moved, Eigen::Matrix4f::Identity());
  hand_out({.target_from_source = ndt.getFinalTransformation(),
            .converged = ndt.hasConverged(),
            .score = ndt.getTransformationLikelihood()});
}

// The numbers of PCL's tutorial on robust pose estimation. Score: share of the source that is an inlier.
void prerejective(const Cloud::Ptr& source, const Cloud::Ptr& target, const Settings& settings,
                  const HandOut& hand_out) {
  const Prepared moving = prepare(source, settings), fixed = prepare(target, settings);
  pcl::SampleConsensusPrerejective<pcl::PointXYZ, pcl::PointXYZ, pcl::FPFHSignature33> consensus;
  consensus.setInputSource(moving.points);
  consensus.setSourceFeatures(describe(moving, settings));
  consensus.setInputTarget(fixed.points);
  consensus.setTargetFeatures(describe(fixed, settings));
  consensus.setMaximumIterations(50000);
  consensus.setNumberOfSamples(3);
  consensus.setCorrespondenceRandomness(5);
  consensus.setSimilarityThreshold(0.9f);
  consensus.setMaxCorrespondenceDistance(2.5 * settings.voxel_size);
  consensus.setInlierFraction(0.25f);
  Cloud moved;
  consensus.align(moved);
  const Answer answer{.target_from_source = consensus.getFinalTransformation(),
                      .converged = consensus.hasConverged(),
                      .score = static_cast<double>(consensus.getInliers().size()) / moving.points->size()};
  hand_out(answer);
  Answer after = icp_after(moving, fixed, answer.target_from_source, settings);
  after.converged &= answer.converged;
  hand_out(after);
}

// Score: correspondences of the largest consistent group; PCL's tutorial believes in 5.
void geometric_consistency(const Cloud::Ptr& source, const Cloud::Ptr& target, const Settings& settings,
                           const HandOut& hand_out) {
  const Prepared moving = prepare(source, settings), fixed = prepare(target, settings);
  pcl::registration::CorrespondenceEstimation<pcl::FPFHSignature33, pcl::FPFHSignature33> nearest;
  nearest.setInputSource(describe(moving, settings));
  nearest.setInputTarget(describe(fixed, settings));
  const pcl::CorrespondencesPtr matches(new pcl::Correspondences);
  nearest.determineReciprocalCorrespondences(*matches);

  pcl::GeometricConsistencyGrouping<pcl::PointXYZ, pcl::PointXYZ> grouping;
  grouping.setGCSize(2.0 * settings.voxel_size);
  grouping.setGCThreshold(5);
  grouping.setInputCloud(moving.points);
  grouping.setSceneCloud(fixed.points);
  grouping.setModelSceneCorrespondences(matches);
  std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> poses;
  std::vector<pcl::Correspondences> groups;
  grouping.recognize(poses, groups);
  Answer answer;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (static_cast<double>(groups[i].size()) <= answer.score) continue;
    answer = {.target_from_source = poses[i], .converged = true, .score = static_cast<double>(groups[i].size())};
  }
  hand_out(answer);
  Answer after = icp_after(moving, fixed, answer.target_from_source, settings);
  after.converged &= answer.converged;
  hand_out(after);
}

Cloud::Ptr keypoints_of(const Prepared& cloud, const Settings& settings) {
  Cloud::Ptr keypoints(new Cloud);
  pcl::ISSKeypoint3D<pcl::PointXYZ, pcl::PointXYZ> detector;
  detector.setInputCloud(cloud.points);
  detector.setSalientRadius(6.0 * settings.voxel_size);
  detector.setNonMaxRadius(3.0 * settings.voxel_size);
  detector.setMinNeighbors(5);
  detector.setNumberOfThreads(settings.threads);
  detector.compute(*keypoints);
  return keypoints;
}

// Score: PCL's fitness score, smaller is better.
void kfpcs(const Cloud::Ptr& source, const Cloud::Ptr& target, const Settings& settings, const HandOut& hand_out) {
  const Prepared moving = prepare(source, settings), fixed = prepare(target, settings);
  pcl::registration::KFPCSInitialAlignment<pcl::PointXYZ, pcl::PointXYZ> alignment;
  alignment.setInputSource(keypoints_of(moving, settings));
  alignment.setInputTarget(keypoints_of(fixed, settings));
  alignment.setNumberOfThreads(settings.threads);
  alignment.setDelta(static_cast<float>(settings.voxel_size), false);
  alignment.setApproxOverlap(static_cast<float>(settings.overlap));
  alignment.setMaxComputationTime(settings.time_limit_s);
  Cloud moved;
  alignment.align(moved);
  const Answer answer{.target_from_source = alignment.getFinalTransformation(),
                      .converged = alignment.hasConverged(),
                      .score = alignment.getFitnessScore()};
  hand_out(answer);
  Answer after = icp_after(moving, fixed, answer.target_from_source, settings);
  after.converged &= answer.converged;
  hand_out(after);
}

using Method = void (*)(const Cloud::Ptr&, const Cloud::Ptr&, const Settings&, const HandOut&);
const std::map<std::string, Method> methods = {{"icp", icp},
                                               {"ndt", ndt},
                                               {"prerejective", prerejective},
                                               {"geometric_consistency", geometric_consistency},
                                               {"kfpcs", kfpcs}};

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& [name, method] : methods) names.push_back(name);
  return names;
}

void register_clouds(const std::string& method, const Cloud::Ptr& source, const Cloud::Ptr& target,
                     const Settings& settings, const HandOut& hand_out) {
  methods.at(method)(source, target, settings, hand_out);
}

}  // namespace igsp::peers
