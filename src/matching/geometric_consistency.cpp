#include "matching/geometric_consistency.hpp"

#include <bit>
#include <cmath>

#include "core/multiversion.hpp"
#include "core/parallel.hpp"

namespace igsp {
namespace {

// The mean of two rotations is surer than either, and so is where it turns to.
constexpr double turned_share = 0.75;  // of the angle between the rotations

// Candidates as separate arrays, padded to whole bitset words so that the inner loop has no tail.
struct Arrays {
  std::vector<float> values[10];  // source x y z, target x y z, quaternion w x y z
  const float* operator[](int i) const { return values[i].data(); }
};

Arrays make_arrays(std::span<const Candidate> candidates, PointView source, PointView target) {
  Arrays arrays;
  const std::size_t padded = (candidates.size() + 63) / 64 * 64;
  for (auto& values : arrays.values) values.assign(padded, 0.0f);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Eigen::Vector3f a = source[candidates[c].source].cast<float>();
    const Eigen::Vector3f b = target[candidates[c].target].cast<float>();
    const Eigen::Quaternionf& q = candidates[c].target_from_source;
    const float row[10] = {a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), q.w(), q.x(), q.y(), q.z()};
    for (int i = 0; i < 10; ++i) arrays.values[i][c] = row[i];
  }
  return arrays;
}

struct Limits {
  float length_tolerance, squared_min_length, min_cosine, min_direction_cosine;
};

IGSP_MULTIVERSION int common_bits(const std::uint64_t* x, const std::uint64_t* y, std::size_t words) {
  int count = 0;
  for (std::size_t w = 0; w < words; ++w) count += std::popcount(x[w] & y[w]);
  return count;
}

IGSP_MULTIVERSION void agreement_row(const Arrays& arrays, std::size_t c, std::size_t words, Limits limits,
                                     std::uint64_t* row) {
  const float *ax = arrays[0], *ay = arrays[1], *az = arrays[2], *bx = arrays[3], *by = arrays[4], *bz = arrays[5];
  const float *qw = arrays[6], *qx = arrays[7], *qy = arrays[8], *qz = arrays[9];
  for (std::size_t word = 0; word < words; ++word) {
    unsigned char agrees[64];
    for (int lane = 0; lane < 64; ++lane) {
      const std::size_t d = 64 * word + lane;
      const float dax = ax[d] - ax[c], day = ay[d] - ay[c], daz = az[d] - az[c];
      const float dbx = bx[d] - bx[c], dby = by[d] - by[c], dbz = bz[d] - bz[c];
      const float a2 = dax * dax + day * day + daz * daz, b2 = dbx * dbx + dby * dby + dbz * dbz;
      // |sqrt a2 - sqrt b2| < tolerance, without square roots: (a2 - b2)^2 < tol^2 (a + b)^2 = tol^2 (a2 + b2 + 2 ab);
      // with ab >= min(a2, b2), and equality where it matters, this is the same to second order in the tolerance.
      const float difference = a2 - b2;
      const float sum2 = a2 + b2 + 2.0f * (a2 < b2 ? a2 : b2);
      const float dot = qw[d] * qw[c] + qx[d] * qx[c] + qy[d] * qy[c] + qz[d] * qz[c];
      const int lengths = difference * difference < limits.length_tolerance * limits.length_tolerance * sum2;
      const int long_enough = (a2 > limits.squared_min_length) & (b2 > limits.squared_min_length);
      const int rotations = dot * dot > limits.min_cosine * limits.min_cosine;
      // b - b' lies where the mean of both rotations turns a - a' to. With q = q_c + q_d, of the same sign:
      // b . (q a q*) = 2 (u.a)(u.b) + (w^2 - u.u) a.b + 2 w (u x a).b, and |q|^2 = 2 + 2 |q_c . q_d|.
      const float sign = dot < 0 ? -1.0f : 1.0f;
      const float w = qw[c] + sign * qw[d], x = qx[c] + sign * qx[d], y = qy[c] + sign * qy[d],
                  z = qz[c] + sign * qz[d];
      const float ua = x * dax + y * day + z * daz, ub = x * dbx + y * dby + z * dbz;
      const float ab = dax * dbx + day * dby + daz * dbz;
      const float cross = (y * daz - z * day) * dbx + (z * dax - x * daz) * dby + (x * day - y * dax) * dbz;
      const float turned = 2.0f * ua * ub + (w * w - x * x - y * y - z * z) * ab + 2.0f * w * cross;
      const int directions = turned > limits.min_direction_cosine * 2.0f * (1.0f + sign * dot) * std::sqrt(a2 * b2);
      agrees[lane] = static_cast<unsigned char>(lengths & long_enough & rotations & directions);
    }
    std::uint64_t bits = 0;
    for (int lane = 0; lane < 64; ++lane) bits |= std::uint64_t{agrees[lane]} << lane;
    row[word] = bits;
  }
}

}  // namespace

int ConsistencyGraph::common_neighbours(std::size_t a, std::size_t b) const {
  return common_bits(row(a).data(), row(b).data(), words_);
}

ConsistencyGraph consistency_graph(std::span<const Candidate> candidates, PointView source, PointView target,
                                   const ConsistencyOptions& options, int threads) {
  ConsistencyGraph graph(candidates.size());
  const Arrays arrays = make_arrays(candidates, source, target);
  // The angle between rotations is twice that between their quaternions.
  const Limits limits{static_cast<float>(options.length_tolerance),
                      static_cast<float>(options.min_length * options.min_length),
                      static_cast<float>(std::cos(options.max_angle_rad / 2)),
                      static_cast<float>(std::cos(turned_share * options.max_angle_rad))};
  const std::size_t tail = candidates.size() % 64;
  parallel_blocks(candidates.size(), threads, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const auto row = graph.row(c);
      agreement_row(arrays, c, row.size(), limits, row.data());
      if (tail != 0) row.back() &= (std::uint64_t{1} << tail) - 1;  // padding agrees with nobody
    }
  });
  return graph;
}

}  // namespace igsp
