#include "registration/screening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>

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

/// All that is matched again, whether or not it was put off.
std::vector<Rematch> screen(CommonFrame& frame, const std::vector<Hypothesis>& hypotheses,
                            const FreeSpaceQuestion& ask_free_space) {
  const Options options;
  Screening screening(frame, hypotheses, options, ask_free_space);
  std::vector<Rematch> screened = screening.most_promising(silent);
  std::ranges::move(screening.put_off(), std::back_inserter(screened));
  EXPECT_FALSE(screening.has_put_off());
  std::ranges::stable_sort(screened, std::greater(), promise_of);
  return screened;
}

bool is_right(const Scene& scene, const Rematch& match) {
  return (match.target_from_source.linear() - scene.truth.linear()).norm() < 0.05;
}

TEST(Screening, FindsTheRightOneOfManyWithMoreInliers) {
  const Scene scene(3);
  CommonFrame frame = scene.frame();
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 20, 3, 10), {});
  EXPECT_TRUE(is_right(scene, screened.front()));
  EXPECT_EQ(screened.size(), proposed);
  EXPECT_TRUE(std::ranges::is_sorted(screened, std::greater(), &Rematch::agreeing));
}

TEST(Screening, AFirstLookFindsTheBestQuarterOfThoseAfterTheFirstThree) {
  const Scene scene(3);
  const Options options;
  for (const std::size_t place : {3u, 12u, 23u}) {
    CommonFrame frame = scene.frame();
    const std::vector<Hypothesis> hypotheses = proposals(scene, place, 25, 10);
    const FreeSpaceQuestion unknown;
    Screening screening(frame, hypotheses, options, unknown);
    const std::vector<Rematch> promising = screening.most_promising(silent);
    EXPECT_EQ(promising.size(), 3u + 21 / 4);
    EXPECT_EQ(std::ranges::count_if(promising, [&](const Rematch& match) { return is_right(scene, match); }), 1);
    EXPECT_TRUE(screening.has_put_off());
    EXPECT_EQ(screening.put_off().size(), 0u) << "a clear winner of more inliers needs no rivals";
  }
}

TEST(Screening, WhatAFirstLookPutsOffIsMatchedAgainLater) {
  const Scene scene(3);
  CommonFrame frame = scene.frame();
  const Options options;
  std::vector<Hypothesis> wrong = proposals(scene, 0, 3, 10);
  wrong.erase(wrong.begin());
  const FreeSpaceQuestion unknown;
  Screening screening(frame, wrong, options, unknown);
  EXPECT_EQ(screening.most_promising(silent).size(), 3u + 20 / 4);
  EXPECT_EQ(screening.put_off().size(), 15u);
  EXPECT_FALSE(screening.has_put_off());
}

TEST(Screening, NothingIsPutOffWhereKeypointsAreFew) {
  const Scene scene(3, {.half_side = 1.5});
  CommonFrame frame = scene.frame();
  const Options options;
  const std::vector<Hypothesis> hypotheses = proposals(scene, 20, 3, 10);
  const FreeSpaceQuestion unknown;
  Screening screening(frame, hypotheses, options, unknown);
  EXPECT_EQ(screening.most_promising(silent).size(), proposed);
  EXPECT_FALSE(screening.has_put_off());
}

TEST(Screening, AClearWinnerSparesAllThatCannotBeItsRivals) {
  const Scene scene(4);
  CommonFrame frame = scene.frame(), other = scene.frame();
  EXPECT_EQ(screen(frame, proposals(scene, 0, 20, 9), {}).size(), 1u);
  EXPECT_EQ(screen(other, proposals(scene, 0, 20, 10), {}).size(), proposed);
}

TEST(Screening, TheStrongestOfSeveralClearWinnersDecides) {
  const Scene scene(4);
  CommonFrame frame = scene.frame();
  std::vector<Hypothesis> hypotheses = proposals(scene, 0, 20, 7);
  hypotheses[1] = {scene.truth, 12};
  EXPECT_EQ(screen(frame, hypotheses, {}).size(), 2u);
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
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 0, 20, 9), against);
  EXPECT_EQ(screened.size(), proposed);
  const auto place = std::ranges::find_if(screened, is_the_right_one, &Rematch::target_from_source);
  ASSERT_NE(place, screened.end());
  EXPECT_EQ(place->free_space.source->contradicting, 200u);
  EXPECT_EQ(screen(other, proposals(scene, 0, 20, 9), against_others).size(), 1u);
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
  const Rematch found = screen(frame, hypotheses, against_the_truth).front();
  EXPECT_GT((found.target_from_source.translation() - scene.truth.translation()).norm(), 2);
  const Rematch by_vote = screen(frame, hypotheses, {}).front();
  EXPECT_LT((by_vote.target_from_source.translation() - scene.truth.translation()).norm(), 0.3);
}

TEST(Screening, FewMatchesAreNoClearWinnerHoweverManyOfThemAgree) {
  const Scene scene(4, {.half_side = 0.6});
  CommonFrame frame = scene.frame();
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 0, 20, 9), {});
  EXPECT_EQ(screened.size(), proposed);
  const Rematch& best = screened.front();
  EXPECT_TRUE(best.agreeing > 5 && best.agreeing < 15 && best.agreeing >= 0.7 * best.matches.size())
      << best.agreeing << " of " << best.matches.size();
}

TEST(Screening, ManyMatchesAreNoClearWinnerWhereFewOfThemAgree) {
  const Scene scene(4, {.half_side = 4, .common = 2});
  CommonFrame frame = scene.frame();
  const std::vector<Rematch> screened = screen(frame, proposals(scene, 0, 20, 9), {});
  EXPECT_EQ(screened.size(), proposed);
  const Rematch& best = screened.front();
  EXPECT_TRUE(is_right(scene, best));
  EXPECT_TRUE(best.agreeing > 15 && best.agreeing < 0.55 * best.matches.size())
      << best.agreeing << " of " << best.matches.size();
}

}  // namespace
}  // namespace igsp
