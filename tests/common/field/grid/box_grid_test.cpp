#include "common/field/grid/box_grid.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/field/vector_field.h"
#include "tests/support/allocation_guard.h"

namespace palpate {
namespace {

/// Rounding of values of order one through some ten operations.
constexpr double kRounding = 1e-14;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }
Vec3 unit3(std::mt19937_64& random) { return {unit(random), unit(random), unit(random)}; }

BoxGrid uniform() { return {{5, 4, 6}, {-1.0, 0.5, 2.0}, {0.5, 0.25, 0.125}}; }
BoxGrid rectilinear() {
  return BoxGrid({std::vector<double>{-1.0, -0.9, 0.0, 0.3, 1.0},
                  {0.5, 0.6, 1.0, 1.25},
                  {2.0, 2.0625, 2.125, 2.25, 2.5, 2.625}});
}

/// Trilinear, with every product of coordinates present.
Vec3 trilinear(const Vec3& x) {
  return {x.x * x.y * x.z, 1.0 + 2.0 * x.x - x.y * x.z, x.z * x.x + 0.5 * x.y - 3.0 * x.x * x.y * x.z};
}

Mat3 trilinear_jacobian(const Vec3& x) {
  Mat3 m{0.0};
  m[0] = {x.y * x.z, 2.0, x.z - 3.0 * x.y * x.z};
  m[1] = {x.x * x.z, -x.z, 0.5 - 3.0 * x.x * x.z};
  m[2] = {x.x * x.y, -x.y, x.x - 3.0 * x.x * x.y};
  return m;
}

template <typename T>
struct Values {
  std::vector<T> numbers;
  PointVectors view;

  Values(const BoxGrid& grid, Vec3 (*value)(const Vec3&)) {
    for (int k = 0; k < grid.points().z; ++k) {
      for (int j = 0; j < grid.points().y; ++j) {
        for (int i = 0; i < grid.points().x; ++i) {
          const Vec3 v = value({grid.coordinate(0, i), grid.coordinate(1, j), grid.coordinate(2, k)});
          for (int c = 0; c < 3; ++c) numbers.push_back(static_cast<T>(v[c]));
        }
      }
    }
    view.values = std::span<const T>(numbers);
  }
};

TEST(BoxGrid, TrilinearFieldsAndTheirDerivativesAreExact) {
  std::mt19937_64 random(1);
  for (const BoxGrid& grid : {uniform(), rectilinear()}) {
    const Values<double> values(grid, trilinear);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 x = grid.bounds().lower + grid.bounds().size() * unit3(random);
      Index3 index;
      ASSERT_TRUE(grid.locate(x, index));
      BoxCell cell;
      grid.load(index, values.view, cell);
      EXPECT_FALSE(cell.bad_data);
      EXPECT_LT(glm::distance(cell.velocity(x), trilinear(x)), 20 * kRounding);
      const Mat3 found = cell.jacobian(x);
      const Mat3 exact = trilinear_jacobian(x);
      for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(found[c], exact[c]), 200 * kRounding);
    }
  }
}

TEST(BoxGrid, FloatAndDoubleValuesAreReadAlike) {
  const BoxGrid grid = uniform();
  const auto eighths = [](const Vec3& x) { return Vec3{x.x, x.y * 0.25, -x.z}; };  // exact in float
  const Values<float> floats(grid, eighths);
  const Values<double> doubles(grid, eighths);
  BoxCell a;
  BoxCell b;
  grid.load({1, 2, 3}, floats.view, a);
  grid.load({1, 2, 3}, doubles.view, b);
  EXPECT_EQ(a.c, b.c);
}

TEST(BoxGrid, PointsOnSharedFacesBelongToTheUpperCellAndOnTheBorderToTheLast) {
  for (const BoxGrid& grid : {uniform(), rectilinear()}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < grid.points()[axis]; ++i) {
        Vec3 x = grid.bounds().center();
        x[axis] = grid.coordinate(axis, i);
        Index3 cell;
        ASSERT_TRUE(grid.locate(x, cell));
        EXPECT_EQ(cell[axis], std::min(i, grid.points()[axis] - 2));
      }
    }
  }
}

