#include "lab/data/made_data.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"

namespace palpate::test {
namespace {

Vec3 twist(const Vec3& x) { return {1.0 + x.y, 2.0 * x.z - x.x, 0.5 * x.y + 0.25}; }

std::shared_ptr<const VectorField> field_of(const DataSet& data) {
  return make_vector_field({data}, VectorChoice{.arrays = {"velocity"}, .label = "velocity"}, "made");
}

// A linear field is reproduced by linear and by trilinear interpolation, wherever it is sampled.
TEST(MadeData, ReproducesALinearFieldOnBoxesAndTetrahedra) {
  const auto even = even_coordinates(4);
  const auto tets = field_of(tetrahedral_data(even, even, {-1.0, -0.1, 1.0}, twist));
  const auto box = field_of(uniform_data(4, {Vec3(-1.0), Vec3(1.0)}, twist));
  ASSERT_NE(tets->tet_mesh(), nullptr);
  EXPECT_EQ(tets->tet_mesh()->cells().size(), 3U * 3U * 2U * 6U);
  EXPECT_EQ(tets->notes().zero_volume_cells, 0U);
  CellHint hint;
  for (const Vec3& x : {Vec3(0.3, -0.4, 0.7), Vec3(-0.99, 0.2, -0.5), Vec3(0.0)}) {
    EXPECT_LT(glm::distance(tets->sample(x, hint).value, twist(x)), 1e-14);
    EXPECT_LT(glm::distance(box->sample(x, hint).value, twist(x)), 1e-14);
  }
}

TEST(MadeData, ScalesPositionsAndValuesOfEveryTopology) {
  const auto even = even_coordinates(3);
  for (const DataSet& data :
       {uniform_data(3, {Vec3(-1.0), Vec3(1.0)}, twist), tetrahedral_data(even, even, even, twist)}) {
    const DataSet scaled = scaled_data(data, 8.0, 0.25);
    for (std::size_t p = 0; p < data.point_count(); ++p) {
      EXPECT_EQ(point_position(scaled, p), 8.0 * point_position(data, p));
      EXPECT_EQ(scaled.arrays[0].at(p, 1), 0.25 * data.arrays[0].at(p, 1));
    }
  }
}

TEST(MadeData, CutsAHoleOfTheGivenRadius) {
  const DataSet data = uniform_data(5, {Vec3(-1.0), Vec3(1.0)}, twist);
  const DataSet holed = holed_data(data, Vec3(0.0), 0.6);
  for (std::size_t p = 0; p < data.point_count(); ++p) {
    const bool inside = glm::length(point_position(data, p)) < 0.6;
    EXPECT_EQ(std::isnan(holed.arrays[0].at(p, 0)), inside) << p;
  }
}

}  // namespace
}  // namespace palpate::test
