#include "common/field/vector_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "common/field/analytic/sampled.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/sample_meshes.h"

namespace palpate {
namespace {

const VectorChoice kVelocity{VectorChoice::Kind::kArray, Association::kPoint, {"velocity"}, "velocity"};

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }
Vec3 random_in(const Box& box, std::mt19937_64& random) {
  return box.lower + box.size() * Vec3{unit(random), unit(random), unit(random)};
}

/// v = A x + b, with entries that are exact in binary.
class Linear final : public AnalyticField {
 public:
  static Mat3 matrix() { return {Vec3{0.5, -1.0, 2.0}, Vec3{0.25, 0.75, -0.5}, Vec3{-1.5, 1.0, 0.125}}; }
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    return matrix() * x + Vec3{1.0, -0.5, 2.0};
  }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override { return matrix(); }
  [[nodiscard]] Box bounds() const noexcept override { return {{-1.0, 0.0, 1.0}, {1.0, 2.0, 2.0}}; }
  [[nodiscard]] std::string name() const override { return "linear"; }
  [[nodiscard]] std::string description() const override { return "linear"; }
};

Vec3 linear(const Vec3& x) { return Linear().velocity(x); }

/// The field `formula` on each kind of grid, double values.
std::vector<DataSet> on_all_grids(const AnalyticField& formula, int n) {
  const Index3 points{n, n + 1, n - 1};
  return {sample_uniform(formula, points, SampledType::kFloat64),
          sample_rectilinear(formula, points, 4.0, SampledType::kFloat64),
          sample_curvilinear(formula, points, 0.25, SampledType::kFloat64),
          sample_tetrahedra(formula, points, 0.2, 1, SampledType::kFloat64)};
}

std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  return make_vector_field({block}, kVelocity, "test");
}

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

TEST(VectorField, LinearFieldsAreExactOnEveryGrid) {
  std::mt19937_64 random(1);
  const Linear formula;
  for (const DataSet& block : on_all_grids(formula, 7)) {
    const auto field = field_of(block);
    CellHint hint;
    for (int i = 0; i < 500; ++i) {
      const Vec3 x = random_in(formula.bounds(), random);
      const VectorSample sample = field->sample(x, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
      EXPECT_LT(glm::distance(sample.value, formula.velocity(x)), 1e-13);
      Mat3 m;
      ASSERT_EQ(field->jacobian(x, hint, m), SampleStatus::kOk);
      for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(m[c], Linear::matrix()[c]), 1e-11);
    }
  }
}

// log2 of the ratio of errors when the cells are halved twice.
TEST(VectorField, InterpolantsConvergeWithOrderTwoAndDerivativesWithOrderOne) {
  const auto formula = example("abc");
  std::array<std::vector<double>, 4> value_errors;
  std::array<std::vector<double>, 4> jacobian_errors;
  for (const int n : {9, 17, 33}) {
    const auto blocks = on_all_grids(*formula, n);
    for (std::size_t g = 0; g < blocks.size(); ++g) {
      const auto field = field_of(blocks[g]);
      std::mt19937_64 random(5);
      CellHint hint;
      double value_error = 0.0;
      double jacobian_error = 0.0;
      constexpr int kSamples = 2000;
      for (int i = 0; i < kSamples; ++i) {
        const Vec3 x = random_in(formula->bounds(), random);
        const Vec3 dv = field->sample(x, hint).value - formula->velocity(x);
        value_error += glm::dot(dv, dv);
        Mat3 m;
        ASSERT_EQ(field->jacobian(x, hint, m), SampleStatus::kOk);
        const Mat3 dm = m - formula->jacobian(x);
        for (int c = 0; c < 3; ++c) jacobian_error += glm::dot(dm[c], dm[c]);
      }
      value_errors[g].push_back(std::sqrt(value_error / kSamples));
      jacobian_errors[g].push_back(std::sqrt(jacobian_error / kSamples));
    }
  }
  for (std::size_t g = 0; g < 4; ++g) {
    // The cell counts n - 1, n and n - 2 are not exactly doubled, and grids differ a little in shape.
    EXPECT_NEAR(std::log2(value_errors[g][1] / value_errors[g][2]), 2.0, 0.2) << g;
    EXPECT_NEAR(std::log2(jacobian_errors[g][1] / jacobian_errors[g][2]), 1.0, 0.2) << g;
  }
}

