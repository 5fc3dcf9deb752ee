#pragma once

#include <cstdint>

#include "io/move_job.hpp"
#include "io/moved_line.hpp"
#include "io/moved_record.hpp"

namespace igsp::io {

/// Lines of numbers, with what lies between them.
void move_lines(MoveJob& job, LineMotion motion);

/// `count` records of one size.
void move_fixed_records(MoveJob& job, std::uint64_t count, const FixedMotion& motion);

}  // namespace igsp::io
