#include "report/json.hpp"

#include <sys/resource.h>

#include <algorithm>

#include "config/option_list.hpp"
#include "igsp/version.hpp"

namespace igsp::cli {

Json row(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json rows(const Eigen::MatrixXd& matrix) {
  Json all = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    all.push_back(row);
  }
  return all;
}

namespace {

Json to_json(const OptionValue& value) {
  return std::visit([](const auto& alternative) { return Json(alternative); }, value);
}

// Of a cloud that was taken for one scan, nothing.
Json to_json(const CloudInput& input, const std::vector<ScanPart>& settled) {
  Json parts = Json::array();
  for (std::size_t i = 0; i < settled.size(); ++i) {
    const std::optional<Eigen::Vector3d>& viewpoint = settled[i].viewpoint;
    parts.push_back({{"points", input.parts[i].total}, {"viewpoint", viewpoint ? row(*viewpoint) : Json(nullptr)}});
  }
  return parts;
}

Json to_json(const CloudInput& input, const CloudSummary& summary) {
  return {{"path", input.path.string()},
          {"points", input.total},
          {"dropped_points", input.dropped},
          {"streamed", !input.whole()},
          {"voxels", summary.voxels},
          {"keypoints", summary.keypoints},
          {"stray_points", summary.stray.count},
          {"stray_extents_away", summary.stray.extents_away},
          {"viewpoint", summary.viewpoint ? row(*summary.viewpoint) : Json(nullptr)},
          {"viewpoint_because", input.viewpoint.reason},
          {"parts", to_json(input, input.viewpoint.parts)}};
}

Json to_json(const std::vector<KeypointMatch>& matches) {
  Json pairs = Json::array();
  for (const KeypointMatch& match : matches) pairs.push_back({match.source, match.target});
  return pairs;
}

Json to_json(PointView points) {
  Json rows = Json::array();
  for (const Eigen::Vector3d& point : points) rows.push_back({point.x(), point.y(), point.z()});
  return rows;
}

Json to_json(const IterationRecord& record) {
  return {{"k", record.k},
          {"w_fd", record.w_fd},
          {"w_ed", record.w_ed},
          {"t_cd", record.t_cd},
          {"candidate_edges", record.candidate_edges},
          {"matches", record.matches},
          {"energy", record.energy},
          {"rotation_step_rad", record.rotation_step_rad},
          {"translation_step", record.translation_step},
          {"seconds", record.seconds},
          {"target_from_source", cli::to_json(record.target_from_source)},
          {"correspondences", to_json(record.correspondences)}};
}

Json to_json(const std::optional<FreeSpaceViolation>& violation) {
  if (!violation) return nullptr;
  return {{"in_view", violation->in_view}, {"contradicting", violation->contradicting}, {"share", violation->share()}};
}

Json to_json(const FreeSpace& free_space) {
  return {{"source", to_json(free_space.source)},
          {"target", to_json(free_space.target)},
          {"violation", free_space.source || free_space.target ? Json(free_space.violation()) : Json(nullptr)}};
}

Json to_json(const Evidence& evidence) {
  return {{"mutual_matches", evidence.mutual_matches}, {"agreeing_matches", evidence.agreeing_matches},
          {"contact_share", evidence.contact_share},   {"quality", evidence.quality},
          {"rival_odds", evidence.rival_odds},         {"free_space", to_json(evidence.free_space)},
          {"voxel_size", evidence.voxel_size}};
}

Json to_json(const std::optional<RunnerUp>& runner_up) {
  if (!runner_up) return nullptr;
  return {{"target_from_source", rows(runner_up->target_from_source.matrix())}, {"share", runner_up->share}};
}

Json to_json(const Precision& precision) {
  Json free_directions = Json::array();
  for (const FreeDirection& free : precision.free_directions) {
    free_directions.push_back({{"motion", rows(free.motion.transpose())[0]}, {"description", free.description}});
  }
  return {{"centre", rows(precision.centre.transpose())[0]},
          {"information", rows(precision.information)},
          {"covariance", rows(precision.covariance)},
          {"scale", precision.scale},
          {"scale_sigma", precision.scale_sigma},
          {"free_directions", free_directions}};
}

Json to_json(const std::vector<Diagnosis>& diagnosis) {
  Json causes = Json::array();
  for (const Diagnosis& found : diagnosis) {
    Json cause{{"cause", to_string(found.cause)}, {"description", found.description}};
    cause["target_from_source"] = found.target_from_source ? rows(*found.target_from_source) : Json(nullptr);
    causes.push_back(std::move(cause));
  }
  return causes;
}

bool holds_an_object(const Json& json) {
  return json.is_object() || (json.is_array() && std::ranges::any_of(json, holds_an_object));
}

void append(std::string& text, const Json& json, const std::string& line_end) {
  // A path need not be UTF-8, which JSON asks for.
  const auto one_line = [](const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); };
  if (json.empty() || !holds_an_object(json)) {
    text += one_line(json);
    return;
  }
  const std::string inner = line_end + "  ";
  std::string_view separator = "";
  text += json.is_object() ? '{' : '[';
  for (const auto& [key, value] : json.items()) {
    text += separator;
    text += inner;
    if (json.is_object()) text += one_line(key) + ": ";
    append(text, value, inner);
    separator = ",";
  }
  text += line_end;
  text += json.is_object() ? '}' : ']';
}

}  // namespace

