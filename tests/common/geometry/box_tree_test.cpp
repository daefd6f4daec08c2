// Searches through a tree of boxes against looking at every thing.

#include "common/geometry/box_tree.h"

#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

std::vector<Box> points_as_boxes(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) box.include({unit(random), unit(random), 0.01 * unit(random)});
  return boxes;
}

TEST(BoxTree, FindsTheNearestOfAll) {
  std::mt19937_64 random(1);
  const std::vector<Box> boxes = points_as_boxes(5000, random);
  const BoxTree tree(boxes);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 300; ++n) {
    const Vec3 x{normal(random), normal(random), normal(random)};
    const auto distance = [&](std::uint32_t i) { return glm::distance(x, boxes[i].lower); };
    double least = HUGE_VAL;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) least = std::min(least, distance(i));
    const BoxTree::Found found = tree.nearest(x, 10.0, 1 << 20, distance);
    ASSERT_TRUE(found.complete);
    ASSERT_EQ(found.value, least);
    ASSERT_EQ(tree.nearest(x, 0.5 * least, 1 << 20, distance).thing, BoxTree::kNone) << "out of reach";
  }
}

TEST(BoxTree, LooksAtFewAndNeverAtMoreThanItMay) {
  std::mt19937_64 random(2);
  const std::vector<Box> boxes = points_as_boxes(200'000, random);
  const BoxTree tree(boxes);
  const auto distance_from = [&](const Vec3& x) {
    return [&boxes, x](std::uint32_t i) { return glm::distance(x, boxes[i].lower); };
  };
  const BoxTree::Found near = tree.nearest(Vec3{0.1}, 10.0, 1 << 20, distance_from(Vec3{0.1}));
  EXPECT_LT(near.visits, 2000);
  const BoxTree::Found cut = tree.nearest(Vec3{0.1}, 10.0, 16, distance_from(Vec3{0.1}));
  EXPECT_FALSE(cut.complete);
  EXPECT_LE(cut.visits, 16 + 4);
}

// What a search with too few visits says of the rest, against looking at every thing.
TEST(BoxTree, SaysBelowWhichValueItHasLookedAtAll) {
  std::mt19937_64 random(3);
  const std::vector<Box> boxes = points_as_boxes(5000, random);
  const BoxTree tree(boxes);
  std::normal_distribution<double> normal;
  int certain = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 x{normal(random), normal(random), normal(random)};
    const auto distance = [&](std::uint32_t i) { return glm::distance(x, boxes[i].lower); };
    double least = HUGE_VAL;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) least = std::min(least, distance(i));
    EXPECT_EQ(tree.nearest(x, 10.0, 1 << 20, distance).unseen, HUGE_VAL);
    const BoxTree::Found cut = tree.nearest(x, 10.0, 4 + n % 40, distance);
    if (cut.complete) continue;
    EXPECT_GE(least, std::min(cut.unseen, cut.value));
    if (cut.value <= cut.unseen) {
      EXPECT_EQ(cut.value, least);
    }
    certain += cut.unseen > 0.0 ? 1 : 0;
  }
  EXPECT_GT(certain, 100);
}

TEST(BoxTree, OfNothingFindsNothing) {
  const BoxTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.nearest(Vec3{0.0}, 1.0, 10, [](std::uint32_t) { return 0.0; }).thing, BoxTree::kNone);
}

// Points in one place cannot be parted: the tree is no deeper for that.
TEST(BoxTree, TakesManyThingsInOnePlace) {
  std::vector<Box> boxes(10'000);
  for (Box& box : boxes) box.include(Vec3{1.0});
  const BoxTree tree(boxes);
  EXPECT_EQ(tree.nearest(Vec3{0.0}, 10.0, 1 << 20, [](std::uint32_t) { return 1.0; }).thing, 0U)
      << "the first of those that are as near";
}

}  // namespace
}  // namespace palpate
