// Out of memory at any place: std::bad_alloc comes out of the library, nothing is left half done, and the next call
// answers as if nothing had been.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>

#include "igsp/align.hpp"
#include "scenes.hpp"

namespace {

constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
std::atomic<std::int64_t> allocations_left{never};

void* allocate(std::size_t size) {
  if (allocations_left != never && --allocations_left < 0) throw std::bad_alloc();
  if (void* place = std::malloc(size > 0 ? size : 1)) return place;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new[](std::size_t size) {
  return allocate(size);
}
void operator delete(void* place) noexcept {
  std::free(place);
}
void operator delete[](void* place) noexcept {
  std::free(place);
}
void operator delete(void* place, std::size_t) noexcept {
  std::free(place);
}
void operator delete[](void* place, std::size_t) noexcept {
  std::free(place);
}

namespace igsp {
namespace {

/// Runs it with only so many allocations: whether they were enough.
template <typename Function>
bool enough(std::int64_t allocations, const Function& function) {
  allocations_left = allocations;
  try {
    function();
    allocations_left = never;
    return true;
  } catch (const std::bad_alloc&) {
    allocations_left = never;
    return false;
  }
}

TEST(Allocation, FailsAnywhereAndNothingIsHeld) {
  const testing::Pair clouds = testing::simulated_pair("object", 3000);
  Options options;
  options.threads = 1;
  const Result expected = align(clouds.source, clouds.target, options);
  Result result;
  const auto run = [&] { result = align(clouds.source, clouds.target, options); };
  std::int64_t allocations = 0;
  int failures = 0;
  while (!enough(allocations, run)) {
    ++failures;
    allocations += 1 + allocations / 4;  // each of the first ones, then ever fewer
  }
  EXPECT_GT(failures, 20);
  EXPECT_EQ(result.reason, expected.reason);
  EXPECT_EQ(result.target_from_source.matrix(), expected.target_from_source.matrix());
}

}  // namespace
}  // namespace igsp
