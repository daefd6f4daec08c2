// The same field in other units, turned, flipped, permuted or sheared.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vorticity_field.h"
#include "tests/common/field/sampled_fields.h"

namespace palpate {
namespace {

using test::field_of;
using test::Linear;
using test::random_in;
using test::unit;

/// Every position of a data set multiplied by 2^length, every value by 2^speed.
DataSet scaled(const DataSet& block, int length, int speed) {
  DataSet out = block;
  const auto scale = [](const DataArray& array, int exponent) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < array.tuples; ++i) {
      for (int c = 0; c < array.components; ++c) numbers.push_back(std::ldexp(array.at(i, c), exponent));
    }
    if (array.type == ScalarType::kFloat64) {
      return make_array(array.name, array.association, array.components, std::span<const double>(numbers));
    }
    const std::vector<float> floats(numbers.begin(), numbers.end());
    return make_array(array.name, array.association, array.components, std::span<const float>(floats));
  };
  for (DataArray& array : out.arrays) array = scale(array, speed);
  const double factor = std::ldexp(1.0, length);
  if (auto* grid = std::get_if<UniformTopology>(&out.topology)) {
    grid->origin *= factor;
    grid->axes *= factor;
  } else if (auto* lines = std::get_if<RectilinearTopology>(&out.topology)) {
    for (auto& axis : lines->coordinates) {
      for (double& x : axis) x *= factor;
    }
  } else if (auto* structured = std::get_if<StructuredTopology>(&out.topology)) {
    structured->positions = scale(structured->positions, length);
  } else if (auto* cells = std::get_if<UnstructuredTopology>(&out.topology)) {
    cells->positions = scale(cells->positions, length);
  }
  return out;
}

TEST(VectorFieldSymmetry, PowersOfTwoGiveTheSameBits) {
  const auto formula = example("tornado");
  for (const test::SampledType type : {test::SampledType::kFloat32, test::SampledType::kFloat64}) {
    const std::vector<DataSet> blocks{test::sample_uniform(*formula, {9, 8, 10}, type),
                                      test::sample_rectilinear(*formula, {9, 8, 10}, 3.0, type),
                                      test::sample_curvilinear(*formula, {9, 8, 10}, 0.25, type),
                                      test::sample_tetrahedra(*formula, {9, 8, 10}, 0.2, 1, type)};
    for (const DataSet& block : blocks) {
      const auto field = field_of(block);
      for (const auto& [length, speed] : {std::array{60, 0}, {0, 60}, {60, 60}, {-60, 60}, {60, -60}}) {
        const auto other = field_of(scaled(block, length, speed));
        EXPECT_EQ(other->frame().length_exponent, field->frame().length_exponent + length);
        EXPECT_EQ(other->frame().speed_exponent, field->frame().speed_exponent + speed);
        EXPECT_EQ(other->max_speed(), std::ldexp(field->max_speed(), speed));
        EXPECT_EQ(other->diagonal(), std::ldexp(field->diagonal(), length));
        std::mt19937_64 random(2);
        CellHint hint;
        CellHint other_hint;
        for (int i = 0; i < 200; ++i) {
          const Vec3 x = random_in(formula->bounds(), random);
          const VectorSample a = field->sample(x, hint);
          const VectorSample b = other->sample(x * std::ldexp(1.0, length), other_hint);
          ASSERT_EQ(a.status, b.status);
          EXPECT_EQ(a.value * std::ldexp(1.0, speed), b.value);
          Mat3 m;
          Mat3 n;
          (void)field->jacobian(x, hint, m);
          (void)other->jacobian(x * std::ldexp(1.0, length), other_hint, n);
          EXPECT_EQ(m * std::ldexp(1.0, speed - length), n);
        }
      }
    }
  }
}

/// The block's values turned, and a uniform grid turned with them.
DataSet turned(const DataSet& block, const Mat3& rotation) {
  DataSet out = block;
  auto& grid = std::get<UniformTopology>(out.topology);
  grid.origin = rotation * grid.origin;
  grid.axes = rotation * grid.axes;
  std::vector<double> numbers;
  for (std::size_t i = 0; i < out.arrays[0].tuples; ++i) {
    const Vec3 v = rotation * Vec3{out.arrays[0].at(i, 0), out.arrays[0].at(i, 1), out.arrays[0].at(i, 2)};
    numbers.insert(numbers.end(), {v.x, v.y, v.z});
  }
  out.arrays[0] = make_array("velocity", Association::kPoint, 3, std::span<const double>(numbers));
  return out;
}

