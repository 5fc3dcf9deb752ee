#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace igsp {
namespace {

TEST(ParallelBlocks, VisitEveryIndexOnce) {
  for (const std::size_t size : {0, 1, 5, 63, 64, 1000}) {
    for (const std::size_t grain : {1, 16, 2000}) {
      for (const int threads : {0, 1, 2, 4, 64}) {
        std::vector<std::atomic<int>> visits(size);
        parallel_blocks(size, threads, grain, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++visits.at(i);
        });
        for (std::size_t i = 0; i < size; ++i) {
          ASSERT_EQ(visits[i], 1) << "index " << i << " of " << size << ", grain " << grain << ", threads " << threads;
        }
      }
    }
  }
}

TEST(ParallelBlocks, OneThreadIsTheCallerAndOneBlock) {
  int blocks = 0;
  parallel_blocks(1000, 1, 1, [&](std::size_t begin, std::size_t end) {
    ++blocks;
    EXPECT_EQ(begin, 0u);
    EXPECT_EQ(end, 1000u);
  });
  EXPECT_EQ(blocks, 1);
}

TEST(ParallelBlocks, ExceptionsReachTheCaller) {
  for (const int threads : {1, 2, 4}) {
    const auto run = [&] {
      parallel_blocks(1000, threads, 1, [](std::size_t begin, std::size_t end) {
        if (begin <= 500 && 500 < end) throw std::runtime_error("in a block");
      });
    };
    EXPECT_THROW(run(), std::runtime_error) << threads << " threads";
  }
}

TEST(ParallelPair, DoesEachOnce) {
  for (const int threads : {0, 1, 2, 3, 8}) {
    std::atomic<int> first = 0, second = 0;
    parallel_pair(
        threads, [&] { ++first; }, [&] { ++second; });
    EXPECT_EQ(first, 1) << threads << " threads";
    EXPECT_EQ(second, 1) << threads << " threads";
  }
}

}  // namespace
}  // namespace igsp
