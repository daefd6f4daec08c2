// Values of cells as they are: constant over each, whatever the grid.
#include "common/field/cells/constant_cells.h"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"
#include "tests/support/sample_meshes.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

const VectorChoice kOfCells{VectorChoice::Kind::kArray, Association::kCell, {"v"}, "v"};

Vec3 value_of(std::size_t cell) {
  return {1.0 + static_cast<double>(cell), 0.5, -static_cast<double>(cell % 3)};
}

void give_values(DataSet& block) {
  std::vector<double> values;
  for (std::size_t c = 0; c < block.cell_count(); ++c) {
    for (int i = 0; i < 3; ++i) values.push_back(value_of(c)[i]);
  }
  block.arrays = {make_array("v", Association::kCell, 3, std::span<const double>(values))};
}

std::shared_ptr<const VectorField> constant_field(const DataSet& block) {
  const ConstantCells constant = constant_cells({block}, kOfCells);
  return make_vector_field(constant.blocks, constant.choice, "test");
}

TEST(ConstantCells, OfLatticesHaveTheValuesOfTheirCells) {
  const std::array<std::vector<double>, 3> lines{
      std::vector<double>{0.0, 1.0, 3.0}, {0.0, 0.5, 2.0, 2.25}, {-1.0, 1.0}};
  DataSet rectilinear, uniform, structured;
  rectilinear.topology = RectilinearTopology{lines};
  uniform.topology = UniformTopology{.points = {3, 4, 2}, .origin = {-1.0, 2.0, 0.5}, .axes = Mat3{0.5}};
  std::vector<double> positions;
  for (int p = 0; p < 24; ++p) {
    positions.push_back(lines[0][static_cast<std::size_t>(p % 3)]);
    positions.push_back(lines[1][static_cast<std::size_t>(p / 3 % 4)]);
    positions.push_back(lines[2][static_cast<std::size_t>(p / 12)]);
  }
  structured.topology = StructuredTopology{
      .points = {3, 4, 2},
      .positions = make_array("p", Association::kPoint, 3, std::span<const double>(positions))};
  for (DataSet* const block : {&rectilinear, &uniform, &structured}) {
    give_values(*block);
    const auto field = constant_field(*block);
    for (int cell = 0; cell < 6; ++cell) {
      const int i = cell % 2, j = cell / 2;
      for (const double part : {0.1, 0.5, 0.9}) {
        Vec3 x;
        if (block == &uniform) {
          x = Vec3{-1.0, 2.0, 0.5} + 0.5 * Vec3{i + part, j + part, part};
        } else {
          x = {glm::mix(lines[0][static_cast<std::size_t>(i)], lines[0][static_cast<std::size_t>(i) + 1],
                        part),
               glm::mix(lines[1][static_cast<std::size_t>(j)], lines[1][static_cast<std::size_t>(j) + 1],
                        part),
               glm::mix(-1.0, 1.0, part)};
        }
        CellHint hint;
        const VectorSample sample = field->sample(x, hint);
        ASSERT_EQ(sample.status, SampleStatus::kOk);
        EXPECT_LT(glm::distance(sample.value, value_of(static_cast<std::size_t>(cell))), 1e-9) << cell;
      }
    }
  }
}

TEST(ConstantCells, OfEveryKindShareNoPoints) {
  DataSet block = test::mixed_cells(3, 0.1, 5, [](const Vec3&) { return Vec3{0.0}; });
  give_values(block);
  const ConstantCells constant = constant_cells({block}, kOfCells);
  EXPECT_EQ(constant.choice.association, Association::kPoint);
  const DataSet& made = constant.blocks.front();
  EXPECT_EQ(made.cell_count(), block.cell_count());
  const auto& from = std::get<UnstructuredTopology>(block.topology);
  const auto& to = std::get<UnstructuredTopology>(made.topology);
  EXPECT_EQ(from.types, to.types);
  EXPECT_EQ(from.offsets, to.offsets);
  std::size_t next = 0;  // points are new in each cell, in the order in which they come
  for (std::size_t c = 0; c < to.types.size(); ++c) {
    const std::size_t first = next;
    const bool polyhedron = to.types[c] == 42;
    auto at = static_cast<std::size_t>(to.offsets[c]);
    const auto end = static_cast<std::size_t>(to.offsets[c + 1]);
    if (polyhedron) {
      EXPECT_EQ(to.connectivity[at], from.connectivity[at]);
    }
    at += polyhedron ? 1 : 0;
    while (at < end) {
      std::size_t count = end - at;
      if (polyhedron) count = static_cast<std::size_t>(to.connectivity[at++]);
      for (std::size_t i = 0; i < count; ++i, ++at) {
        const auto point = static_cast<std::size_t>(to.connectivity[at]);
        ASSERT_GE(point, first);
        ASSERT_LE(point, next);
        if (point == next) ++next;
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_EQ(to.positions.at(point, axis),
                    from.positions.at(static_cast<std::size_t>(from.connectivity[at]), axis));
        EXPECT_EQ(made.arrays.front().at(point, 0), value_of(c).x);
      }
    }
  }
  EXPECT_EQ(next, made.point_count());
}

TEST(ConstantCells, HiddenCellsAreNotThereAndOtherBlocksStay) {
  DataSet block, other;
  block.topology = UniformTopology{.points = {3, 2, 2}, .origin = Vec3{0.0}, .axes = Mat3{1.0}};
  give_values(block);
  block.hidden_cells = {1, 0};
  other.topology = UniformTopology{.points = {2, 2, 2}, .origin = Vec3{5.0}, .axes = Mat3{1.0}};
  const ConstantCells constant = constant_cells({block, other}, kOfCells);
  EXPECT_EQ(constant.blocks[0].cell_count(), 1U);
  EXPECT_EQ(constant.blocks[0].arrays.front().at(0, 0), value_of(1).x);
  EXPECT_TRUE(std::holds_alternative<UniformTopology>(constant.blocks[1].topology));
}

}  // namespace
}  // namespace palpate
