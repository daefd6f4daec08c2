#include "common/scene/volume_source.h"

#include <cmath>
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

TEST(VolumeSource, OtherGridsAndSeveralBlocksAreRefused) {
  DataSet rectilinear = block(Association::kPoint, 1);
  rectilinear.topology = RectilinearTopology{{std::vector<double>{0, 1, 3}, {0, 1, 2, 3}, {0, 1, 2, 3, 4}}};
  const DataSet uniform = block(Association::kPoint, 1);
  for (const std::vector<DataSet>& blocks :
       {std::vector<DataSet>{rectilinear}, {uniform, uniform}, std::vector<DataSet>{}}) {
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
