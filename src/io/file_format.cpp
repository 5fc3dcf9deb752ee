#include "io/file_format.hpp"

#include "igsp/errors.hpp"

namespace igsp {

namespace io {

FormatFamily family_of(FileFormat format) {
  switch (format) {
    case FileFormat::ply_ascii:
    case FileFormat::ply_binary_little_endian:
    case FileFormat::ply_binary_big_endian:
      return FormatFamily::ply;
    case FileFormat::pcd_ascii:
    case FileFormat::pcd_binary:
    case FileFormat::pcd_binary_compressed:
      return FormatFamily::pcd;
    case FileFormat::las:
      return FormatFamily::las;
    case FileFormat::text:
      return FormatFamily::text;
  }
  return FormatFamily::unknown;
}

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

FormatFamily family_of(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".ply") return FormatFamily::ply;
  if (extension == ".pcd") return FormatFamily::pcd;
  if (extension == ".las") return FormatFamily::las;
  for (const auto text : {".xyz", ".txt", ".csv", ".pts", ".asc", ".tsv", ".xyzn", ".xyzrgb"}) {
    if (extension == text) return FormatFamily::text;
  }
  return FormatFamily::unknown;
}

std::string unknown_format_of(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".laz") return "compressed LAS (LAZ): use the Python package, pip install 'igsp[las]'";
  for (const auto mesh : {".obj", ".off", ".stl", ".gltf", ".glb", ".fbx", ".3ds", ".dxf", ".wrl"}) {
    if (extension == mesh) return extension + " is a mesh, which igsp does not read: save its vertices as .ply";
  }
  for (const auto data : {".vtk", ".vtp", ".vtu"}) {
    if (extension == data) return extension + " is not read: save the points as .ply, for instance in ParaView";
  }
  for (const auto raw : {".fls", ".zfs", ".rcp", ".rcs", ".rdbx", ".rxp", ".pod", ".cl3", ".bin"}) {
    if (extension == raw) return extension + " is a format of one vendor: export the points as .e57, .las or .ply";
  }
  return "unknown kind of file; the extension must be one of .ply, .pcd, .las, .xyz, .txt, .csv, .asc, .pts";
}

}  // namespace io

FileFormat format_of(const std::filesystem::path& path) {
  switch (io::family_of(path)) {
    case io::FormatFamily::ply:
      return FileFormat::ply_binary_little_endian;
    case io::FormatFamily::pcd:
      return FileFormat::pcd_binary;
    case io::FormatFamily::las:
      return FileFormat::las;
    case io::FormatFamily::text:
      return FileFormat::text;
    case io::FormatFamily::unknown:
      break;
  }
  throw FileError(path.string() + ": " + io::unknown_format_of(path));
}

}  // namespace igsp
