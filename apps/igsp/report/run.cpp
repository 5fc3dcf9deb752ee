#include "report/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "igsp/errors.hpp"
#include "io/whole_file.hpp"

namespace igsp::cli {
namespace {

constexpr int max_depth = 16;  // what igsp writes has 5; printing and freeing JSON takes stack for every level

// What a run must hold: an array has one pattern for all its elements, a name that ends in ? may be null.
constexpr const char* pattern_text = R"({
  "version": "a text", "verdict": "a verdict", "reason": "a text", "termination": "a text",
  "diagnosis": [{"cause": "a text", "description": "a text"}],
  "target_from_source?": "a rigid motion", "scale": "a positive number", "confidence": "a number",
  "overlap_source": "a number", "overlap_target": "a number", "rmse": "a number",
  "evidence": {"mutual_matches": "a count", "agreeing_matches": "a count", "contact_share": "a number",
               "quality": "a number", "rival_odds": "a number",
               "free_space": {"source?": {"in_view": "a count", "contradicting": "a count", "share": "a number"},
                              "target?": {"in_view": "a count", "contradicting": "a count", "share": "a number"},
                              "violation?": "a number"}},
  "runner_up?": {"target_from_source": "a rigid motion", "share": "a number"},
  "precision": {"centre": "a point", "covariance": "a 6x6 matrix", "free_directions": [{"description": "a text"}]},
  "voxel_size": "a positive number",
  "source": {"path": "a text", "points": "a count", "dropped_points": "a count", "streamed": "a boolean",
             "voxels": "a count", "keypoints": "a count",
             "stray_points?": "a count", "stray_extents_away?": "a number",
             "viewpoint?": "a point", "viewpoint_because": "a text",
             "parts": [{"points": "a count", "viewpoint?": "a point"}]},
  "target": {"path": "a text", "points": "a count", "dropped_points": "a count", "streamed": "a boolean",
             "voxels": "a count", "keypoints": "a count",
             "stray_points?": "a count", "stray_extents_away?": "a number",
             "viewpoint?": "a point", "viewpoint_because": "a text",
             "parts": [{"points": "a count", "viewpoint?": "a point"}]},
  "source_keypoints": ["a point"], "target_keypoints": ["a point"],
  "iterations": [{"k": "a count", "w_fd": "a number", "w_ed": "a number", "t_cd": "a number",
                  "candidate_edges": "a count", "matches": "a count", "energy": "a number",
                  "rotation_step_rad": "a number", "translation_step": "a number", "seconds": "a number",
                  "target_from_source": "a rigid motion", "correspondences": ["a pair of counts"]}],
  "timings_s": "an object of numbers", "peak_memory_bytes": "a count", "warnings": ["a text"],
  "options": "options by section"
})";

bool all_of(const Json& json, std::string_view kind);

bool is_matrix(const Json& json, std::size_t size) {
  return json.is_array() && json.size() == size &&
         std::ranges::all_of(json, [size](const Json& row) { return row.size() == size && all_of(row, "a number"); });
}

bool is_rigid_motion(const Json& json) {
  if (!is_matrix(json, 4)) return false;
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation(i, j) = json[i][j].get<double>();
  }
  return (rotation.transpose() * rotation).isIdentity(1e-3) && rotation.determinant() > 0.0;
}

bool is_options(const Json& json) {
  const auto plain = [](const Json& value) { return value.is_primitive(); };
  const auto section = [&](const Json& value) { return plain(value) || std::ranges::all_of(value, plain); };
  return json.is_object() && json.value("threads", Json()).is_number_unsigned() && std::ranges::all_of(json, section);
}

bool is_a(const Json& json, std::string_view kind) {
  if (kind == "a text") return json.is_string();
  if (kind == "a number") return json.is_number();
  if (kind == "a count") return json.is_number_unsigned();
  if (kind == "a boolean") return json.is_boolean();
  if (kind == "a verdict") return json == "registered" || json == "not_registered";
  if (kind == "a positive number") return json.is_number() && json.get<double>() > 0.0;
  if (kind == "a point") return json.is_array() && json.size() == 3 && all_of(json, "a number");
  if (kind == "a pair of counts") return json.is_array() && json.size() == 2 && all_of(json, "a count");
  if (kind == "a rigid motion") return is_rigid_motion(json);
  if (kind == "a 6x6 matrix") return is_matrix(json, 6);
  if (kind == "an object of numbers") return json.is_object() && all_of(json, "a number");
  return is_options(json);
}

bool all_of(const Json& json, std::string_view kind) {
  return std::ranges::all_of(json, [kind](const Json& element) { return is_a(element, kind); });
}

class RunCheck {
 public:
  explicit RunCheck(const std::filesystem::path& path) : path_(path) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}: {}; is it what igsp align --report wrote?", path_.string(), what));
  }

  void check(const Json& json, const Json& pattern, const std::string& place) const {
    if (pattern.is_string()) {
      const std::string kind = pattern;
      if (!is_a(json, kind)) fail(fmt::format("{} must be {}", place, kind));
    } else if (pattern.is_array()) {
      if (!json.is_array()) fail(place + " must be an array");
      for (std::size_t i = 0; i < json.size(); ++i) check(json[i], pattern[0], fmt::format("{}/{}", place, i));
    } else {
      if (!json.is_object()) fail((place.empty() ? "the whole" : place) + " must be an object");
      for (const auto& [key, entry] : pattern.items()) check_entry(json, key, entry, place);
    }
  }

  void check_correspondences(const Json& run) const {
    const std::size_t sources = run["source_keypoints"].size(), targets = run["target_keypoints"].size();
    for (std::size_t i = 0; i < run["iterations"].size(); ++i) {
      for (const Json& pair : run["iterations"][i]["correspondences"]) {
        if (pair[0].get<std::size_t>() < sources && pair[1].get<std::size_t>() < targets) continue;
        fail(fmt::format("/iterations/{}/correspondences: there is no keypoint {}", i, pair.dump()));
      }
    }
  }

 private:
  void check_entry(const Json& json, const std::string& key, const Json& pattern, const std::string& place) const {
    const bool optional = key.ends_with('?');
    const std::string name = key.substr(0, key.size() - (optional ? 1 : 0));
    const auto found = json.find(name);
    if (found == json.end()) fail(fmt::format("{}/{} is missing", place, name));
    if (!(optional && found->is_null())) check(*found, pattern, place + "/" + name);
  }

  std::filesystem::path path_;
};

}  // namespace

Json read_run(const std::filesystem::path& path) {
  constexpr std::uint64_t most_bytes = 1 << 26;  // a run of thousands of keypoints has a hundredth of it
  const std::string text = io::read_whole(path, most_bytes);
  const RunCheck check(path);
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > max_depth) check.fail("nested too deep");
    return true;
  };
  try {
    const Json run = Json::parse(text, limit_depth);
    check.check(run, Json::parse(pattern_text), "");
    check.check_correspondences(run);
    return run;
  } catch (const Json::parse_error& error) {
    check.fail(fmt::format("not JSON, at byte {}", error.byte));
  } catch (const Json::exception& error) {  // a number too large for a double
    check.fail(error.what());
  }
}

}  // namespace igsp::cli
