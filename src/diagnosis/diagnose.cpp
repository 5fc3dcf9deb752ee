#include "diagnosis/coordinates.hpp"
#include "diagnosis/mirrored.hpp"

namespace igsp {
namespace {

void add(std::vector<Diagnosis>& causes, std::optional<Diagnosis> cause) {
  if (cause) causes.push_back(std::move(*cause));
}

// With any of these the surfaces that are registered are not those of the scene.
std::vector<Diagnosis> spoilt_coordinates(const Scan& source, const Scan& target, const Result& refused) {
  std::vector<Diagnosis> causes;
  add(causes, flat(source.points, target.points));
  add(causes, degrees(source.points, target.points));
  if (causes.empty()) add(causes, coarse_coordinates(source.points, target.points, refused.voxel_size));
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
  }
  return "unknown";
}

std::vector<Diagnosis> diagnose(const Scan& source, const Scan& target, const Result& refused,
                                const DiagnosisOptions& options, const ProgressCallback& progress) {
  if (refused.registered || !(refused.voxel_size > 0)) return {};
  std::vector<Diagnosis> causes = spoilt_coordinates(source, target, refused);
  if (causes.empty() && options.search) add(causes, mirrored(source, target, refused, progress));
  add(causes, too_few_points(source.points, target.points));
  return causes;
}

}  // namespace igsp
