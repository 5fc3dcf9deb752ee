// Out of memory at any place: std::bad_alloc comes out of the library, nothing is left half done, and the next call
// answers as if nothing had been. And nothing is lost, on several threads either: what the process keeps beyond that is
// the allocator's, which has a pool of freed memory a thread.
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
std::atomic<std::int64_t> alive{0};

void* allocate(std::size_t size) {
  if (allocations_left != never && --allocations_left < 0) throw std::bad_alloc();
  void* place = std::malloc(size > 0 ? size : 1);
  if (place == nullptr) throw std::bad_alloc();
  ++alive;
  return place;
}

void release(void* place) {
  if (place != nullptr) --alive;
  std::free(place);
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new[](std::size_t size) {
  return allocate(size);
}
// std::stable_sort asks so. The library's own would call the ones above, but a sanitiser has its own.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return allocate(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
  return operator new(size, tag);
}
void operator delete(void* place) noexcept {
  release(place);
}
void operator delete[](void* place) noexcept {
  release(place);
}
void operator delete(void* place, std::size_t) noexcept {
  release(place);
}
void operator delete[](void* place, std::size_t) noexcept {
  release(place);
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

TEST(Allocation, NothingIsLostOnSeveralThreads) {
  const Points cloud = testing::simulated_pair("object", 3000).source;
  Options options;
  options.threads = 4;
  const auto extract = [&](int times) {
    for (int i = 0; i < times; ++i) extract_features(cloud, options);
    return alive.load();
  };
  const std::int64_t before = extract(20);  // what threads and tables keep is there by now
  EXPECT_LE(extract(40), before + 20);      // a single lost allocation each time would be 40
}

}  // namespace
}  // namespace igsp