Mat3 rotation_about(const Vec3& axis, double angle) {
  const Vec3 n = glm::normalize(axis);
  const Mat3 cross{Vec3{0.0, n.z, -n.y}, Vec3{-n.z, 0.0, n.x}, Vec3{n.y, -n.x, 0.0}};
  return Mat3{1.0} + std::sin(angle) * cross + (1.0 - std::cos(angle)) * cross * cross;
}

TEST(VectorFieldSymmetry, RotatedImagesGiveTheRotatedField) {
  const auto formula = example("cavity");
  const DataSet block = test::sample_uniform(*formula, {8, 9, 7}, test::SampledType::kFloat64);
  const auto field = field_of(block);
  const Mat3 rotation = rotation_about({1.0, 2.0, -0.5}, 0.7);
  const auto other = field_of(turned(block, rotation));
  ASSERT_NE(other->box_grid(), nullptr);
  EXPECT_TRUE(other->frame().rotated);
  std::mt19937_64 random(2);
  CellHint hint;
  for (int i = 0; i < 500; ++i) {
    const Vec3 x = formula->bounds().lower + (0.001 + 0.998 * Vec3{unit(random), unit(random), unit(random)});
    const VectorSample a = field->sample(x, hint);
    const VectorSample b = other->sample(rotation * x, hint);
    ASSERT_EQ(b.status, SampleStatus::kOk);
    EXPECT_LT(glm::distance(rotation * a.value, b.value), 1e-13);
    Mat3 m;
    Mat3 n;
    (void)field->jacobian(x, hint, m);
    (void)other->jacobian(rotation * x, hint, n);
    const Mat3 expected = rotation * m * glm::transpose(rotation);
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(expected[c], n[c]), 1e-11);
  }
}

/// The same field on a uniform grid whose axes are flipped and permuted in every way.
TEST(VectorFieldSymmetry, FlippedAndPermutedAxesGiveTheSameFieldToRounding) {
  const auto formula = example("tornado");
  const DataSet block = test::sample_uniform(*formula, {5, 6, 7});
  const auto& grid = std::get<UniformTopology>(block.topology);
  const auto field = field_of(block);
  std::array<int, 3> order{0, 1, 2};
  do {
    for (unsigned flips = 0; flips < 8; ++flips) {
      DataSet other;
      UniformTopology topology;
      topology.origin = grid.origin;
      for (int a = 0; a < 3; ++a) {
        const int from = order[static_cast<std::size_t>(a)];
        topology.points[a] = grid.points[from];
        topology.axes[a] = grid.axes[from];
        if (((flips >> static_cast<unsigned>(a)) & 1U) != 0) {
          topology.origin += grid.axes[from] * static_cast<double>(grid.points[from] - 1);
          topology.axes[a] = -grid.axes[from];
        }
      }
      std::vector<float> numbers;
      for (int k = 0; k < topology.points.z; ++k) {
        for (int j = 0; j < topology.points.y; ++j) {
          for (int i = 0; i < topology.points.x; ++i) {
            const Index3 at{i, j, k};
            Index3 old{0};
            for (int a = 0; a < 3; ++a) {
              const int from = order[static_cast<std::size_t>(a)];
              const bool flip = ((flips >> static_cast<unsigned>(a)) & 1U) != 0;
              old[from] = flip ? topology.points[a] - 1 - at[a] : at[a];
            }
            const auto p = static_cast<std::size_t>(old.x + grid.points.x * (old.y + grid.points.y * old.z));
            for (int c = 0; c < 3; ++c) numbers.push_back(static_cast<float>(block.arrays[0].at(p, c)));
          }
        }
      }
      other.topology = topology;
      other.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const float>(numbers)));
      const auto same = field_of(other);
      ASSERT_NE(same->box_grid(), nullptr);
      std::mt19937_64 random(3);
      CellHint hint;
      for (int i = 0; i < 50; ++i) {
        const Vec3 x = random_in({{-0.49, -0.49, 0.01}, {0.49, 0.49, 0.99}}, random);
        const VectorSample a = field->sample(x, hint);
        const VectorSample b = same->sample(x, hint);
        ASSERT_EQ(b.status, SampleStatus::kOk);
        // Sums over corners are taken in another order.
        EXPECT_LT(glm::distance(a.value, b.value), 1e-13) << flips;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(VectorFieldSymmetry, ShearedAxesAreALattice) {
  const Linear formula;
  DataSet block = test::sample_uniform(formula, {6, 6, 6}, test::SampledType::kFloat64);
  auto& grid = std::get<UniformTopology>(block.topology);
  grid.axes[1].x = 0.3 * grid.axes[0].x;
  std::vector<double> numbers;
  for (int k = 0; k < 6; ++k) {
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 6; ++i) {
        const Vec3 v = formula.velocity(grid.origin + grid.axes * Vec3(i, j, k));
        numbers.insert(numbers.end(), {v.x, v.y, v.z});
      }
    }
  }
  block.arrays[0] = make_array("velocity", Association::kPoint, 3, std::span<const double>(numbers));
  const auto field = field_of(block);
  ASSERT_NE(field->box_grid(), nullptr);
  EXPECT_TRUE(field->box_grid()->sheared());
  CellHint hint;
  const Vec3 x = grid.origin + grid.axes * Vec3{2.3, 4.1, 1.7};
  EXPECT_LT(glm::distance(field->sample(x, hint).value, formula.velocity(x)), 1e-13);
  Mat3 jacobian;
  ASSERT_EQ(field->jacobian(x, hint, jacobian), SampleStatus::kOk);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_LT(glm::distance(jacobian[axis], formula.jacobian(x)[axis]), 1e-12);
  const VorticityField vorticity(field);
  const Mat3 j = formula.jacobian(x);
  const Vec3 curl{j[1][2] - j[2][1], j[2][0] - j[0][2], j[0][1] - j[1][0]};
  EXPECT_LT(glm::distance(vorticity.sample(x, hint).value, curl), 1e-12);
}

