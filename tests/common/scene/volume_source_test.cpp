#include "common/scene/volume_source.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

DataSet block(Association association, int components) {
  DataSet block;
  UniformTopology topology;
  topology.points = {3, 4, 5};
  topology.origin = {1.0, 2.0, 3.0};
  topology.axes = Mat3(Vec3(0, 2, 0), Vec3(-2, 0, 0), Vec3(0, 0, 4));
  block.topology = topology;
  const std::size_t tuples = association == Association::kPoint ? 60 : 24;
  std::vector<float> values(tuples * static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  block.arrays.push_back(make_array("a", association, components, values));
  return block;
}

TEST(VolumeSource, PointsOfOneComponentStayWhereTheyAre) {
  const DataSet given = block(Association::kPoint, 1);
  const DataSet source = volume_source({given}, {"a", Association::kPoint, 0}, "f");
  EXPECT_EQ(source.arrays.at(0).bytes.data(), given.arrays[0].bytes.data());
  EXPECT_EQ(std::get<UniformTopology>(source.topology).points, Index3(3, 4, 5));
}

TEST(VolumeSource, CellsBecomeVoxelsAtTheirMiddles) {
  const DataSet source = volume_source({block(Association::kCell, 1)}, {"a", Association::kCell, 0}, "f");
  const auto& topology = std::get<UniformTopology>(source.topology);
  EXPECT_EQ(topology.points, Index3(2, 3, 4));
  EXPECT_EQ(topology.origin, Vec3(1.0 - 1.0, 2.0 + 1.0, 3.0 + 2.0));
  EXPECT_EQ(source.arrays.at(0).association, Association::kPoint);
  EXPECT_EQ(source.point_count(), source.arrays[0].tuples);
}

TEST(VolumeSource, ComponentsAndMagnitudesAreTakenOut) {
  const DataSet given = block(Association::kPoint, 3);
  EXPECT_EQ(volume_source({given}, {"a", Association::kPoint, 1}, "f").arrays[0].at(2), 7.0);
  const DataSet norm = volume_source({given}, {"a", Association::kPoint, ScalarChoice::kMagnitude}, "f");
  EXPECT_EQ(norm.arrays[0].components, 1);
  EXPECT_FLOAT_EQ(static_cast<float>(norm.arrays[0].at(1)), std::sqrt(9.0F + 16.0F + 25.0F));
}

// 2^30 and 1 apart: single precision has them alike.
TEST(VolumeSource, ComponentsKeepTheirType) {
  DataSet given = block(Association::kPoint, 1);
  const auto numbers = std::make_shared<std::vector<std::int32_t>>();
  for (std::int32_t i = 0; i < 60; ++i) numbers->insert(numbers->end(), {i, (1 << 30) + i});
  DataArray& array = given.arrays.at(0);
  array.components = 2;
  array.type = ScalarType::kInt32;
  array.bytes = std::as_bytes(std::span(std::as_const(*numbers)));
  array.owner = numbers;
  for (const int component : {0, 1}) {
    const DataSet source = volume_source({given}, {"a", Association::kPoint, component}, "f");
    EXPECT_EQ(source.arrays[0].type, ScalarType::kInt32);
    for (std::size_t p = 0; p < 60; ++p)
      EXPECT_EQ(source.arrays[0].at(p), static_cast<double>(p) + (component == 0 ? 0.0 : 1073741824.0));
  }
}

// What lies evenly is an image, whatever the file calls its grid: voxels are where they were.
TEST(VolumeSource, GridsWhosePointsLieEvenlyAreLattices) {
  const DataSet image = block(Association::kPoint, 1);
  const auto& place = std::get<UniformTopology>(image.topology);
  const auto structured = [&image](const UniformTopology& lattice, double off) {
    std::vector<double> places;
    for (int p = 0; p < 60; ++p) {
      Vec3 x = lattice.origin + lattice.axes * Vec3(p % 3, p / 3 % 4, p / 12);
      if (p == 31) x.y += off;
      places.insert(places.end(), {x.x, x.y, x.z});
    }
    DataSet curved = image;
    curved.topology = StructuredTopology{
        lattice.points, make_array("positions", Association::kPoint, 3, std::span<const double>(places))};
    return curved;
  };
  UniformTopology sheared = place;
  sheared.axes[2] = Vec3(0.5, 0.25, 4.0);
  DataSet even = image, uneven = image;
  even.topology = RectilinearTopology{{std::vector<double>{1, 3, 5}, {2, 1, 0, -1}, {0, 0.1, 0.2, 0.3, 0.4}}};
  uneven.topology = RectilinearTopology{{std::vector<double>{1, 3, 6}, {2, 1, 0, -1}, {0, 1, 2, 3, 4}}};
  std::vector<DataSet> blocks{
      structured(place, 0.0), structured(sheared, 1e-4), structured(place, 0.1), even, uneven, image};
  take_lattices(blocks);
  for (const std::size_t b : {0U, 1U, 3U}) {
    const auto* lattice = std::get_if<UniformTopology>(&blocks[b].topology);
    ASSERT_NE(lattice, nullptr) << b;
    EXPECT_EQ(lattice->points, Index3(3, 4, 5)) << b;
    EXPECT_EQ(blocks[b].arrays[0].bytes.data(), image.arrays[0].bytes.data());
  }
  const auto& turned = std::get<UniformTopology>(blocks[0].topology);
  EXPECT_LT(glm::distance(turned.axes[0], place.axes[0]) + glm::distance(turned.axes[1], place.axes[1]) +
                glm::distance(turned.axes[2], place.axes[2]) + glm::distance(turned.origin, place.origin),
            1e-12);
  EXPECT_LT(glm::distance(std::get<UniformTopology>(blocks[1].topology).axes[2], sheared.axes[2]), 1e-3);
  const auto& straight = std::get<UniformTopology>(blocks[3].topology);
  EXPECT_EQ(straight.origin, Vec3(1, 2, 0));
  EXPECT_LT(glm::distance(straight.axes[1], Vec3(0, -1, 0)), 1e-12);
  EXPECT_TRUE(std::holds_alternative<StructuredTopology>(blocks[2].topology));
  EXPECT_TRUE(std::holds_alternative<RectilinearTopology>(blocks[4].topology));
}

TEST(VolumeSource, ARectilinearBlockKeepsItsCoordinates) {
  DataSet given = block(Association::kPoint, 1);
  given.topology = RectilinearTopology{{std::vector<double>{0, 1, 3}, {0, 1, 2, 3}, {4, 3, 2, 1, -4}}};
  const DataSet source = volume_source({given}, {"a", Association::kPoint, 0}, "f");
  EXPECT_EQ(std::get<RectilinearTopology>(source.topology).coordinates,
            std::get<RectilinearTopology>(given.topology).coordinates);
  EXPECT_EQ(source.arrays[0].bytes.data(), given.arrays[0].bytes.data());
}

TEST(VolumeSource, CellsOfARectilinearBlockStandAtTheirMiddlesAndOneAloneAtBothItsEnds) {
  DataSet given;
  given.topology = RectilinearTopology{{std::vector<double>{0, 1, 3, 9}, {5, 2}, {0, 4, 5}}};
  given.arrays = {
      make_array("a", Association::kCell, 1, std::span<const float>(std::vector<float>{1, 2, 3, 4, 5, 6}))};
  given.hidden_cells = {0, 1, 0, 0, 0, 0};
  const DataSet source = volume_source({given}, {"a", Association::kCell, 0}, "f");
  const RectilinearTopology wanted{{std::vector<double>{0.5, 2, 6}, {5, 2}, {2, 4.5}}};
  EXPECT_EQ(std::get<RectilinearTopology>(source.topology).coordinates, wanted.coordinates);
  ASSERT_EQ(source.arrays[0].tuples, 12U);
  constexpr std::array<double, 12> kValues{1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6};
  for (std::size_t i = 0; i < kValues.size(); ++i) EXPECT_EQ(source.arrays[0].at(i), kValues[i]) << i;
  EXPECT_EQ(source.visible, (std::vector<std::uint8_t>{1, 0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(VolumeSource, OtherGridsAndSeveralBlocksAreRefused) {
  DataSet curved = block(Association::kPoint, 1);
  curved.topology = StructuredTopology{};
  const DataSet uniform = block(Association::kPoint, 1);
  for (const std::vector<DataSet>& blocks :
       {std::vector<DataSet>{curved}, {uniform, uniform}, std::vector<DataSet>{}}) {
    try {
      (void)volume_source(blocks, {"a", Association::kPoint, 0}, "f.vtr");
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("f.vtr"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace palpate
