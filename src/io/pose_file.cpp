#include "io/pose_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "io/atomic_file.hpp"
#include "io/file_format.hpp"
#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/text_table.hpp"

namespace igsp::io {
namespace {

constexpr double unit_tolerance = 1e-2;  // of a quaternion's length: four decimals are common

struct NumberLine {
  std::vector<double> numbers;
  std::uint64_t line = 0;
};

std::vector<NumberLine> read_lines(InputFile& file) {
  std::vector<NumberLine> lines;
  for (std::string_view text; file.read_line(text);) {
    if (is_ignorable(text, true)) continue;
    NumberLine found{{}, file.line()};
    Tokenizer tokens(text, separator_of(text));
    for (std::string_view token; tokens.next(token);) {
      const auto value = parse_number<double>(token);
      if (!value || !std::isfinite(*value)) file.fail_at_line(in_quotes(token) + " is not a finite number");
      found.numbers.push_back(*value);
    }
    lines.push_back(std::move(found));
  }
  return lines;
}

TimedPose tum_pose(const InputFile& file, const NumberLine& line) {
  const std::vector<double>& n = line.numbers;
  const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  if (std::abs(rotation.norm() - 1) > unit_tolerance) {
    file.fail_at_line(
        line.line,
        fmt::format("a quaternion of length {:.4g}, expected 1: TUM has time x y z qx qy qz qw", rotation.norm()));
  }
  TimedPose timed{n[0], Transformation::Identity()};
  timed.pose.linear() = rotation.normalized().toRotationMatrix();
  timed.pose.translation() = Eigen::Vector3d(n[1], n[2], n[3]);
  return timed;
}

TimedPose kitti_pose(const InputFile& file, const NumberLine& line, std::size_t index) {
  TimedPose timed{static_cast<double>(index), Transformation::Identity()};
  for (int i = 0; i < 12; ++i) timed.pose.matrix()(i / 4, i % 4) = line.numbers[static_cast<std::size_t>(i)];
  const Eigen::Matrix3d rotation = timed.pose.linear();
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (deviation > 1e-3 || rotation.determinant() < 0) {
    file.fail_at_line(line.line,
                      fmt::format("not a rigid motion: R^T R differs from the identity by {:.3g}", deviation));
  }
  return timed;
}

std::string tum_line(const TimedPose& timed) {
  const Eigen::Quaterniond q(timed.pose.linear());
  const Eigen::Vector3d t = timed.pose.translation();
  return fmt::format("{} {} {} {} {} {} {} {}\n", timed.time, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

std::string kitti_line(const TimedPose& timed) {
  std::string text;
  for (int i = 0; i < 12; ++i) {
    append_number(text, timed.pose.matrix()(i / 4, i % 4));
    text += i < 11 ? ' ' : '\n';
  }
  return text;
}

}  // namespace

std::vector<TimedPose> read_poses(const std::filesystem::path& path) {
  InputFile file(path);
  const std::vector<NumberLine> lines = read_lines(file);
  const auto all_have = [&](std::size_t count) {
    return !lines.empty() && std::ranges::all_of(lines, [&](const auto& line) { return line.numbers.size() == count; });
  };
  std::vector<TimedPose> poses;
  // Two lines of 8 numbers may be a 4x4 matrix, one line of 12 is the upper part of one.
  if (all_have(8) && (lines.size() != 2 || extension_of(path) == ".tum")) {
    for (const NumberLine& line : lines) poses.push_back(tum_pose(file, line));
  } else if (all_have(12) && lines.size() > 1) {
    for (const NumberLine& line : lines) poses.push_back(kitti_pose(file, line, poses.size()));
  } else {
    poses.push_back({0, read_transformation(path)});
  }
  return poses;
}

void write_poses(const std::filesystem::path& path, const std::vector<TimedPose>& poses) {
  const std::string extension = extension_of(path);
  if (extension != ".tum" && extension != ".kitti") {
    if (poses.size() == 1) return write_transformation(path, poses[0].pose);
    throw InvalidArgument(fmt::format("{}: {} poses need a name in .tum or .kitti", path.string(), poses.size()));
  }
  AtomicFile file(path);
  for (const TimedPose& pose : poses) file.write(extension == ".tum" ? tum_line(pose) : kitti_line(pose));
  file.commit();
}

}  // namespace igsp::io
