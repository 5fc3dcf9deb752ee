#include "report_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "igsp/errors.hpp"

namespace igsp::cli {
namespace {

constexpr int max_depth = 16;  // what igsp writes has 5; printing and freeing JSON takes stack for every level

using Check = bool (*)(const Json&);

bool is_number(const Json& json) { return json.is_number(); }
bool is_count(const Json& json) { return json.is_number_unsigned(); }
bool is_boolean(const Json& json) { return json.is_boolean(); }
bool is_text(const Json& json) { return json.is_string(); }
bool is_texts(const Json& json) { return json.is_array() && std::ranges::all_of(json, is_text); }
bool is_length(const Json& json) { return json.is_number() && json.get<double>() > 0.0; }

bool is_row(const Json& json, std::size_t length) {
  return json.is_array() && json.size() == length && std::ranges::all_of(json, is_number);
}
bool is_point(const Json& json) { return is_row(json, 3); }
bool is_points(const Json& json) { return json.is_array() && std::ranges::all_of(json, is_point); }

bool is_matrix(const Json& json, std::size_t size) {
  return json.is_array() && json.size() == size &&
         std::ranges::all_of(json, [size](const Json& row) { return is_row(row, size); });
}
bool is_pose(const Json& json) { return is_matrix(json, 4); }
bool is_pose_or_null(const Json& json) { return json.is_null() || is_pose(json); }
bool is_covariance(const Json& json) { return is_matrix(json, 6); }

bool is_verdict(const Json& json) { return json == "registered" || json == "not_registered"; }

bool is_runner_up(const Json& json) {
  return json.is_null() || (json.is_object() && is_pose(json.value("target_from_source", Json())) &&
                            is_number(json.value("share", Json())));
}
bool is_free_directions(const Json& json) {
  return json.is_array() && std::ranges::all_of(json, [](const Json& free) {
           return free.is_object() && is_text(free.value("description", Json()));
         });
}
bool is_seconds(const Json& json) { return json.is_object() && std::ranges::all_of(json, is_number); }

bool is_options(const Json& json) {
  return json.is_object() && is_count(json.value("threads", Json())) &&
         std::ranges::all_of(json, [](const Json& section) {
           return section.is_primitive() ||
                  (section.is_object() && std::ranges::all_of(section, [](const Json& value) { return value.is_primitive(); }));
         });
}

struct Entry {
  const char* pointer;
  Check holds;
  const char* kind;
};

constexpr std::array entries = {
    Entry{"/version", is_text, "a text"},
    Entry{"/verdict", is_verdict, "\"registered\" or \"not_registered\""},
    Entry{"/reason", is_text, "a text"},
    Entry{"/termination", is_text, "a text"},
    Entry{"/target_from_source", is_pose_or_null, "a 4x4 matrix or null"},
    Entry{"/confidence", is_number, "a number"},
    Entry{"/overlap_source", is_number, "a number"},
    Entry{"/overlap_target", is_number, "a number"},
    Entry{"/rmse", is_number, "a number"},
    Entry{"/evidence/mutual_matches", is_count, "a count"},
    Entry{"/evidence/agreeing_matches", is_count, "a count"},
    Entry{"/evidence/contact_share", is_number, "a number"},
    Entry{"/evidence/quality", is_number, "a number"},
    Entry{"/evidence/rival_odds", is_number, "a number"},
    Entry{"/runner_up", is_runner_up, "null, or a 4x4 matrix and a share"},
    Entry{"/precision/centre", is_point, "three numbers"},
    Entry{"/precision/covariance", is_covariance, "a 6x6 matrix"},
    Entry{"/precision/free_directions", is_free_directions, "an array of directions with a description"},
    Entry{"/voxel_size", is_length, "a positive number"},
    Entry{"/source_keypoints", is_points, "an array of points"},
    Entry{"/target_keypoints", is_points, "an array of points"},
    Entry{"/timings_s", is_seconds, "seconds by stage"},
    Entry{"/peak_memory_bytes", is_count, "a count"},
    Entry{"/warnings", is_texts, "an array of texts"},
    Entry{"/options", is_options, "options by section"},
};

constexpr std::array cloud_entries = {
    Entry{"/path", is_text, "a text"},          Entry{"/points", is_count, "a count"},
    Entry{"/dropped_points", is_count, "a count"}, Entry{"/streamed", is_boolean, "true or false"},
    Entry{"/voxels", is_count, "a count"},      Entry{"/keypoints", is_count, "a count"},
};

constexpr std::array iteration_entries = {
    Entry{"/k", is_count, "a count"},
    Entry{"/w_fd", is_number, "a number"},
    Entry{"/w_ed", is_number, "a number"},
    Entry{"/t_cd", is_number, "a number"},
    Entry{"/candidate_edges", is_count, "a count"},
    Entry{"/matches", is_count, "a count"},
    Entry{"/energy", is_number, "a number"},
    Entry{"/rotation_step_rad", is_number, "a number"},
    Entry{"/translation_step", is_number, "a number"},
    Entry{"/seconds", is_number, "a number"},
    Entry{"/target_from_source", is_pose, "a 4x4 matrix"},
};

class RunCheck {
 public:
  explicit RunCheck(const std::filesystem::path& path) : path_(path) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}: {}; is it what igsp align --report wrote?", path_.string(), what));
  }

  void check(const Json& json, std::span<const Entry> expected, const std::string& where) const {
    for (const Entry& entry : expected) {
      const Json::json_pointer pointer(entry.pointer);
      if (!json.contains(pointer)) fail(fmt::format("{}{} is missing", where, entry.pointer));
      if (!entry.holds(json[pointer])) fail(fmt::format("{}{} must be {}", where, entry.pointer, entry.kind));
    }
  }

  void check_correspondences(const Json& run, const Json& record, const std::string& where) const {
    const std::size_t sources = run["source_keypoints"].size(), targets = run["target_keypoints"].size();
    const Json pairs = record.value("correspondences", Json());
    const bool fine = pairs.is_array() && std::ranges::all_of(pairs, [&](const Json& pair) {
                        return pair.is_array() && pair.size() == 2 && std::ranges::all_of(pair, is_count) &&
                               pair[0].get<std::size_t>() < sources && pair[1].get<std::size_t>() < targets;
                      });
    if (!fine) fail(where + "/correspondences must be pairs of numbers of keypoints");
  }

  void check_run(const Json& run) const {
    if (!run.is_object()) fail("not an object");
    check(run, entries, "");
    for (const char* cloud : {"source", "target"}) {
      if (!run.contains(cloud)) fail(fmt::format("/{} is missing", cloud));
      check(run[cloud], cloud_entries, fmt::format("/{}", cloud));
    }
    if (!run.contains("iterations") || !run["iterations"].is_array()) fail("/iterations must be an array");
    for (std::size_t i = 0; i < run["iterations"].size(); ++i) {
      const std::string where = fmt::format("/iterations/{}", i);
      check(run["iterations"][i], iteration_entries, where);
      check_correspondences(run, run["iterations"][i], where);
    }
  }

 private:
  std::filesystem::path path_;
};

}  // namespace

Json read_run(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) throw FileError(path.string() + ": cannot be read");
  const RunCheck check(path);
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > max_depth) check.fail("nested too deep");
    return true;
  };
  try {
    const Json run = Json::parse(file, limit_depth);
    check.check_run(run);
    return run;
  } catch (const Json::parse_error& error) {
    check.fail(fmt::format("not JSON, at byte {}", error.byte));
  }
}

}  // namespace igsp::cli