TEST(VectorField, PowersOfTwoGiveTheSameBits) {
  const auto formula = example("tornado");
  for (const SampledType type : {SampledType::kFloat32, SampledType::kFloat64}) {
    const std::vector<DataSet> blocks{sample_uniform(*formula, {9, 8, 10}, type),
                                      sample_rectilinear(*formula, {9, 8, 10}, 3.0, type),
                                      sample_curvilinear(*formula, {9, 8, 10}, 0.25, type),
                                      sample_tetrahedra(*formula, {9, 8, 10}, 0.2, 1, type)};
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

TEST(VectorField, RotatedImagesGiveTheRotatedField) {
  const auto formula = example("cavity");
  const DataSet block = sample_uniform(*formula, {8, 9, 7}, SampledType::kFloat64);
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
TEST(VectorField, FlippedAndPermutedAxesGiveTheSameFieldToRounding) {
  const auto formula = example("tornado");
  const DataSet block = sample_uniform(*formula, {5, 6, 7});
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

TEST(VectorField, ShearedAxesAreSplitIntoTetrahedra) {
  const Linear formula;
  DataSet block = sample_uniform(formula, {6, 6, 6}, SampledType::kFloat64);
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
  ASSERT_NE(field->tet_mesh(), nullptr);
  CellHint hint;
  const Vec3 x = grid.origin + grid.axes * Vec3{2.3, 4.1, 1.7};
  EXPECT_LT(glm::distance(field->sample(x, hint).value, formula.velocity(x)), 1e-13);
}

TEST(VectorField, MixedCellsInAnyNumberingGiveTheLinearField) {
  std::mt19937_64 random(4);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double jitter : {0.0, 0.15}) {
      const auto field = field_of(test::mixed_cells(4, jitter, seed, linear));
      CellHint hint;
      for (int i = 0; i < 500; ++i) {
        const Vec3 x{unit(random), unit(random), unit(random)};
        const VectorSample sample = field->sample(x, hint);
        ASSERT_EQ(sample.status, SampleStatus::kOk);
        EXPECT_LT(glm::distance(sample.value, linear(x)), 1e-12);
      }
    }
  }
}

TEST(VectorField, JoinedBlocksGiveTheLinearFieldAcrossTheirBorders) {
  std::mt19937_64 random(4);
  const auto blocks = test::turned_blocks(3, 0.0, 3, linear);
  const auto field = make_vector_field(blocks, kVelocity, "test");
  CellHint hint;
  for (int i = 0; i < 1000; ++i) {
    Vec3 x{unit(random), unit(random), unit(random)};
    if (i % 4 == 0) x[i % 3] = 0.5;
    const VectorSample sample = field->sample(x, hint);
    ASSERT_EQ(sample.status, SampleStatus::kOk);
    EXPECT_LT(glm::distance(sample.value, linear(x)), 1e-12);
  }
}

TEST(VectorField, ValuesAreSharedWhereTheDataAllows) {
  const auto formula = example("hill");
  for (const DataSet& block : {sample_uniform(*formula, {6, 6, 6}), sample_curvilinear(*formula, {6, 6, 6}),
                               sample_tetrahedra(*formula, {6, 6, 6})}) {
    const auto field = field_of(block);
    const auto values = std::get<std::span<const float>>(field->values().values);
    EXPECT_EQ(static_cast<const void*>(values.data()),
              static_cast<const void*>(block.arrays[0].bytes.data()));
    EXPECT_EQ(field->values().owner, block.arrays[0].owner);
  }
}

TEST(VectorField, LocalUnitsAreNearOne) {
  const auto formula = example("abc");
  for (const int exponent : {-100, -3, 0, 7, 100}) {
    const auto field = field_of(scaled(sample_curvilinear(*formula, {6, 6, 6}), exponent, -exponent));
    const double diagonal = field->diagonal() / field->frame().length_scale();
    EXPECT_GE(diagonal, 1.0);
    EXPECT_LT(diagonal, 2.0);
    const double speed = field->max_speed() / field->frame().speed_scale();
    EXPECT_GE(speed, 1.0);
    EXPECT_LT(speed, 2.0);
  }
}

TEST(VectorField, NaNHolesAreBadDataAndCounted) {
  const auto formula = example("abc");
  for (DataSet block : {sample_uniform(*formula, {9, 9, 9}), sample_curvilinear(*formula, {9, 9, 9}, 0.0)}) {
    std::vector<float> numbers;
    for (std::size_t i = 0; i < block.arrays[0].tuples; ++i) {
      for (int c = 0; c < 3; ++c) numbers.push_back(static_cast<float>(block.arrays[0].at(i, c)));
    }
    const std::size_t middle = 4 + 9 * (4 + 9 * 4);
    numbers[3 * middle + 1] = std::numeric_limits<float>::quiet_NaN();
    numbers[3 * middle + 5] = std::numeric_limits<float>::infinity();
    block.arrays[0] = make_array("velocity", Association::kPoint, 3, std::span<const float>(numbers));
    const auto field = field_of(block);
    EXPECT_EQ(field->notes().bad_values, 2U);
    EXPECT_TRUE(std::isfinite(field->max_speed()));
    CellHint hint;
    const Vec3 h = formula->bounds().size() / 8.0;
    EXPECT_EQ(field->sample(h * Vec3{4.1, 4.05, 4.02}, hint).status, SampleStatus::kBadData);
    EXPECT_EQ(field->sample(h * Vec3{1.1, 4.05, 4.02}, hint).status, SampleStatus::kOk);
    Mat3 m;
    EXPECT_EQ(field->jacobian(h * Vec3{4.1, 4.05, 4.02}, hint, m), SampleStatus::kBadData);
  }
}

TEST(VectorField, BlankedPointsAreBadDataOnBoxesAndHolesInTetrahedra) {
  const auto formula = example("abc");
  const Vec3 h = formula->bounds().size() / 8.0;
  for (const bool box : {true, false}) {
    DataSet block = box ? sample_uniform(*formula, {9, 9, 9}) : sample_curvilinear(*formula, {9, 9, 9}, 0.0);
    block.visible.assign(729, 1);
    block.visible[4 + 9 * (4 + 9 * 4)] = 0;
    const auto field = field_of(block);
    CellHint hint;
    EXPECT_EQ(field->sample(h * Vec3{4.3, 4.2, 4.1}, hint).status,
              box ? SampleStatus::kBadData : SampleStatus::kOutside);
    EXPECT_EQ(field->sample(h * Vec3{2.9, 4.2, 4.1}, hint).status, SampleStatus::kOk);
  }
}

TEST(VectorField, SamplesOutsideAreZeroAndSaySo) {
  for (const DataSet& block : on_all_grids(Linear(), 5)) {
    const auto field = field_of(block);
    CellHint hint;
    const VectorSample sample = field->sample({5.0, 5.0, 5.0}, hint);
    EXPECT_EQ(sample.status, SampleStatus::kOutside);
    EXPECT_EQ(sample.value, Vec3{0.0});
  }
}

TEST(VectorField, ComponentsMakeTheSameFieldAsTheArray) {
  const DataSet block = sample_curvilinear(*example("hill"), {6, 7, 8});
  DataSet parts = block;
  parts.arrays.clear();
  for (int c = 0; c < 3; ++c) {
    std::vector<float> numbers;
    for (std::size_t i = 0; i < block.arrays[0].tuples; ++i) {
      numbers.push_back(static_cast<float>(block.arrays[0].at(i, c)));
    }
    parts.arrays.push_back(
        make_array(std::string("V") + "XYZ"[c], Association::kPoint, 1, std::span<const float>(numbers)));
  }
  const VectorChoice choice{VectorChoice::Kind::kComponents, Association::kPoint, {"VX", "VY", "VZ"}, "V"};
  const auto a = field_of(block);
  const auto b = make_vector_field({parts}, choice, "test");
  const auto& first = std::get<std::span<const float>>(a->values().values);
  const auto& second = std::get<std::span<const float>>(b->values().values);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end()));
}