// Spacings that are no powers of two: the line's own rounded position decides, on either side of it.
TEST(BoxGrid, NeighboursOfAGridLineFallOnTheirSideOfIt) {
  const BoxGrid grid({1000, 2, 2}, {0.1, 0.0, 0.0}, {0.1, 1.0, 1.0});
  for (int i = 1; i < 999; ++i) {
    const double line = grid.coordinate(0, i);
    Index3 cell;
    ASSERT_TRUE(grid.locate({line, 0.5, 0.5}, cell));
    EXPECT_EQ(cell.x, std::min(i, 998));
    ASSERT_TRUE(grid.locate({std::nextafter(line, -1.0), 0.5, 0.5}, cell));
    EXPECT_EQ(cell.x, i - 1);
  }
}

TEST(BoxGrid, OutsideAndNaNHaveNoCell) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const BoxGrid& grid : {uniform(), rectilinear()}) {
    const Box box = grid.bounds();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double outside : {nan, std::nextafter(box.lower[axis], -1e9),
                                   std::nextafter(box.upper[axis], 1e9), 1e308, -1e308}) {
        Vec3 x = box.center();
        x[axis] = outside;
        Index3 cell;
        EXPECT_FALSE(grid.locate(x, cell)) << axis << " " << outside;
      }
    }
  }
}

TEST(BoxGrid, OneBadCornerMakesTheCellsAroundItBad) {
  const BoxGrid grid = uniform();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int component = 0; component < 3; ++component) {
      Values<double> values(grid, trilinear);
      values.numbers[static_cast<std::size_t>(3 * (2 + 5 * (1 + 4 * 3)) + component)] = bad;  // (2, 1, 3)
      int cells = 0;
      for (int k = 0; k < 5; ++k) {
        for (int j = 0; j < 3; ++j) {
          for (int i = 0; i < 4; ++i) {
            BoxCell cell;
            grid.load({i, j, k}, values.view, cell);
            const bool around = (i == 1 || i == 2) && (j == 0 || j == 1) && (k == 2 || k == 3);
            EXPECT_EQ(cell.bad_data, around);
            cells += cell.bad_data ? 1 : 0;
          }
        }
      }
      EXPECT_EQ(cells, 8);
    }
  }
}

TEST(BoxGrid, TheScaleIsAppliedBeforeDifferencesCanOverflow) {
  const BoxGrid grid = uniform();
  Values<double> values(grid, trilinear);
  const double huge = std::ldexp(1.0, 1020);
  BoxCell plain;
  grid.load({1, 1, 1}, values.view, plain);
  for (double& v : values.numbers) v *= huge;
  values.view.scale = 1.0 / huge;
  BoxCell scaled;
  grid.load({1, 1, 1}, values.view, scaled);
  EXPECT_EQ(plain.c, scaled.c);
  EXPECT_FALSE(scaled.bad_data);
}

TEST(BoxGrid, LocateAndLoadAllocateNothing) {
  const BoxGrid grid = rectilinear();
  const Values<float> values(grid, trilinear);
  const test::AllocationGuard guard;
  Index3 index;
  BoxCell cell;
  ASSERT_TRUE(grid.locate(grid.bounds().center(), index));
  grid.load(index, values.view, cell);
  EXPECT_EQ(guard.count(), 0U);
}

TEST(BoxGrid, HiddenCellsAreBadDataWhateverTheirCornersHold) {
  BoxGrid grid(Index3(4, 3, 3), Vec3(0.0), Vec3(1.0));
  std::vector<std::uint8_t> hidden(12, 0);
  for (std::size_t cell = 1; cell < 12; cell += 3) hidden[cell] = 1;
  grid.hide_cells(hidden);
  const std::vector<double> numbers(std::size_t{3} * 36, 1.0);
  PointVectors values;
  values.values = std::span<const double>(numbers);
  BoxCell cell;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 3; ++i) {
        grid.load({i, j, k}, values, cell);
        EXPECT_EQ(cell.bad_data, i == 1);
        EXPECT_EQ(grid.hidden({i, j, k}), i == 1);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
