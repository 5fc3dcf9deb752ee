#include "archive/archive.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "core/core_testing.hpp"
#include "igsp/igsp.hpp"

namespace igsp::archive {
namespace {

using testing::Random;

// A value in every field, by the types alone: no field that is listed can be forgotten, and that every field is listed
// is asserted beside the lists.
void fill(Random& random, bool& value) {
  value = random.bits() % 2 == 0;
}
template <Scalar T>
void fill(Random& random, T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    value = static_cast<T>(random.uniform(-1, 1));
  } else {
    value = static_cast<T>(random.bits() % 7);
  }
}
void fill(Random& random, Termination& value) {
  value = static_cast<Termination>(random.bits() % 5);
}
void fill(Random& random, Cause& value) {
  value = static_cast<Cause>(random.bits() % 5);
}
void fill(Random& random, LinkState& value) {
  value = static_cast<LinkState>(random.bits() % 4);
}
void fill(Random& random, LinkOrigin& value) {
  value = static_cast<LinkOrigin>(random.bits() % 3);
}
void fill(Random& random, std::string& value) {
  value = "text \0 and " + std::to_string(random.bits());
}
void fill(Random& random, Options& value) {
  value.scale.voxel_size = random.uniform(0.1, 1);
  value.energy.threshold_rule = ThresholdRule::released;
  value.degrees_of_freedom = 4;
  value.refinement.enabled = false;
  value.hypotheses.max_refined = random.integer(1, 20);
}
void fill(Random& random, Transformation& value) {
  value = random.motion(5);
}
template <typename T, int rows, int columns>
void fill(Random& random, Eigen::Matrix<T, rows, columns>& value) {
  for (Eigen::Index i = 0; i < value.size(); ++i) fill(random, value.data()[i]);
}
template <typename T, std::size_t size>
void fill(Random& random, std::array<T, size>& values) {
  for (T& value : values) fill(random, value);
}
template <typename A, typename B>
void fill(Random& random, std::pair<A, B>& value);
template <typename T>
void fill(Random& random, std::optional<T>& value);
template <typename T>
void fill(Random& random, std::vector<T>& values);
// Each of voxels twice as large as those before, and without coarser ones.
void fill(Random& random, std::vector<Features>& coarser);
template <HasLayout T>
void fill(Random& random, T& value) {
  std::apply([&](const auto&... fields) { (fill(random, value.*fields.member), ...); }, Layout<T>::fields);
}
template <typename A, typename B>
void fill(Random& random, std::pair<A, B>& value) {
  fill(random, value.first);
  fill(random, value.second);
}
template <typename T>
void fill(Random& random, std::optional<T>& value) {
  fill(random, value.emplace());
}
// As long everywhere, and indices are below it: what require_consistent asks for.
template <typename T>
void fill(Random& random, std::vector<T>& values) {
  values.resize(8);
  for (T& value : values) fill(random, value);
}

constexpr double voxel_size = 0.5;

void fill(Random& random, std::vector<Features>& coarser) {
  static bool is_inside = false;
  if (is_inside) return;
  is_inside = true;
  coarser.resize(3);
  for (std::size_t k = 0; k < coarser.size(); ++k) {
    fill(random, coarser[k]);
    coarser[k].voxel_size = voxel_size * std::exp2(k + 1);
  }
  is_inside = false;
}

template <typename T>
T filled(std::uint64_t seed) {
  Random random(seed);
  T value{};
  fill(random, value);
  if constexpr (std::is_same_v<T, Features>) value.voxel_size = voxel_size;
  return value;
}

template <typename T>
class Archive : public ::testing::Test {};
template <typename Tuple>
struct AsTypes;
template <typename... Structs>
struct AsTypes<std::tuple<Structs...>> {
  using type = ::testing::Types<Structs...>;
};
TYPED_TEST_SUITE(Archive, typename AsTypes<AllStructs>::type);

TYPED_TEST(Archive, GivesBackEveryFieldBitForBit) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::string bytes = pack(filled<TypeParam>(seed));
    EXPECT_EQ(pack(unpack<TypeParam>(bytes)), bytes);
  }
  EXPECT_NE(pack(filled<TypeParam>(20)), pack(filled<TypeParam>(21))) << "other values give other bytes";
  const std::string bytes = pack(TypeParam{});
  EXPECT_EQ(pack(unpack<TypeParam>(bytes)), bytes);
}

// Each field on its own: one that was read into another's place would show.
TYPED_TEST(Archive, EveryFieldArrivesInItsOwnPlace) {
  const auto original = filled<TypeParam>(1);
  const auto back = unpack<TypeParam>(pack(original));
  const auto compare = [&](const auto& field) {
    Encoder expected, actual;
    put(expected, original.*field.member);
    put(actual, back.*field.member);
    EXPECT_EQ(actual.bytes(), expected.bytes()) << field.name;
  };
  std::apply([&](const auto&... fields) { (compare(fields), ...); }, Layout<TypeParam>::fields);
}