TEST(VectorField, MomentumIsDividedByDensity) {
  DataSet block = sample_uniform(Linear(), {4, 4, 4}, SampledType::kFloat64);
  std::vector<double> density;
  std::vector<double> momentum;
  for (std::size_t i = 0; i < 64; ++i) {
    density.push_back(static_cast<double>(i % 4) * 0.5);  // zero at every fourth point
    for (int c = 0; c < 3; ++c) momentum.push_back(density.back() * block.arrays[0].at(i, c));
  }
  block.arrays = {make_array("Momentum", Association::kPoint, 3, std::span<const double>(momentum)),
                  make_array("Density", Association::kPoint, 1, std::span<const double>(density))};
  const VectorChoice choice{VectorChoice::Kind::kMomentumOverDensity,
                            Association::kPoint,
                            {"Momentum", "Density"},
                            "Momentum / Density"};
  const auto field = make_vector_field({block}, choice, "test");
  EXPECT_EQ(field->notes().bad_values, 16U);
  CellHint hint;
  const Vec3 x{0.5, 1.0, 1.5};  // between the points 2 and 3 along x
  EXPECT_LT(glm::distance(field->sample(x, hint).value, linear(x)), 1e-12);
  EXPECT_EQ(field->sample({-0.9, 1.0, 1.5}, hint).status, SampleStatus::kBadData);
}

