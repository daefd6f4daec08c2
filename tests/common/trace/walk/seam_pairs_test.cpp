// Two blocks of every kind, each with every other, that meet 2:1 (hanging nodes), shifted, or overlap: lines are those of the
// closed form of u = (-y, x, 0.3), which a joined mesh gives as well, within the errors that they state.

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/trace/walk/seam_meshes.h"

namespace palpate {
namespace {

using namespace test::seams;

/// Those of seam_meshes.h: lattices, cells with points of their own (as discontinuous Galerkin has them), joined cells.
std::vector<int> all_kinds() {
  std::vector<int> kinds(kBlockKinds.begin(), kBlockKinds.end());
  kinds.insert(kinds.end(), kJoinedKinds.begin(), kJoinedKinds.end());
  return kinds;
}

/// @param make the two blocks of two kinds. @param overlap whether they are to be noted as overlapping.
template <class Make>
void expect_all_pairs(const Make& make, bool overlap) {
  for (const int kind : all_kinds()) {
    for (const int other : all_kinds()) {
      SCOPED_TRACE(kind);
      SCOPED_TRACE(other);
      const Field field = field_of(make(kind, other));
      EXPECT_EQ(noted(field, "2 blocks overlap"), overlap);
      expect_helices(field, 1e-6, true);
    }
  }
}

TEST(SeamPairs, BlocksThatMeetTwoToOne) {
  expect_all_pairs(
      [](int kind, int other) {
        return std::vector{block_of(kind, {4, 4, 3}, {-1, -1, 0}, {1, 1, 0.8}),
                           block_of(other, {8, 8, 6}, {-1, -1, 0.8}, {1, 1, 2})};
      },
      false);
}

TEST(SeamPairs, BlocksThatMeetShifted) {
  expect_all_pairs(
      [](int kind, int other) {
        return std::vector{block_of(kind, {5, 4, 6}, {-1, -1, 0}, {0.1, 1, 2}),
                           block_of(other, {3, 7, 5}, {0.1, -1, 0}, {1, 1, 2})};
      },
      false);
}

TEST(SeamPairs, BlocksThatOverlap) {
  expect_all_pairs(
      [](int kind, int other) {
        return std::vector{block_of(kind, {6, 6, 6}, {-1, -1, 0}, {1, 1, 2}),
                           block_of(other, {7, 8, 9}, {-0.43, -0.42, 0.31}, {0.41, 0.44, 1.43})};
      },
      true);
}

// The joined mesh itself, of every kind.
TEST(SeamPairs, OneBlockIsTheReference) {
  for (const int kind : all_kinds()) {
    if (kind == -1 || kind == -2) continue;  // alone, these have no tetrahedra
    SCOPED_TRACE(kind);
    expect_helices(field_of({block_of(kind, {6, 6, 6}, {-1, -1, 0}, {1, 1, 2})}), 1e-6, true);
  }
}

}  // namespace
}  // namespace palpate
