#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "igsp/point_cloud.hpp"

namespace igsp {

/// What a user says of where a scanner stood.
struct ViewpointRequest {
  enum class Kind {
    automatic,  ///< what the file says, else its origin if the cloud looks like one scan from there
    none,       ///< unknown, or a cloud fused from several places
    given
  };
  Kind kind = Kind::automatic;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< if given, in the frame of the points
  bool insist = false;                                 ///< if given: to be used even where the cloud contradicts it
};

/// From "auto", "none", "x,y,z" or, to insist, "x,y,z!". Throws InvalidArgument that names `option`.
ViewpointRequest parse_viewpoint(std::string_view option, std::string_view text);

/// What a cloud says of a viewpoint: a scanner sees the nearest surface in every direction, and nothing behind it.
struct HiddenPoints {
  double share = 0.0;     ///< of the compared points, those well behind another one in the same direction, [0, 1]
  double compared = 0.0;  ///< share of the points with another one in the same direction: few prove little, [0, 1]
};

/// Directions are so wide that `to_a_right_angle` of them make one, in [1, 1000]: wide ones hide more of a floor at a
/// grazing angle, narrow ones let a sparse wall be seen through. Well behind is by 1/50 of the cloud's size. Points may
/// come in any order. Throws InvalidArgument (empty cloud, non-finite point or viewpoint).
HiddenPoints hidden_points(PointView points, const Eigen::Vector3d& viewpoint, int to_a_right_angle = 30);

/// A scanner's viewpoint and why it is believed.
struct ViewpointFinding {
  std::optional<Eigen::Vector3d> viewpoint;  ///< none: unknown, or several
  std::string reason;                        ///< such as "given", "the file says so", "none is known"
  std::string warning;                       ///< why what was given is not used; mostly empty
  std::vector<ScanPart> parts = {};          ///< of a cloud of several scans: each with its own viewpoint, if known
};

/// Settles where the scanner stood. A viewpoint from which most points are hidden contradicts the cloud and is not
/// used, unless the request insists. `declared`: what the file says; where it says nothing, the origin is believed if
/// the cloud has one depth a direction from there and not from places about it. Throws as hidden_points.
ViewpointFinding find_viewpoint(PointView points, const ViewpointRequest& request,
                                const std::optional<Eigen::Vector3d>& declared = {});

/// The same for a cloud of several scans, as Scan has it: each is asked for by its own points alone. `declared`: with
/// what the file says of each. A viewpoint that is given is that of the whole cloud, as if it were one scan.
ViewpointFinding find_viewpoints(PointView points, const ViewpointRequest& request,
                                 const std::vector<ScanPart>& declared);

}  // namespace igsp