/// Cell values of a field at the cells' centres.
DataSet with_cell_values(DataSet block, const std::vector<Vec3>& centres) {
  std::vector<double> numbers;
  for (const Vec3& x : centres) {
    const Vec3 v = linear(x);
    numbers.insert(numbers.end(), {v.x, v.y, v.z});
  }
  block.arrays = {make_array("velocity", Association::kCell, 3, std::span<const double>(numbers))};
  return block;
}

// At an inner point of an even grid the mean over the eight cells is the linear field's value; of two unequal
// intervals the wider weighs more.
TEST(VectorField, CellValuesComeToPointsByVolume) {
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kCell, {"velocity"}, "velocity"};
  DataSet block = sample_uniform(Linear(), {5, 5, 5});
  const auto& grid = std::get<UniformTopology>(block.topology);
  std::vector<Vec3> centres;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) centres.push_back(grid.origin + grid.axes * (Vec3(i, j, k) + 0.5));
    }
  }
  CellHint hint;
  for (const bool box : {true, false}) {
    DataSet set = with_cell_values(block, centres);
    if (!box) {
      std::vector<double> positions;
      for (int k = 0; k < 5; ++k) {
        for (int j = 0; j < 5; ++j) {
          for (int i = 0; i < 5; ++i) {
            const Vec3 x = grid.origin + grid.axes * Vec3(i, j, k);
            positions.insert(positions.end(), {x.x, x.y, x.z});
          }
        }
      }
      set.topology = StructuredTopology{
          {5, 5, 5}, make_array("points", Association::kPoint, 3, std::span<const double>(positions))};
    }
    const auto field = make_vector_field({set}, choice, "test");
    const Vec3 inner = grid.origin + grid.axes * Vec3{2.0, 1.0, 3.0};
    EXPECT_LT(glm::distance(field->sample(inner, hint).value, linear(inner)), 1e-12) << box;
    const bool noted = std::ranges::any_of(field->notes().lines, [](const std::string& line) {
      return line.find("cell values") != std::string::npos;
    });
    EXPECT_TRUE(noted);
  }

  DataSet uneven;
  uneven.topology = RectilinearTopology{{std::vector<double>{0.0, 1.0, 4.0}, {0.0, 1.0}, {0.0, 1.0}}};
  const std::vector<double> values{8.0, 0.0, 0.0, 4.0, 0.0, 0.0};
  uneven.arrays = {make_array("velocity", Association::kCell, 3, std::span<const double>(values))};
  const auto field = make_vector_field({uneven}, choice, "test");
  EXPECT_DOUBLE_EQ(field->sample({1.0, 0.5, 0.5}, hint).value.x, (1.0 * 8.0 + 3.0 * 4.0) / 4.0);
}