std::string report_text(const Json& report) {
  std::string text;
  append(text, report, "\n");
  return text + "\n";
}

Json to_json(const Transformation& transformation) {
  return rows(transformation.matrix());
}

Json to_json(const Options& options) {
  Json json = Json::object();
  for (const Option& option : option_list()) {
    Json& section = option.section.empty() ? json : json[std::string(option.section)];
    section[std::string(name_in_section(option))] = to_json(option.get(options));
  }
  return json;
}

Json align_report(const Result& result, const std::vector<Diagnosis>& diagnosis, const CloudInput& source,
                  const CloudInput& target, double cpu_seconds, const std::vector<std::string>& warnings) {
  Json json;
  json["version"] = version;
  json["verdict"] = result.registered ? "registered" : "not_registered";
  json["reason"] = result.reason;
  json["diagnosis"] = to_json(diagnosis);
  json["termination"] = to_string(result.termination);
  json["target_from_source"] = result.has_estimate ? to_json(result.target_from_source) : Json(nullptr);
  json["scale"] = source.scale;
  json["confidence"] = result.confidence;
  json["overlap"] = result.overlap();
  json["overlap_source"] = result.overlap_source;
  json["overlap_target"] = result.overlap_target;
  json["rmse"] = result.rmse;
  json["evidence"] = to_json(result.evidence);
  json["runner_up"] = to_json(result.runner_up);
  json["precision"] = to_json(result.precision);
  json["voxel_size"] = result.voxel_size;
  json["loop_voxel_size"] = result.loop_voxel_size;
  json["source"] = to_json(source, result.source);
  json["target"] = to_json(target, result.target);
  json["keypoints"] = {{"source", result.source.keypoints}, {"target", result.target.keypoints}};
  json["source_keypoints"] = to_json(PointView(result.source_keypoints));
  json["target_keypoints"] = to_json(PointView(result.target_keypoints));
  json["iterations"] = Json::array();
  for (const IterationRecord& record : result.iterations) json["iterations"].push_back(to_json(record));
  json["timings_s"] = Json::object();
  for (const auto& [stage, seconds] : result.timings_s) {
    json["timings_s"][stage] = json["timings_s"].value(stage, 0.0) + seconds;  // a stage may run once per cloud
  }
  json["cpu_seconds"] = cpu_seconds;
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["warnings"] = warnings;
  json["options"] = to_json(result.options);
  return json;
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace igsp::cli
