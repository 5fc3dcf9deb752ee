#include "network/pose_equations.hpp"

#include <gtest/gtest.h>

#include "network/network_testing.hpp"

namespace igsp {
namespace {

using network_testing::Dice;

constexpr double honest = 9;  // times what independent residuals would scatter

struct Links {
  std::vector<Transformation> poses;
  std::vector<Eigen::Vector3d> centres;
  std::vector<RelativeFactor> factors;

  explicit Links(std::size_t scans)
      : poses(scans, Transformation::Identity()), centres(scans, Eigen::Vector3d::Zero()) {}

  void link(std::size_t source, std::size_t target, const Matrix6& information, bool shares_errors) {
    RelativeFactor& factor = factors.emplace_back();
    factor.source = source;
    factor.target = target;
    factor.target_from_source = poses[target].inverse() * poses[source];
    factor.information = information;
    if (shares_errors) factor.scatter = honest * information;
  }

  // The first scan stays.
  std::vector<Matrix6> covariances(int degrees_of_freedom = 6) const {
    std::vector<bool> is_free(poses.size(), true);
    is_free[0] = false;
    PoseEquations equations(centres, is_free, degrees_of_freedom);
    for (const RelativeFactor& factor : factors) equations.add(factor);
    return equations.covariances();
  }
};

Matrix6 some_information(Dice& dice) {
  Matrix6 root = Matrix6::Identity();
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) += dice.uniform(-0.3, 0.3);
  return root * root.transpose();
}

Links all_with_all(std::size_t scans, const Matrix6& information, bool share_errors) {
  Links links(scans);
  for (std::size_t i = 0; i < scans; ++i) {
    for (std::size_t j = 0; j < i; ++j) links.link(i, j, information, share_errors);
  }
  return links;
}

TEST(PoseEquations, IndependentLinksAverageTheirErrorsOut) {
  Dice dice(1);
  const Matrix6 information = some_information(dice);
  for (const Matrix6& covariance : all_with_all(5, information, false).covariances()) {
    if (covariance.isZero(0)) continue;
    EXPECT_LT((covariance - 2.0 / 5.0 * information.inverse()).norm(), 1e-9);
  }
}

TEST(PoseEquations, WhatIsWrongInAScanNoSecondLinkAveragesOut) {
  Dice dice(2);
  const Matrix6 information = some_information(dice);
  for (const int degrees_of_freedom : {6, 4}) {
    const Matrix6 one = all_with_all(2, information, true).covariances(degrees_of_freedom)[1];
    if (degrees_of_freedom == 6) EXPECT_LT((one - honest * information.inverse()).norm(), 1e-8);
    for (const std::size_t scans : {3, 5, 8}) {
      const std::vector<Matrix6> all = all_with_all(scans, information, true).covariances(degrees_of_freedom);
      EXPECT_TRUE(all[0].isZero(0));
      for (std::size_t i = 1; i < scans; ++i) EXPECT_LT((all[i] - one).norm(), 1e-8 * one.norm()) << scans;
    }
  }
}

TEST(PoseEquations, AlongAChainErrorsAddUp) {
  const Matrix6 information = Matrix6::Identity();
  Links chain(4);
  for (std::size_t i = 1; i < 4; ++i) chain.link(i, i - 1, information, true);
  const std::vector<Matrix6> covariances = chain.covariances();
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LT((covariances[i] - honest * static_cast<double>(i) * information).norm(), 1e-8) << i;
  }
}

TEST(PoseEquations, ALinkThatTellsLittleChangesLittle) {
  Links links(3);
  links.link(1, 0, Matrix6::Identity(), true);
  links.link(2, 1, Matrix6::Identity(), true);
  const Matrix6 before = links.covariances()[2];
  links.link(2, 0, 1e-4 * Matrix6::Identity(), true);
  EXPECT_LT((links.covariances()[2] - before).norm(), 0.01 * before.norm());
}

}  // namespace
}  // namespace igsp