TEST(VectorField, ADescendingAxisIsTheSameGrid) {
  const DataSet block = sample_rectilinear(Linear(), {4, 5, 6}, 3.0, SampledType::kFloat64);
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

std::string refusal(const std::vector<DataSet>& blocks, const VectorChoice& choice = kVelocity) {
  try {
    (void)make_vector_field(blocks, choice, "data.vtk");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_EQ(std::string(error.what()).find("data.vtk"), 0U) << error.what();
    return error.what();
  }
  return {};
}

TEST(VectorField, BadDataSetsAreRefusedInOneLine) {
  const DataSet good = sample_uniform(Linear(), {4, 4, 4});
  DataSet flat = good;
  std::get<UniformTopology>(flat.topology).points = {16, 4, 1};
  EXPECT_NE(refusal({flat}).find("flat grid of 16 x 4 x 1"), std::string::npos);

  DataSet missing = good;
  missing.arrays[0].name = "other";
  EXPECT_NE(refusal({missing}).find("no point array 'velocity'"), std::string::npos);

  DataSet shorter = good;
  shorter.arrays[0].tuples = 63;
  EXPECT_FALSE(refusal({shorter}).empty());

  DataSet wide = good;
  wide.arrays[0].components = 4;
  wide.arrays[0].tuples = 48;
  EXPECT_FALSE(refusal({wide}).empty());

  DataSet huge = good;
  std::get<UniformTopology>(huge.topology).points = {1 << 30, 1 << 30, 1 << 30};
  EXPECT_FALSE(refusal({huge}).empty());

  DataSet still = good;
  std::get<UniformTopology>(still.topology).axes[1] = Vec3{0.0};
  EXPECT_FALSE(refusal({still}).empty());

  DataSet nowhere = good;
  std::get<UniformTopology>(nowhere.topology).origin.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(refusal({nowhere}).empty());

  DataSet coarse = good;  // lines of the grid that double precision cannot tell apart
  std::get<UniformTopology>(coarse.topology).origin.x = 1e17;
  EXPECT_FALSE(refusal({coarse}).empty());

  DataSet uneven = sample_rectilinear(Linear(), {4, 4, 4});
  std::get<RectilinearTopology>(uneven.topology).coordinates[2][1] = 9.0;
  EXPECT_FALSE(refusal({uneven}).empty());

  EXPECT_FALSE(refusal({}).empty());
  EXPECT_TRUE(refusal({good}).empty());
}

TEST(VectorField, BlocksWithoutTheArrayAreLeftOutAndNoted) {
  const DataSet good = sample_uniform(Linear(), {4, 4, 4});
  DataSet other = good;
  other.name = "wall";
  other.arrays.clear();
  const auto field = make_vector_field({other, good}, kVelocity, "test");
  EXPECT_NE(field->box_grid(), nullptr);
  EXPECT_EQ(field->blocks(), std::vector<std::size_t>{1});
  ASSERT_FALSE(field->notes().lines.empty());
  EXPECT_NE(field->notes().lines.front().find("'wall' left out"), std::string::npos);
}

TEST(VectorField, SamplingAllocatesNothing) {
  const auto blocks = on_all_grids(Linear(), 6);
  for (const DataSet& block : blocks) {
    const auto field = field_of(block);
    const test::AllocationGuard guard;
    CellHint hint;
    Mat3 m;
    for (int i = 0; i < 100; ++i) {
      const Vec3 x{0.01 * i, 1.0, 1.5};
      (void)field->sample(x, hint);
      (void)field->jacobian(x, hint, m);
    }
    EXPECT_EQ(guard.count(), 0U);
  }
}

TEST(VectorField, FormulasAreScaledByPowersOfTwo) {
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
