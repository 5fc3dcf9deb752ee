#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "igsp/errors.hpp"
#include "igsp/io.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/number_text.hpp"
#include "io/text_table.hpp"

namespace igsp {

namespace {

constexpr double rigid_tolerance = 1e-3;

/// Why the matrix is no rigid motion; nothing if it is one.
std::optional<std::string> why_not_rigid(const Eigen::Matrix4d& matrix) {
  if (!matrix.allFinite()) return "the matrix holds a number that is not finite";
  const Eigen::RowVector4d last_row(0, 0, 0, 1);
  if ((matrix.row(3) - last_row).cwiseAbs().maxCoeff() > rigid_tolerance) return "the last row is not 0 0 0 1";
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  const double scale = std::cbrt(rotation.determinant());
  if (scale > 0 && std::abs(scale - 1) > rigid_tolerance &&
      (rotation.transpose() * rotation / (scale * scale)).isIdentity(rigid_tolerance)) {
    return fmt::format("not a rigid motion: the matrix also multiplies by {:.6g}", scale);
  }
  if (deviation > rigid_tolerance) {
    return fmt::format("not a rigid motion: R^T R differs from the identity by {:.3g} (at most {})", deviation,
                       rigid_tolerance);
  }
  if (rotation.determinant() < 0) return "not a rigid motion: the matrix is a reflection (determinant -1)";
  return std::nullopt;
}

std::vector<double> read_numbers(io::InputFile& file) {
  std::vector<double> numbers;
  for (std::string_view line; file.read_line(line);) {
    if (io::is_ignorable(line, true)) continue;
    io::Tokenizer tokens(line, io::separator_of(line));
    for (std::string_view token; tokens.next(token);) {
      const auto value = io::parse_number<double>(token);
      if (!value || !std::isfinite(*value)) file.fail_at_line(io::in_quotes(token) + " is not a finite number");
      if (numbers.size() == 16) file.fail_at_line("more than the 16 numbers of a 4x4 matrix");
      numbers.push_back(*value);
    }
  }
  return numbers;
}

}  // namespace

Transformation read_transformation(const std::filesystem::path& path) {
  io::InputFile file(path);
  const std::vector<double> numbers = read_numbers(file);
  if (numbers.size() != 12 && numbers.size() != 16) {
    file.fail_at_line(fmt::format("{} numbers; a transformation has 16 (4x4) or 12 (3x4)", numbers.size()));
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrix(static_cast<int>(i / 4), static_cast<int>(i % 4)) = numbers[i];
  if (const auto reason = why_not_rigid(matrix)) file.fail_at_line(*reason);
  Transformation transformation = Transformation::Identity();
  transformation.affine() = matrix.topRows<3>();
  return transformation;
}

void write_transformation(const std::filesystem::path& path, const Transformation& transformation, double scale) {
  if (const auto reason = why_not_rigid(transformation.matrix())) throw InvalidArgument("transformation: " + *reason);
  Eigen::Matrix4d matrix = transformation.matrix();
  if (scale != 1) matrix.topLeftCorner<3, 3>() *= scale;
  std::string text;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      io::append_number(text, matrix(row, column));
      text += column < 3 ? ' ' : '\n';
    }
  }
  io::AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace igsp
