// Meshes that are written packed, read back by VTK.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/load/load.h"
#include "common/load/write/write_mesh.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

// Blocks of a mebibyte: arrays of none, of a part of one, of whole ones and of several with a part.
TEST(WrittenMesh, PackedArraysAreReadBackToTheLastBit) {
  const test::TempFolder folder;
  const std::size_t whole = (std::size_t{1} << 20) / sizeof(double);
  for (const std::size_t count : {std::size_t{4}, whole, 2 * whole, 2 * whole + 5}) {
    std::vector<Vec3> points;
    MeshColumn value{.name = "value", .values = {}, .components = 1, .of_cells = false};
    for (std::size_t p = 0; p < count; ++p) {
      const auto x = static_cast<double>(p);
      points.emplace_back(x, std::sin(x), std::cos(0.1 * x));
      value.values.push_back(std::sqrt(x) - 100.0);
    }
    std::vector<std::array<std::uint32_t, 4>> cells;
    for (std::uint32_t p = 0; p + 3 < count; p += 4) cells.push_back({p, p + 1, p + 2, p + 3});
    MeshColumn fibre{.name = "fibre", .values = {}, .components = 3, .of_cells = true};
    for (std::size_t c = 0; c < 3 * cells.size(); ++c)
      fibre.values.push_back(1.0 / (1.0 + static_cast<double>(c)));
    const std::vector<MeshColumn> columns{value, fibre};
    const auto file = folder.path("mesh.vtu");
    write_mesh(file, points, cells, columns, true, Vec3{0.0, 0.0, 1.0});
    const std::size_t raw = 8 * (4 * count + 8 * cells.size()) + cells.size();
    if (count > 4) {
      EXPECT_LT(std::filesystem::file_size(file), 0.8 * static_cast<double>(raw));
    }

    Source source = Source::open(LoadRequest{.files = {file}});
    ASSERT_TRUE(source.info().long_axis.has_value());
    const DataSet mesh = source.read({"value", "fibre"}).at(0);
    ASSERT_EQ(mesh.point_count(), count);
    ASSERT_EQ(mesh.cell_count(), cells.size());
    const auto& topology = std::get<UnstructuredTopology>(mesh.topology);
    const DataArray *read_value = mesh.find("value", Association::kPoint),
                    *read_fibre = mesh.find("fibre", Association::kCell);
    ASSERT_NE(read_value, nullptr);
    ASSERT_NE(read_fibre, nullptr);
    for (std::size_t p = 0; p < count; ++p) {
      ASSERT_EQ(read_value->at(p), value.values[p]);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(topology.positions.at(p, c), points[p][c]);
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      for (std::size_t n = 0; n < 4; ++n) ASSERT_EQ(topology.connectivity[4 * c + n], cells[c][n]);
      for (int k = 0; k < 3; ++k)
        ASSERT_EQ(read_fibre->at(c, k), fibre.values[3 * c + static_cast<std::size_t>(k)]);
    }
  }
}

}  // namespace
}  // namespace palpate