TYPED_TEST(Archive, RefusesEveryCut) {
  const std::string bytes = pack(filled<TypeParam>(2));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(unpack<TypeParam>(std::string_view(bytes).substr(0, size)), Fault) << size;
  }
  EXPECT_THROW(unpack<TypeParam>(bytes + '\0'), Fault);
}

TYPED_TEST(Archive, RefusesEveryChangedByte) {
  const std::string bytes = pack(filled<TypeParam>(3));
  Random random(4);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ (1 + random.bits() % 255));
    EXPECT_THROW(unpack<TypeParam>(changed), Fault) << i;
  }
}

// Changed by someone who knows the checksum: a value or a Fault, never memory that the bytes cannot fill.
TYPED_TEST(Archive, SurvivesHostileBodies) {
  Encoder encoder;
  put(encoder, filled<TypeParam>(5));
  const std::string body(encoder.bytes());
  Random random(6);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string hostile = body;
    for (std::uint64_t change = random.bits() % 4 + 1; change > 0; --change) {
      hostile[random.bits() % hostile.size()] = static_cast<char>(random.bits() % 3 == 0 ? 255 : random.bits());
    }
    if (random.bits() % 4 == 0) hostile.resize(random.bits() % hostile.size());
    try {
      unpack<TypeParam>(sealed(Layout<TypeParam>::name, hostile));
    } catch (const Fault&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
}

template <typename T>
std::string reason(std::string_view bytes) {
  try {
    unpack<T>(bytes);
  } catch (const Fault& fault) {
    return fault.what();
  }
  return "none";
}

TEST(ArchiveReasons, NameWhatIsWrong) {
  const std::string bytes = pack(filled<Features>(7));
  EXPECT_EQ(reason<Features>("ply\nformat ascii 1.0\n"), "these are no features or results that igsp wrote");
  EXPECT_EQ(reason<Result>(bytes), "it holds Features, not Result");
  std::string newer = bytes;
  newer[8] = 2;  // the number of the form follows the magic
  EXPECT_NE(reason<Features>(newer).find("in form 2 with other fields than this igsp"), std::string::npos);
  std::string changed = bytes;
  changed[bytes.size() / 2] ^= 1;
  EXPECT_EQ(reason<Features>(changed), "the checksum does not hold: it was changed since it was written");
  EXPECT_NE(reason<Features>(bytes.substr(0, bytes.size() - 5)).find("cut off"), std::string::npos);
}

TEST(ArchiveReasons, OfStructsInsideOfStructsWithoutEnd) {
  Features deep;
  for (int depth = 0; depth < 20; ++depth) {
    Features outer;
    outer.coarser.push_back(std::move(deep));
    deep = std::move(outer);
  }
  EXPECT_NE(reason<Features>(pack(deep)).find("deeper than any is written"), std::string::npos);
}

TEST(ArchiveReasons, OfFeaturesThatContradictThemselves) {
  const auto reason_of = [](auto change) {
    auto features = filled<Features>(8);
    change(features);
    return reason<Features>(pack(features));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reason_of([](Features&) {}), "none");
  for (const auto& [text, expected] : std::initializer_list<std::pair<std::string, std::string>>{
           {reason_of([](Features& f) { f.keypoints[3] = 8; }), "a keypoint is none of its points"},
           {reason_of([](Features& f) { f.normals.pop_back(); }), "7 normals for 8 points"},
           {reason_of([](Features& f) { f.curvature.clear(); }), "0 curvatures for 8 points"},
           {reason_of([](Features& f) { f.frames.pop_back(); }), "7 frames for 8 keypoints"},
           {reason_of([](Features& f) { f.descriptors.emplace_back(); }), "9 descriptors for 8 keypoints"},
           {reason_of([](Features& f) { f.points[2].x() = 1e10; }), "an entry of points is not finite or beyond"},
           {reason_of([&](Features& f) { f.fine_points[2].x() = nan; }), "an entry of fine_points is not finite"},
           {reason_of([&](Features& f) { f.normals[2].x() = nan; }), "an entry of normals is not finite"},
           {reason_of([](Features& f) { f.frames[2](1, 1) = 2; }), "an entry of frames is not finite or beyond"},
           {reason_of([&](Features& f) { f.curvature[1] = static_cast<float>(nan); }), "a curvature is not finite"},
           {reason_of([&](Features& f) { f.viewpoint->x() = nan; }), "viewpoint is not finite"},
           {reason_of([](Features& f) { f.coarser[1].voxel_size *= 2; }), "coarser voxels are not twice as large"},
           {reason_of([](Features& f) { f.coarser[1].normals.pop_back(); }), "7 normals for 8 points"},
           {reason_of([](Features& f) { f.coarser[2].coarser.resize(1); }), "coarser voxels of coarser voxels"},
           {reason_of([&](Features& f) { f.parts[1].viewpoint.x() = nan; }), "viewpoint of a part is not finite"},
           {reason_of([](Features& f) { f.parts[1].fine_points[2].x() = 1e10; }), "an entry of fine_points of a part"},
           {reason_of([&](Features& f) { f.origin.x() = nan; }), "origin is not finite"},
           {reason_of([](Features& f) { f.voxel_size = -1; }), "voxel_size is negative or not finite"}}) {
    EXPECT_EQ(text.find("it contradicts itself: " + expected), 0u) << text;
  }
}

TEST(ArchiveReasons, OfResultsThatContradictThemselves) {
  auto result = filled<Result>(9);
  result.iterations[2].correspondences[1].target = 8;
  EXPECT_EQ(reason<Result>(pack(result)), "it contradicts itself: a correspondence of a keypoint that is not there");
  result = filled<Result>(9);
  result.termination = static_cast<Termination>(5);
  EXPECT_NE(reason<Result>(pack(result)).find("there is no termination reason 5"), std::string::npos);
  result = filled<Result>(9);
  result.options.descriptor.radius = -1;
  EXPECT_NE(reason<Result>(pack(result)).find("radius"), std::string::npos);
}

TEST(ArchiveReasons, OfNetworksThatContradictThemselves) {
  const auto reason_of = [](auto change) {
    auto network = filled<Network>(9);
    change(network);
    return reason<Network>(pack(network));
  };
  EXPECT_EQ(reason_of([](Network&) {}), "none");
  const std::string contradiction = "it contradicts itself: ";
  EXPECT_EQ(reason_of([](Network& n) { n.scans[1].component = 8; }),
            contradiction + "a scan of a component that is not there");
  EXPECT_EQ(reason_of([](Network& n) { n.components[2].clear(); }),
            contradiction + "a component without scans, or of one that is not there");
  EXPECT_EQ(reason_of([](Network& n) { n.components[2][3] = 8; }),
            contradiction + "a component without scans, or of one that is not there");
  EXPECT_EQ(reason_of([](Network& n) { n.links[2].target = 8; }), contradiction + "a link of a scan that is not there");
}

/// The bytes themselves, so that a machine of another byte order cannot agree with itself and nobody else.
TEST(ArchiveForm, IsLittleEndian) {
  Encoder out;
  put(out, KeypointMatch{0x01020304, 5});
  put(out, std::vector<float>{1.0f});
  put(out, std::optional<bool>());
  EXPECT_EQ(out.bytes(), std::string_view("\x04\x03\x02\x01\x05\0\0\0\x01\0\0\0\0\0\0\0\0\0\x80\x3f\0", 21));
}

class ArchiveFile : public ::testing::Test {
 protected:
  ArchiveFile() : folder_(std::filesystem::temp_directory_path() / ("igsp_archive_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ArchiveFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(ArchiveFile, ReadsWhatItWrote) {
  const auto features = filled<Features>(10);
  write_features(folder_ / "features", features);
  EXPECT_EQ(to_bytes(read_features(folder_ / "features")), to_bytes(features));
  const auto result = filled<Result>(11);
  write_result(folder_ / "result", result);
  EXPECT_EQ(to_bytes(read_result(folder_ / "result")), to_bytes(result));
  EXPECT_EQ(to_bytes(result_from_bytes(to_bytes(result))), to_bytes(result));
}

TEST_F(ArchiveFile, RefusesWithPathAndReason) {
  write_features(folder_ / "features", filled<Features>(12));
  try {
    read_result(folder_ / "features");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), (folder_ / "features").string() + ": it holds Features, not Result");
  }
  std::filesystem::resize_file(folder_ / "features", 200);
  EXPECT_THROW(read_features(folder_ / "features"), FileError);
  EXPECT_THROW(read_features(folder_ / "nowhere"), FileError);
  EXPECT_THROW(read_features(folder_), FileError);
  EXPECT_THROW(write_features(folder_ / "no" / "folder", filled<Features>(12)), FileError);
  EXPECT_THROW(features_from_bytes("nothing"), InvalidArgument);
  EXPECT_THROW(result_from_bytes(""), InvalidArgument);
}

// What it is for: the answer from features that were away is the answer.
TEST_F(ArchiveFile, FeaturesAlignAsBefore) {
  Options options;
  options.scale.voxel_size = 0.4;
  const auto scans = simulate("park", {.points = 20000});
  const Features source = extract_features(scans[1], options), target = extract_features(scans[0], options);
  write_features(folder_ / "source", source);
  write_features(folder_ / "target", target);
  Result direct = align(source, target, options);
  Result away = align(read_features(folder_ / "source"), read_features(folder_ / "target"), options);
  EXPECT_TRUE(direct.registered);
  for (Result* result : {&direct, &away}) {
    result->timings_s.clear();
    for (IterationRecord& record : result->iterations) record.seconds = 0;
  }
  EXPECT_EQ(to_bytes(away), to_bytes(direct));
}

}  // namespace
}  // namespace igsp::archive
