#include "igsp/result.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "options.hpp"
#include "portable.hpp"

namespace igsp::python {
namespace {

std::string summary_of(const Result& result) {
  const std::string verdict =
      fmt::format("{} (confidence {:.3f})", result.registered ? "registered" : "not registered", result.confidence);
  if (!result.has_estimate) return fmt::format("{}: {}", verdict, result.reason);
  return fmt::format("{}, overlap {:.2f}, rmse {:.2g}, {} iterations", verdict, result.overlap(), result.rmse,
                     result.iterations.size());
}

nb::object raise_if_not_registered(nb::handle_t<Result> self) {
  if (!nb::cast<const Result&>(self).registered) {
    const nb::object type = nb::module_::import_("igsp.errors").attr("NotRegistered");
    PyErr_SetObject(type.ptr(), type(self).ptr());
    throw nb::python_error();
  }
  return nb::borrow(self);
}

template <typename Class, auto member>
auto view_of_member(Class& self) {
  return view(self.*member);
}

template <typename Class, auto member>
auto matrix(const Class& self) {
  return array_of(self.*member);
}

void bind_iteration(nb::module_& module) {
  using Record = IterationRecord;
  portable_class<Record>(module, "IterationRecord", "One pass of the loop (the paper's Algorithm 1).")
      .def_ro("k", &Record::k, "Number of the pass, from 0.")
      .def_ro("w_fd", &Record::w_fd, "Weight of the feature distance (Eq. 7).")
      .def_ro("w_ed", &Record::w_ed, "Weight of the Euclidean distance.")
      .def_ro("t_cd", &Record::t_cd, "Mismatch threshold (Eq. 11) [bits].")
      .def_ro("candidate_edges", &Record::candidate_edges, "Pairs of keypoints below the threshold.")
      .def_ro("matches", &Record::matches, "Number of correspondences.")
      .def_ro("energy", &Record::energy, "Energy (Eq. 1) [bits].")
      .def_ro("rotation_step_rad", &Record::rotation_step_rad, "Change of the rotation in this pass [rad].")
      .def_ro("translation_step", &Record::translation_step,
              "Displacement of the source keypoints' centroid in this pass [units of the cloud].")
      .def_ro("seconds", &Record::seconds, "Wall time of the pass.")
      .def_prop_ro("target_from_source", &matrix<Record, &Record::target_from_source>, nb::rv_policy::automatic,
                   "(4, 4) float64: the transformation after this pass.")
      .def_prop_ro("correspondences", &view_of_member<Record, &Record::correspondences>,
                   "(matches, 2) uint32: indices into Result.source_keypoints and Result.target_keypoints.")
      .def("__repr__", [](const Record& record) {
        return fmt::format("<IterationRecord {}: {} matches, energy {:.1f}, t_cd {:.2f}>", record.k, record.matches,
                           record.energy, record.t_cd);
      });
}

void bind_evidence(nb::module_& module) {
  portable_class<CloudSummary>(module, "CloudSummary", "How much of a cloud went into the method.")
      .def_ro("points", &CloudSummary::points, "Points as given.")
      .def_ro("voxels", &CloudSummary::voxels, "Points after the voxel filter.")
      .def_ro("keypoints", &CloudSummary::keypoints, "Keypoints among them.")
      .def_prop_ro(
          "viewpoint", [](const CloudSummary& cloud) { return array_of(cloud.viewpoint); }, nb::rv_policy::automatic,
          "(3,) float64: where the scanner stood, in the cloud's frame; None: unknown, or several.")
      .def_prop_ro(
          "part_viewpoints", [](const CloudSummary& cloud) { return array_of(Points(cloud.part_viewpoints)); },
          nb::rv_policy::automatic,
          "(K, 3) float64: of a cloud of several scans, those that are known, in the cloud's frame.");
  portable_class<Evidence>(
      module, "Evidence",
      "What the verdict is made of: two independent questions to the clouds, three where a viewpoint is known.")
      .def_ro("mutual_matches", &Evidence::mutual_matches,
              "Mutual nearest neighbours among the descriptors in a common frame ...")
      .def_ro("agreeing_matches", &Evidence::agreeing_matches, "... and those of them within 2.5 voxels.")
      .def_ro("contact_share", &Evidence::contact_share,
              "Of the places where the surfaces meet, the share where they touch, (0, 1).")
      .def_ro("quality", &Evidence::quality, "What both say as log10 odds that the pose is right.")
      .def_ro("rival_odds", &Evidence::rival_odds, "Odds of the other poses that were looked into, against this one.")
      .def_ro("voxel_size", &Evidence::voxel_size,
              "At which the questions were asked [units of the cloud]: Result.voxel_size times 1, 2, 4 or 8.");
  portable_class<RunnerUp>(module, "RunnerUp", "The best other pose that was looked into.")
      .def_prop_ro("target_from_source", &matrix<RunnerUp, &RunnerUp::target_from_source>, nb::rv_policy::automatic,
                   "(4, 4) float64.")
      .def_ro("share", &RunnerUp::share,
              "Its agreeing matches in terms of the winner's, [0, 1]: near 1, the two are hard to tell apart.");
}

void bind_precision(nb::module_& module) {
  portable_class<FreeDirection>(module, "FreeDirection",
                                "A rigid motion of the source that hardly changes how it lies on the target.")
      .def_prop_ro("motion", &view_of_member<FreeDirection, &FreeDirection::motion>,
                   "(6,) float64: rotation and translation about Precision.centre, target frame, unit length with "
                   "rotations scaled by the size of the scene.")
      .def_ro("description", &FreeDirection::description, "Such as \"translation along (1.00, 0.00, 0.00)\".");
  portable_class<Precision>(
      module, "Precision",
      "How well the surfaces fix the transformation. Order: rotation about x, y, z [rad], translation along x, y, z\n"
      "[units of the cloud]; small motions are applied on the left, in the target's frame, about `centre`.")
      .def_ro("inlier_rmse", &Precision::inlier_rmse,
              "Robust RMS of the distances along the normals where the surfaces lie on each other.")
      .def_prop_ro("centre", &view_of_member<Precision, &Precision::centre>, "(3,) float64.")
      .def_prop_ro("information", &view_of_member<Precision, &Precision::information>, "(6, 6) float64.")
      .def_prop_ro("covariance", &view_of_member<Precision, &Precision::covariance>,
                   "(6, 6) float64: its inverse; 0 where not determined.")
      .def_ro("scale", &Precision::scale,
              "By which the source would have to be multiplied to fit best; see scale_sigma.")
      .def_ro("scale_sigma", &Precision::scale_sigma,
              "Standard deviation of scale, from the residuals; 0: the surfaces do not tell it.")
      .def_ro("free_directions", &Precision::free_directions, "Motions that the surfaces do not fix.");
}

}  // namespace

void bind_result(nb::module_& module) {
  bind_iteration(module);
  bind_evidence(module);
  bind_precision(module);
  portable_class<Result>(module, "Result",
                         "What `align` answers. Not being able to register is an answer, never an exception.")
      .def_ro("registered", &Result::registered, "The verdict.")
      .def_ro("confidence", &Result::confidence, "That target_from_source is right, [0, 1].")
      .def_ro("reason", &Result::reason, "One sentence with the evidence for the verdict.")
      .def_prop_ro(
          "termination", [](const Result& result) { return to_string(result.termination); },
          "Why the loop ended: converged, max_iterations, too_few_keypoints, too_few_matches or "
          "degenerate_matches.")
      .def_prop_ro("target_from_source", &matrix<Result, &Result::target_from_source>, nb::rv_policy::automatic,
                   "(4, 4) float64, p_target = target_from_source * p_source: the best estimate, meaningless unless "
                   "has_estimate.")
      .def_ro("has_estimate", &Result::has_estimate, "False: there is no transformation to look at.")
      .def_prop_ro("overlap", &Result::overlap, "The smaller of overlap_source and overlap_target.")
      .def_ro("overlap_source", &Result::overlap_source,
              "Share of the source's voxels with the target's surface at the pose, [0, 1].")
      .def_ro("overlap_target", &Result::overlap_target, "The same for the target.")
      .def_ro("evidence", &Result::evidence, "What the verdict is made of.")
      .def_ro("runner_up", &Result::runner_up, "The best other pose that was looked into, if any.")
      .def_ro("precision", &Result::precision, "How well the surfaces fix the transformation.")
      .def_ro("rmse", &Result::rmse,
              "Inlier RMSE: distances along the normals where the surfaces meet [units of the cloud].")
      .def_ro("voxel_size", &Result::voxel_size, "[units of the cloud].")
      .def_ro("loop_voxel_size", &Result::loop_voxel_size,
              "At which keypoints and iterations were made [units of the cloud]: voxel_size times 1, 2, 4 or 8.")
      .def_ro("source", &Result::source, "Sizes of the source.")
      .def_ro("target", &Result::target, "Sizes of the target.")
      .def_prop_ro("source_keypoints", &view_of_member<Result, &Result::source_keypoints>,
                   "(K, 3) float64 in the source's frame, not moved.")
      .def_prop_ro("target_keypoints", &view_of_member<Result, &Result::target_keypoints>,
                   "(K, 3) float64 in the target's frame.")
      .def_ro("iterations", &Result::iterations, "Every pass of the loop.")
      .def_ro("timings_s", &Result::timings_s, "(stage, wall seconds), in order.")
      .def_prop_ro(
          "options", [](const Result& result) { return keywords_of(result.options); },
          nb::sig("def options(self) -> dict[str, bool | int | float | str]"),
          "The options as used, as keywords of `align`.")
      .def("raise_if_not_registered", &raise_if_not_registered, nb::sig("def raise_if_not_registered(self) -> Result"),
           "Raises igsp.NotRegistered, which says why, unless `registered`; returns the result itself.")
      .def("__str__", &summary_of)
      .def("__repr__", [](const Result& result) { return fmt::format("<Result: {}>", summary_of(result)); });
}

}  // namespace igsp::python
