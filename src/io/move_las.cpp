#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "io/las_fields.hpp"
#include "io/las_header.hpp"
#include "io/move_job.hpp"
#include "io/moved_fields.hpp"

namespace igsp::io {

namespace {

constexpr double largest_stored = std::numeric_limits<std::int32_t>::max();

/// How moved coordinates are stored, offset + scale * integer, and how they come from those of the source.
struct MovedGrid {
  Eigen::Matrix3d turn;
  Eigen::Vector3d scale, offset;
  Eigen::Vector3d shift;            ///< from the moved offset of the source to `offset`
  Eigen::Vector3d lowest, highest;  ///< stored integers
};

/// Turned, relative to the moved offset of the source: small numbers, whatever the coordinate system.
Eigen::Vector3d turned(const Eigen::Matrix3d& turn, const Eigen::Vector3d& v) {
  Eigen::Vector3d result;
  for (int row = 0; row < 3; ++row) result[row] = turn(row, 0) * v.x() + turn(row, 1) * v.y() + turn(row, 2) * v.z();
  return result;
}

/// Rounded to even at a half, as everywhere.
Eigen::Vector3d stored_position(const MovedGrid& grid, const Eigen::Vector3d& local) {
  const Eigen::Vector3d exact = (local + grid.shift).cwiseQuotient(grid.scale);
  return exact.unaryExpr([](double value) { return std::nearbyint(value); });
}

/// Hands out the records in blocks.
void visit_records(InputFile& file, const LasHeader& header,
                   const std::function<void(const char* records, std::uint64_t count)>& visit) {
  const std::uint64_t block = InputFile::buffer_size / header.record_length;
  for (std::uint64_t left = header.count; left > 0;) {
    const std::uint64_t now = std::min(block, left);
    visit(file.read(now * header.record_length).data(), now);
    left -= now;
  }
}

/// Axes mix in a turn: each takes the finest resolution of those that contribute to it.
Eigen::Vector3d finest_scale(const Eigen::Matrix3d& turn, const Eigen::Vector3d& scale) {
  constexpr double contributes = 1e-9;
  const double factor = length_factor(turn);
  Eigen::Vector3d finest = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (std::abs(turn(row, column)) > contributes * factor) finest[row] = std::min(finest[row], scale[column]);
    }
  }
  return finest * factor;
}

/// The resolution of the source and its offset moved along, unless the moved points would not fit into 32 bits: then
/// the offset is their middle, and where that does not do, the resolution ten times coarser, as often as needed.
MovedGrid choose_grid(MoveJob& job, InputFile& file, const LasHeader& header) {
  const Transformation& motion = job.transformation;
  MovedGrid grid{motion.linear(), {}, {}, {}, {}, {}};
  grid.scale = finest_scale(grid.turn, header.scale);
  grid.offset = turned(grid.turn, header.offset) + motion.translation();
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  visit_records(file, header, [&](const char* record, std::uint64_t count) {
    for (; count > 0; --count, record += header.record_length) {
      const Eigen::Vector3d local = turned(grid.turn, header.local_position(record));
      lower = lower.cwiseMin(local);
      upper = upper.cwiseMax(local);
    }
    job.flush();  // there is nothing yet, but whoever wants to stop is heard
  });
  const Eigen::Vector3d moved_offset = grid.offset;
  if (header.count > 0 && ((-lower).cwiseMax(upper).cwiseQuotient(grid.scale).array() > largest_stored).any()) {
    grid.offset += (lower + upper) / 2;
    for (int axis = 0; axis < 3; ++axis) {
      while ((upper[axis] - lower[axis]) / 2 / grid.scale[axis] > largest_stored) grid.scale[axis] *= 10;
    }
  }
  if (!(grid.offset.array().abs() < las_largest).all() || !(grid.scale.array() < las_largest).all()) {
    file.fail(fmt::format("moved by this transformation its coordinates leave what LAS holds: offset {} {} {}",
                          grid.offset.x(), grid.offset.y(), grid.offset.z()));
  }
  grid.shift = moved_offset - grid.offset;
  if (header.count > 0) {
    grid.lowest = stored_position(grid, lower);  // rounding keeps the order
    grid.highest = stored_position(grid, upper);
  }
  return grid;
}

void write_header(MoveJob& job, const LasHeader& header, const MovedGrid& grid) {
  std::string bytes(job.file.read(las_bounds_end));
  char* scale = &bytes[las_scale_begin];
  char* bounds = &bytes[las_bounds_begin];
  for (int axis = 0; axis < 3; ++axis) {
    put_las_number(scale + 8 * axis, grid.scale[axis]);
    put_las_number(scale + 24 + 8 * axis, grid.offset[axis]);
    const bool any = header.count > 0;
    put_las_number(bounds + 16 * axis, any ? grid.highest[axis] * grid.scale[axis] + grid.offset[axis] : 0.0);
    put_las_number(bounds + 16 * axis + 8, any ? grid.lowest[axis] * grid.scale[axis] + grid.offset[axis] : 0.0);
  }
  job.bytes += bytes;
}

void write_position(MoveJob& job, const LasHeader& header, const MovedGrid& grid, char* record) {
  const Eigen::Vector3d stored = stored_position(grid, turned(grid.turn, header.local_position(record)));
  if (!(stored.array().abs() <= largest_stored).all())
    job.file.fail("moved coordinates do not fit into 32 bits: did the file change?");
  for (int axis = 0; axis < 3; ++axis) put_las_number(record + 4 * axis, static_cast<std::int32_t>(stored[axis]));
}

/// What a waveform advances by in a picosecond: it turns with the points, and a change of scale is one of it as well.
void turn_pulse(const Eigen::Matrix3d& turn, char* direction) {
  Eigen::Vector3d pulse;
  for (int axis = 0; axis < 3; ++axis) pulse[axis] = las_number<float>(direction + 4 * axis);
  const Eigen::Vector3d after = turned(turn, pulse);
  for (int axis = 0; axis < 3; ++axis) put_las_number(direction + 4 * axis, static_cast<float>(after[axis]));
}

}  // namespace

void move_las(MoveJob& job) {
  InputFile first_pass(job.file.path());
  const LasHeader header = read_las_header(first_pass);
  const MovedGrid grid = choose_grid(job, first_pass, header);
  write_header(job, header, grid);
  job.copy(header.points_start - las_bounds_end);
  const std::size_t pulse = las_pulse_direction(header.point_format);
  visit_records(job.file, header, [&](const char* records, std::uint64_t count) {
    const std::size_t begin = job.bytes.size();
    job.bytes.append(records, count * header.record_length);
    for (char* record = job.bytes.data() + begin; count > 0; --count, record += header.record_length) {
      write_position(job, header, grid, record);
      if (pulse > 0) turn_pulse(grid.turn, record + pulse);
    }
    job.flush_if_full();
  });
  job.copy_rest();
}

}  // namespace igsp::io
