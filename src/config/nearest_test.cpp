#include "config/nearest.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <string>

namespace igsp {
namespace {

TEST(EditDistance, KnownCases) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("radius", "raduis"), 1u);
  EXPECT_EQ(edit_distance("ab", "ba"), 1u);
}

TEST(EditDistance, IsSymmetricAndBoundedByTheLongerWord) {
  EXPECT_TRUE(rc::check([](const std::string& a, const std::string& b) {
    const std::size_t distance = edit_distance(a, b);
    RC_ASSERT(distance == edit_distance(b, a));
    RC_ASSERT(distance <= std::max(a.size(), b.size()));
    RC_ASSERT((distance == 0) == (a == b));
  }));
}

TEST(Nearest, FindsTheWordMeant) {
  constexpr std::string_view keys[] = {"search", "keypoints.pca_radius", "descriptor.radius", "energy.p1"};
  EXPECT_EQ(nearest("serch", keys), "search");
  EXPECT_EQ(nearest("pca_raduis", keys), "keypoints.pca_radius");
  EXPECT_EQ(nearest("keypoint.pca_radius", keys), "keypoints.pca_radius");
  EXPECT_EQ(nearest("energy.p", keys), "energy.p1");
}

}  // namespace
}  // namespace igsp
