#include "registration/screening.hpp"

#include <gtest/gtest.h>

#include "registration/frame_testing.hpp"

namespace igsp {
namespace {

using testing::Random;
using testing::Scene;

constexpr std::size_t proposed = 24;
const auto silent = [](double) {};

/// The right pose at `place` among wrong ones.
std::vector<Hypothesis> proposals(const Scene& scene, std::size_t place, std::size_t inliers_of_the_right,
                                  std::size_t inliers_of_others) {
  Random random(5);
  std::vector<Hypothesis> hypotheses;
  for (std::size_t i = 0; i < proposed; ++i) {
    const bool is_right = i == place;
    hypotheses.push_back(
        {is_right ? scene.truth : random.motion(1), is_right ? inliers_of_the_right : inliers_of_others});
  }
  return hypotheses;
}

bool is_right(const Scene& scene, const Rematch& match) {
  return (match.target_from_source.linear() - scene.truth.linear()).norm() < 0.05;
}

TEST(Screening, FindsTheRightOneOfManyWithMoreInliers) {
  const Scene scene(3);
  CommonFrame frame = scene.frame();
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 20, 3, 10), Options(), {}, silent);
  EXPECT_TRUE(is_right(scene, screened.front()));
  EXPECT_EQ(screened.size(), proposed);
  EXPECT_TRUE(std::ranges::is_sorted(screened, std::greater(), &Rematch::agreeing));
}

TEST(Screening, AClearWinnerSparesAllThatCannotBeItsRivals) {
  const Scene scene(4);
  CommonFrame frame = scene.frame(), other = scene.frame();
  EXPECT_EQ(screen(frame, proposals(scene, 0, 20, 9), Options(), {}, silent).size(), 1u);
  EXPECT_EQ(screen(other, proposals(scene, 0, 20, 10), Options(), {}, silent).size(), proposed);
}

TEST(Screening, TheStrongestOfSeveralClearWinnersDecides) {
  const Scene scene(4);
  CommonFrame frame = scene.frame();
  std::vector<Hypothesis> hypotheses = proposals(scene, 0, 20, 7);
  hypotheses[1] = {scene.truth, 12};
  EXPECT_EQ(screen(frame, hypotheses, Options(), {}, silent).size(), 2u);
}

TEST(Screening, WhatFreeSpaceContradictsIsNoClearWinnerAndComesLater) {
  const Scene scene(4);
  CommonFrame frame = scene.frame(), other = scene.frame();
  const auto is_the_right_one = [&](const Transformation& pose) {
    return (pose.linear() - scene.truth.linear()).norm() < 0.05;
  };
  const FreeSpace empty{FreeSpaceViolation{1000, 0}, std::nullopt}, filled{FreeSpaceViolation{1000, 200}, std::nullopt};
  const auto against = [&](const Transformation& pose) { return is_the_right_one(pose) ? filled : empty; };
  const auto against_others = [&](const Transformation& pose) { return is_the_right_one(pose) ? empty : filled; };
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 0, 20, 9), Options(), against, silent);
  EXPECT_EQ(screened.size(), proposed);
  const auto place = std::ranges::find_if(screened, is_the_right_one, &Rematch::target_from_source);
  ASSERT_NE(place, screened.end());
  EXPECT_EQ(place->free_space.source->contradicting, 200u);
  EXPECT_EQ(screen(other, proposals(scene, 0, 20, 9), Options(), against_others, silent).size(), 1u);
}

TEST(Screening, AHypothesisStaysWhereFreeSpaceContradictsTheVote) {
  const Scene scene(4, {.half_side = 0.6});
  CommonFrame frame = scene.frame();
  Transformation beside = scene.truth;
  beside.translation() += Eigen::Vector3d(3, 0, 0);
  const FreeSpace empty{FreeSpaceViolation{1000, 0}, std::nullopt}, filled{FreeSpaceViolation{1000, 300}, std::nullopt};
  const auto against_the_truth = [&](const Transformation& pose) {
    return (pose.translation() - scene.truth.translation()).norm() < 1 ? filled : empty;
  };
  const std::vector<Hypothesis> hypotheses{{beside, 10}};
  const Rematch found = screen(frame, hypotheses, Options(), against_the_truth, silent).front();
  EXPECT_GT((found.target_from_source.translation() - scene.truth.translation()).norm(), 2);
  const Rematch by_vote = screen(frame, hypotheses, Options(), {}, silent).front();
  EXPECT_LT((by_vote.target_from_source.translation() - scene.truth.translation()).norm(), 0.3);
}

TEST(Screening, FewMatchesAreNoClearWinnerHoweverManyOfThemAgree) {
  const Scene scene(4, {.half_side = 0.6});
  CommonFrame frame = scene.frame();
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 0, 20, 9), Options(), {}, silent);
  EXPECT_EQ(screened.size(), proposed);
  const Rematch& best = screened.front();
  EXPECT_TRUE(best.agreeing > 5 && best.agreeing < 15 && best.agreeing >= 0.7 * best.matches.size())
      << best.agreeing << " of " << best.matches.size();
}

TEST(Screening, ManyMatchesAreNoClearWinnerWhereFewOfThemAgree) {
  const Scene scene(4, {.half_side = 4, .common = 2});
  CommonFrame frame = scene.frame();
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 0, 20, 9), Options(), {}, silent);
  EXPECT_EQ(screened.size(), proposed);
  const Rematch& best = screened.front();
  EXPECT_TRUE(is_right(scene, best));
  EXPECT_TRUE(best.agreeing > 15 && best.agreeing < 0.55 * best.matches.size())
      << best.agreeing << " of " << best.matches.size();
}

}  // namespace
}  // namespace igsp
