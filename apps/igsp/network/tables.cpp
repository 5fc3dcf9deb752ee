#include <fmt/format.h>

#include "files/csv.hpp"
#include "network/measured_graph.hpp"
#include "network/outputs.hpp"
#include "network/small_motion.hpp"

namespace igsp::cli {
namespace {

Eigen::Quaterniond rotation_of(const Transformation& pose) {
  Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

std::string tum_pose(const Transformation& pose) {
  const Eigen::Quaterniond q = rotation_of(pose);
  const Eigen::Vector3d& t = pose.translation();
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

std::string text(double number) {
  return fmt::format("{}", number);
}

// g2o's steps: translation, then rotation, of the source's frame as seen from itself.
Matrix6 g2o_information(const NetworkLink& link) {
  const Matrix6 about_origin = transport(link.target_from_source, Eigen::Vector3d::Zero(), link.precision.centre);
  const Matrix6 information = about_origin.transpose() * link.precision.information * about_origin;
  Matrix6 ordered;
  ordered << information.bottomRightCorner<3, 3>(), information.bottomLeftCorner<3, 3>(),
      information.topRightCorner<3, 3>(), information.topLeftCorner<3, 3>();
  return ordered;
}

std::string upper_triangle(const Matrix6& matrix) {
  std::string numbers;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) numbers += fmt::format(" {}", matrix(i, j));
  }
  return numbers;
}

}  // namespace

std::string poses_csv(const Network& network) {
  std::string table = "scan,component,qw,qx,qy,qz,tx,ty,tz\n";
  for (const NetworkScan& scan : network.scans) {
    const Eigen::Quaterniond q = rotation_of(scan.world_from_scan);
    const Eigen::Vector3d& t = scan.world_from_scan.translation();
    table += csv_line({scan.name, std::to_string(scan.component), text(q.w()), text(q.x()), text(q.y()), text(q.z()),
                       text(t.x()), text(t.y()), text(t.z())});
  }
  return table;
}

std::string links_csv(const Network& network) {
  std::string table =
      "source,target,state,origin,confidence,overlap,rmse,mutual_matches,agreeing_matches,violation,"
      "consistent_triangles,cycle_error,residual,median_distance,rms_distance,"
      "qw,qx,qy,qz,tx,ty,tz,reason\n";
  for (const NetworkLink& link : network.links) {
    const Eigen::Quaterniond q = rotation_of(link.target_from_source);
    const Eigen::Vector3d& t = link.target_from_source.translation();
    table += csv_line({network.scans[link.source].name,
                       network.scans[link.target].name,
                       std::string(to_string(link.state)),
                       std::string(to_string(link.origin)),
                       text(link.confidence),
                       text(link.overlap),
                       text(link.rmse),
                       std::to_string(link.mutual_matches),
                       std::to_string(link.agreeing_matches),
                       text(link.violation),
                       std::to_string(link.consistent_triangles),
                       text(link.cycle_error),
                       text(link.residual),
                       text(link.median_distance),
                       text(link.rms_distance),
                       text(q.w()),
                       text(q.x()),
                       text(q.y()),
                       text(q.z()),
                       text(t.x()),
                       text(t.y()),
                       text(t.z()),
                       link.reason});
  }
  return table;
}

std::string poses_tum(const Network& network) {
  std::string lines;
  for (std::size_t i = 0; i < network.scans.size(); ++i) {
    lines += fmt::format("{} {}\n", i, tum_pose(network.scans[i].world_from_scan));
  }
  return lines;
}

std::string network_g2o(const Network& network) {
  std::string lines;
  for (std::size_t i = 0; i < network.scans.size(); ++i) {
    lines += fmt::format("VERTEX_SE3:QUAT {} {}\n", i, tum_pose(network.scans[i].world_from_scan));
  }
  for (std::size_t i = 0; i < network.scans.size(); ++i) {
    if (network.scans[i].covariance.isZero(0)) lines += fmt::format("FIX {}\n", i);
  }
  for (const NetworkLink& link : network.links) {
    if (!is_used(link)) continue;
    lines += fmt::format("EDGE_SE3:QUAT {} {} {}{}\n", link.target, link.source, tum_pose(link.target_from_source),
                         upper_triangle(g2o_information(link)));
  }
  return lines;
}

}  // namespace igsp::cli
