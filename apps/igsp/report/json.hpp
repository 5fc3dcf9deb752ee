#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/cloud_input.hpp"
#include "igsp/diagnosis.hpp"
#include "igsp/result.hpp"

namespace igsp::cli {

using Json = nlohmann::ordered_json;

/// An array of numbers.
Json row(const Eigen::Vector3d& vector);
/// An array of its rows.
Json rows(const Eigen::MatrixXd& matrix);

/// Four rows of four numbers.
Json to_json(const Transformation& transformation);

/// All options by section, as the option list has them.
Json to_json(const Options& options);

/// What `igsp align --report` writes. `cpu_seconds`: of the registration, without reading, all threads.
/// To be written with report_text.
Json align_report(const Result& result, const std::vector<Diagnosis>& diagnosis, const CloudInput& source,
                  const CloudInput& target, double cpu_seconds, const std::vector<std::string>& warnings);

/// Indented, but an array of numbers, of any depth, stays on one line: keypoints and correspondences are many.
std::string report_text(const Json& report);

std::size_t peak_memory_bytes();

}  // namespace igsp::cli
