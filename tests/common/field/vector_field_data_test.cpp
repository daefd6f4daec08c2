// What the arrays of a data set become: shared, combined or refused; holes in them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/grid/box_grid.h"
#include "tests/common/field/sampled_fields.h"

namespace palpate {
namespace {

using test::field_of;
using test::kVelocity;
using test::Linear;
using test::linear;

TEST(VectorFieldData, ValuesAreSharedWhereTheDataAllows) {
  const auto formula = example("hill");
  for (const DataSet& block :
       {test::sample_uniform(*formula, {6, 6, 6}), test::sample_curvilinear(*formula, {6, 6, 6}),
        test::sample_tetrahedra(*formula, {6, 6, 6})}) {
    const auto field = field_of(block);
    const auto values = std::get<std::span<const float>>(field->values().values);
    EXPECT_EQ(static_cast<const void*>(values.data()),
              static_cast<const void*>(block.arrays[0].bytes.data()));
    EXPECT_EQ(field->values().owner, block.arrays[0].owner);
  }
}

TEST(VectorFieldData, NaNHolesAreBadDataAndCounted) {
  const auto formula = example("abc");
  for (DataSet block :
       {test::sample_uniform(*formula, {9, 9, 9}), test::sample_curvilinear(*formula, {9, 9, 9}, 0.0)}) {
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

TEST(VectorFieldData, DenormalSpeedsAreNoZeros) {
  constexpr double kSpeed = 0x1p-1063;
  for (DataSet block : {test::sample_uniform(*example("abc"), {3, 3, 3}),
                        test::sample_tetrahedra(*example("abc"), {3, 3, 3})}) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < block.arrays[0].tuples; ++i)
      numbers.insert(numbers.end(), {kSpeed, 0.0, -2.0 * kSpeed});
    block.arrays[0] = make_array("velocity", Association::kPoint, 3, std::span<const double>(numbers));
    const auto field = field_of(block);
    EXPECT_GT(field->max_speed(), 2.0 * kSpeed);
    CellHint hint;
    const VectorSample sample = field->sample(0.4 * example("abc")->bounds().size(), hint);
    ASSERT_EQ(sample.status, SampleStatus::kOk);
    EXPECT_EQ(sample.value, Vec3(kSpeed, 0.0, -2.0 * kSpeed));
  }
}

TEST(VectorFieldData, WithoutANumberSayThat) {
  DataSet block = test::sample_uniform(*example("abc"), {3, 3, 3});
  const std::vector<double> numbers(3 * block.arrays[0].tuples, std::nan(""));
  block.arrays[0] = make_array("velocity", Association::kPoint, 3, std::span<const double>(numbers));
  const std::vector<std::string> notes = field_of(block)->notes().lines;
  EXPECT_NE(std::ranges::find(notes, "no value of the field is a number"), notes.end());
  EXPECT_EQ(std::ranges::find(notes, "the field is zero everywhere"), notes.end());
}

TEST(VectorFieldData, BlankedPointsAreBadDataOnBoxesAndHolesInTetrahedra) {
  const auto formula = example("abc");
  const Vec3 h = formula->bounds().size() / 8.0;
  for (const bool box : {true, false}) {
    DataSet block =
        box ? test::sample_uniform(*formula, {9, 9, 9}) : test::sample_curvilinear(*formula, {9, 9, 9}, 0.0);
    block.visible.assign(729, 1);
    block.visible[4 + 9 * (4 + 9 * 4)] = 0;
    const auto field = field_of(block);
    CellHint hint;
    EXPECT_EQ(field->sample(h * Vec3{4.3, 4.2, 4.1}, hint).status,
              box ? SampleStatus::kBadData : SampleStatus::kOutside);
    EXPECT_EQ(field->sample(h * Vec3{2.9, 4.2, 4.1}, hint).status, SampleStatus::kOk);
  }
}

TEST(VectorFieldData, ComponentsMakeTheSameFieldAsTheArray) {
  const DataSet block = test::sample_curvilinear(*example("hill"), {6, 7, 8});
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

TEST(VectorFieldData, MomentumIsDividedByDensity) {
  DataSet block = test::sample_uniform(Linear(), {4, 4, 4}, test::SampledType::kFloat64);
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

// At an inner point of an even grid the mean over the eight cells is the linear field's value; between two unequal
// intervals it is the value of the line through their middles.
TEST(VectorFieldData, CellValuesComeToPointsAlongLines) {
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kCell, {"velocity"}, "velocity"};
  DataSet block = test::sample_uniform(Linear(), {5, 5, 5});
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
  EXPECT_NEAR(field->sample({1.0, 0.5, 0.5}, hint).value.x, 8.0 - 4.0 * (1.0 - 0.5) / (2.5 - 0.5), 1e-12);
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

TEST(VectorFieldData, BadDataSetsAreRefusedInOneLine) {
  const DataSet good = test::sample_uniform(Linear(), {4, 4, 4});
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

  DataSet uneven = test::sample_rectilinear(Linear(), {4, 4, 4});
  std::get<RectilinearTopology>(uneven.topology).coordinates[2][1] = 9.0;
  EXPECT_FALSE(refusal({uneven}).empty());

  EXPECT_FALSE(refusal({}).empty());
  EXPECT_TRUE(refusal({good}).empty());
}

TEST(VectorFieldData, BlocksWithoutTheArrayAreLeftOutAndNoted) {
  const DataSet good = test::sample_uniform(Linear(), {4, 4, 4});
  DataSet other = good;
  other.name = "wall";
  other.arrays.clear();
  const auto field = make_vector_field({other, good}, kVelocity, "test");
  EXPECT_NE(field->box_grid(), nullptr);
  EXPECT_EQ(field->blocks(), std::vector<std::size_t>{1});
  ASSERT_FALSE(field->notes().lines.empty());
  EXPECT_NE(field->notes().lines.front().find("'wall' left out"), std::string::npos);
}

}  // namespace
}  // namespace palpate
