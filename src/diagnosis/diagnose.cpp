#include "diagnosis/coordinates.hpp"
#include "diagnosis/mirrored.hpp"
#include "diagnosis/scale.hpp"

namespace igsp {
namespace {

void add(std::vector<Diagnosis>& causes, std::optional<Diagnosis> cause) {
  if (cause) causes.push_back(std::move(*cause));
}

// With any of these the surfaces that are registered are not those of the scene.
std::vector<Diagnosis> spoilt(const PairCoordinates& coordinates, double voxel_size) {
  std::vector<Diagnosis> causes;
  add(causes, coordinates.flat());
  add(causes, coordinates.degrees());
  if (causes.empty()) add(causes, coordinates.coarse(voxel_size));
  return causes;
}

// What would register is a cause that is proven; one is enough.
std::vector<Diagnosis> searched(const Scan& source, const Scan& target, const Result& refused,
                                const ProgressCallback& progress) {
  const SearchedPair pair(source, target, refused, progress);
  std::vector<Diagnosis> causes;
  add(causes, another_scale(source, target, pair, refused, progress));
  if (causes.empty()) add(causes, mirrored(pair, progress));
  return causes;
}

}  // namespace

std::string_view to_string(Cause cause) {
  switch (cause) {
    case Cause::too_few_points:
      return "too_few_points";
    case Cause::flat:
      return "flat";
    case Cause::degrees:
      return "degrees";
    case Cause::coarse_coordinates:
      return "coarse_coordinates";
    case Cause::mirrored:
      return "mirrored";
    case Cause::scale:
      return "scale";
  }
  return "unknown";
}

std::vector<Diagnosis> diagnose(const Scan& source, const Scan& target, const Result& refused,
                                const DiagnosisOptions& options, const ProgressCallback& progress) {
  if (refused.registered || !(refused.voxel_size > 0)) return {};
  const PairCoordinates coordinates(source.points, target.points, refused.options.threads);
  std::vector<Diagnosis> causes = spoilt(coordinates, refused.voxel_size);
  // A voxel that is wrong by a unit of length makes fine coordinates look coarse.
  const bool may_be_scale = causes.empty() || causes.front().cause == Cause::coarse_coordinates;
  if (may_be_scale && options.search) {
    if (auto found = searched(source, target, refused, progress); !found.empty()) causes = std::move(found);
  }
  add(causes, coordinates.too_few());
  return causes;
}

}  // namespace igsp