TEST(VectorFieldSymmetry, LocalUnitsAreNearOne) {
  const auto formula = example("abc");
  for (const int exponent : {-100, -3, 0, 7, 100}) {
    const auto field = field_of(scaled(test::sample_curvilinear(*formula, {6, 6, 6}), exponent, -exponent));
    const double diagonal = field->diagonal() / field->frame().length_scale();
    EXPECT_GE(diagonal, 1.0);
    EXPECT_LT(diagonal, 2.0);
    const double speed = field->max_speed() / field->frame().speed_scale();
    EXPECT_GE(speed, 1.0);
    EXPECT_LT(speed, 2.0);
  }
}

TEST(VectorFieldSymmetry, ADescendingAxisIsTheSameGrid) {
  const DataSet block = test::sample_rectilinear(Linear(), {4, 5, 6}, 3.0, test::SampledType::kFloat64);
  DataSet other = block;
  auto& lines = std::get<RectilinearTopology>(other.topology).coordinates;
  std::ranges::reverse(lines[1]);
  std::vector<double> numbers;
  for (int k = 0; k < 6; ++k) {
    for (int j = 4; j >= 0; --j) {
      for (int i = 0; i < 4; ++i) {
        for (int c = 0; c < 3; ++c) {
          numbers.push_back(block.arrays[0].at(static_cast<std::size_t>(i + 4 * (j + 5 * k)), c));
        }
      }
    }
  }
  other.arrays[0] = make_array("velocity", Association::kPoint, 3, std::span<const double>(numbers));
  const auto a = field_of(block);
  const auto b = field_of(other);
  std::mt19937_64 random(1);
  CellHint hint;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = random_in(Linear().bounds(), random);
    EXPECT_EQ(a->sample(x, hint).value, b->sample(x, hint).value);
  }
}

TEST(VectorFieldSymmetry, FormulasAreScaledByPowersOfTwo) {
  const auto formula = example("abc");
  const auto plain = make_vector_field(formula);
  const auto large = make_vector_field(formula, 60, -30);
  CellHint hint;
  const Vec3 x{1.0, 2.0, 3.0};
  EXPECT_EQ(plain->sample(x, hint).value, formula->velocity(x));
  EXPECT_EQ(large->sample(x * 0x1p60, hint).value, formula->velocity(x) * 0x1p-30);
  EXPECT_EQ(large->diagonal(), plain->diagonal() * 0x1p60);
  EXPECT_EQ(large->sample(x * 0x1p64, hint).status, SampleStatus::kOutside);
}

}  // namespace
}  // namespace palpate
