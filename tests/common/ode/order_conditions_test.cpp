// Order conditions of the tables, by rooted trees (Hairer, Norsett, Wanner 1993, II.2): a method has order p
// if sum_i b_i Phi_i(tau) = 1 / gamma(tau) for every tree of up to p nodes.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/ode/tableau.h"

namespace palpate {
namespace {

constexpr double kRounding = 1e-13;

struct Tree {
  int order = 1;
  double density = 1.0;       // gamma
  std::vector<int> children;  // indices of smaller trees, not falling
};

/// All rooted trees of up to `order` nodes; a tree is a multiset of smaller ones.
std::vector<Tree> rooted_trees(int order) {
  std::vector<Tree> trees{Tree{}};
  for (int n = 2; n <= order; ++n) {
    const int known = static_cast<int>(trees.size());
    std::vector<Tree> made;
    std::vector<int> picked;
    const auto pick = [&](const auto& self, int first, int left) -> void {
      if (left == 0) {
        Tree tree{.order = n, .density = static_cast<double>(n), .children = picked};
        for (const int child : picked) tree.density *= trees[static_cast<std::size_t>(child)].density;
        made.push_back(tree);
        return;
      }
      for (int i = first; i < known; ++i) {
        if (trees[static_cast<std::size_t>(i)].order > left) continue;
        picked.push_back(i);
        self(self, i, left - trees[static_cast<std::size_t>(i)].order);
        picked.pop_back();
      }
    };
    pick(pick, 0, n - 1);
    trees.insert(trees.end(), made.begin(), made.end());
  }
  return trees;
}

/// Phi_i of every tree: Phi_i(dot) = 1, Phi_i([t_1 .. t_m]) = prod_k sum_j a_ij Phi_j(t_k).
template <class Tableau>
std::vector<std::vector<double>> stage_weights(const std::vector<Tree>& trees) {
  std::vector<std::vector<double>> phi;
  for (const Tree& tree : trees) {
    std::vector<double> weight(Tableau::kStages, 1.0);
    for (const int child : tree.children) {
      for (std::size_t i = 0; i < weight.size(); ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < weight.size(); ++j) {
          sum += Tableau::a[i][j] * phi[static_cast<std::size_t>(child)][j];
        }
        weight[i] *= sum;
      }
    }
    phi.push_back(weight);
  }
  return phi;
}

/// The highest order up to which weights meet the conditions at `theta`.
template <class Tableau>
int order_of(const std::vector<double>& weights, double theta = 1.0) {
  constexpr int kUpTo = 6;
  const std::vector<Tree> trees = rooted_trees(kUpTo);
  const auto phi = stage_weights<Tableau>(trees);
  int order = kUpTo;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * phi[t][i];
    if (std::abs(sum - std::pow(theta, trees[t].order) / trees[t].density) > kRounding) {
      order = std::min(order, trees[t].order - 1);
    }
  }
  return order;
}

template <class Tableau>
class OrderConditions : public testing::Test {};
using Tableaus = testing::Types<Euler, Rk4, Bs32, Rk34, Dp54>;
TYPED_TEST_SUITE(OrderConditions, Tableaus);

TEST(RootedTrees, AreAsManyAsCayleyCounted) {
  std::vector<int> count(7, 0);
  for (const Tree& tree : rooted_trees(6)) ++count[static_cast<std::size_t>(tree.order)];
  EXPECT_EQ(count, (std::vector<int>{0, 1, 1, 2, 4, 9, 20}));
}

TYPED_TEST(OrderConditions, HoldForTheKeptSolutionUpToItsOrderAndNoFurther) {
  const std::vector<double> b(TypeParam::b.begin(), TypeParam::b.end());
  EXPECT_EQ(order_of<TypeParam>(b), TypeParam::kOrder);
}

TYPED_TEST(OrderConditions, HoldForTheEmbeddedSolutionUpToItsOrderAndNoFurther) {
  if (TypeParam::kEmbeddedOrder == 0) return;  // nothing embedded to look at
  std::vector<double> b(TypeParam::b.begin(), TypeParam::b.end());
  for (std::size_t i = 0; i < b.size(); ++i) b[i] -= TypeParam::e[i];
  EXPECT_EQ(order_of<TypeParam>(b), TypeParam::kEmbeddedOrder);
}

TYPED_TEST(OrderConditions, HoldForTheDenseOutputEverywhereInTheStep) {
  int lowest = 6;
  for (const double theta : {0.1, 0.3, 0.5, 0.77, 0.95}) {
    std::vector<double> weights;
    for (const auto& row : TypeParam::p) {
      double sum = 0.0;
      for (std::size_t j = row.size(); j-- > 0;) sum = theta * (row[j] + sum);
      weights.push_back(sum);
    }
    lowest = std::min(lowest, order_of<TypeParam>(weights, theta));
  }
  EXPECT_EQ(lowest, TypeParam::kDenseOrder);
}

TYPED_TEST(OrderConditions, RowsSumToTheirNodesAndTheLastStageIsTheEndWhereItSaysSo) {
  for (std::size_t i = 0; i < TypeParam::a.size(); ++i) {
    double sum = 0.0;
    for (const double a : TypeParam::a[i]) sum += a;
    EXPECT_NEAR(sum, TypeParam::c[i], kRounding);
  }
  if (TypeParam::kFirstSameAsLast) {
    for (std::size_t j = 0; j < TypeParam::b.size(); ++j) {
      EXPECT_DOUBLE_EQ(TypeParam::a[TypeParam::kStages - 1][j], TypeParam::b[j]);
    }
  }
}

}  // namespace
}  // namespace palpate
