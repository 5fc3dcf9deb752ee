#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/input_file.hpp"
#include "io/pcd_header.hpp"

namespace igsp::io {

/// The body of PCD binary_compressed: all values of one field behind those of the other, as one block behind its two
/// sizes. LZF has no way to decompress a part of it.
std::vector<char> read_pcd_compressed(InputFile& file, const PcdHeader& header);

/// The block for such a body. Throws InvalidArgument for one beyond the 4 GiB of the format.
std::string compressed_pcd(std::string_view body);

}  // namespace igsp::io
