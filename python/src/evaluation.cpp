#include "igsp/evaluation.hpp"

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "portable.hpp"

namespace igsp::python {

void bind_evaluation(nb::module_& module) {
  portable_class<PoseError>(module, "PoseError", "Error of a transformation against the true one (Eq. 12-13).")
      .def_ro("rotation_rad", &PoseError::rotation_rad, "e_r [rad], in [0, pi].")
      .def_ro("translation", &PoseError::translation, "e_t [units of the cloud]; depends on the origin.")
      .def_ro("centroid_displacement", &PoseError::centroid_displacement,
              "How far the centroid is put from its true place: independent of the origin.")
      .def("__repr__", [](const PoseError& error) {
        return fmt::format("<PoseError: rotation {:.3g} rad, translation {:.3g}, centroid {:.3g}>", error.rotation_rad,
                           error.translation, error.centroid_displacement);
      });
  portable_class<MatchQuality>(module, "MatchQuality", "Correspondences against ground truth (Eq. 14).")
      .def_ro("correct", &MatchQuality::correct, "Those closer than the radius at the true transformation.")
      .def_ro("matched", &MatchQuality::matched, "All correspondences.")
      .def_ro("possible", &MatchQuality::possible,
              "Source keypoints with a target keypoint within the radius at the true transformation.")
      .def_prop_ro("precision", &MatchQuality::precision, "correct / matched.")
      .def_prop_ro("recall", &MatchQuality::recall, "correct / possible.")
      .def("__repr__", [](const MatchQuality& quality) {
        return fmt::format("<MatchQuality: precision {:.3f}, recall {:.3f}>", quality.precision(), quality.recall());
      });
  module.def(
      "pose_error",
      [](const MatrixIn& estimate, const MatrixIn& truth, const VectorIn& centroid) {
        return pose_error(transformation_of(estimate), transformation_of(truth),
                          Eigen::Map<const Eigen::Vector3d>(centroid.data()));
      },
      nb::arg("estimate").noconvert(), nb::arg("truth").noconvert(), nb::arg("source_centroid").noconvert());
  module.def(
      "match_quality",
      [](const MatchesIn& matches, const PointsIn& source_keypoints, const PointsIn& target_keypoints,
         const MatrixIn& truth, double radius) {
        return match_quality(view_of(matches), view_of(source_keypoints), view_of(target_keypoints),
                             transformation_of(truth), radius);
      },
      nb::arg("correspondences").noconvert(), nb::arg("source_keypoints").noconvert(),
      nb::arg("target_keypoints").noconvert(), nb::arg("truth").noconvert(), nb::arg("radius"));
  module.def(
      "transform_points",
      [](const PointsIn& points, const MatrixIn& matrix) {
        const Transformation transformation = transformation_of(matrix);
        Points moved;
        moved.reserve(points.shape(0));
        for (const Eigen::Vector3d& point : view_of(points)) moved.push_back(transformation * point);
        return array_of(std::move(moved));
      },
      nb::arg("points").noconvert(), nb::arg("target_from_source").noconvert());
}

}  // namespace igsp::python
