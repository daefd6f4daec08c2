// Isosurfaces of real volumes under rough random paths: noise, plateaus, values in steps of one, points where
// the gradient vanishes.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/constraint/isosurface.h"
#include "tests/support/shared_data.h"

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// A raw volume of points one apart, the last bytes of a file.
template <typename T>
std::shared_ptr<const ScalarField> read_volume(const std::filesystem::path& path, const Index3& points,
                                               std::endian endian, ScalarType type) {
  const auto count = static_cast<std::size_t>(points.x) * static_cast<std::size_t>(points.y) *
                     static_cast<std::size_t>(points.z);
  std::vector<T> values(count);
  std::ifstream file(path, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(count * sizeof(T)), std::ios::end);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
  EXPECT_TRUE(file.good());
  if (endian != std::endian::native) {
    for (T& value : values) value = static_cast<T>((value >> 8U) | (value << 8U));
  }
  auto owner = std::make_shared<const std::vector<T>>(std::move(values));
  DataSet block;
  UniformTopology topology;
  topology.points = points;
  block.topology = topology;
  DataArray array{.name = "s", .type = type, .tuples = count};
  array.bytes = std::as_bytes(std::span(*owner));
  array.owner = owner;
  block.arrays.push_back(std::move(array));
  return make_scalar_field({block}, {"s"}, path.string());
}

struct Counts {
  std::array<int, kHoldStateCount> states{};
  double worst = 0.0;  ///< |s - s_0| of the proxy, in parts of the value range
  int stuck = 0;       ///< steps that fell back with work left
};

/// Strokes, tremor and leaps, at 1 mm to the voxel.
Counts feel(const std::shared_ptr<const ScalarField>& field, const std::vector<double>& isovalues,
            IsosurfaceHold hold, int steps) {
  const Workspace workspace(1e-3, field->frame());
  IsosurfaceConstraint constraint(field, workspace);
  ChainSettings settings;
  settings.isosurface.hold = hold;
  settings.isosurface.snap_distance = hold == IsosurfaceHold::kLayer ? 5e-4 : 0.0;
  for (const double value : isovalues) {
    auto& all = settings.isosurface.isovalues;
    all.value[static_cast<std::size_t>(all.count++)] = value;
  }
  constraint.apply(settings);
  std::mt19937_64 random(11);
  const Vec3 size = field->bounds().size();
  const auto somewhere = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return size * Vec3{x, y, z};
  };
  Counts counts;
  CellHint hint;
  const double range = field->highest() - field->lowest();
  Vec3 probe = somewhere(), goal = probe;
  for (int n = 0; n < steps; ++n) {
    if (n % 200 == 0) goal = somewhere();
    if (n % 997 == 0) probe = somewhere();
    const double x = unit(random), y = unit(random), z = unit(random);
    probe += 0.02 * (goal - probe) + (n % 3 == 0 ? 2.0 : 0.1) * (2.0 * Vec3{x, y, z} - 1.0);
    LinkUpdate link;
    constraint.update(workspace.workspace_from_data(probe), {}, link);
    ++counts.states[static_cast<std::size_t>(link.state)];
    counts.stuck += link.state == HoldState::kFellBack && link.iterations < UpdateBudget{}.iterations ? 1 : 0;
    const int index = constraint.held_by();
    if (index < 0) {
      EXPECT_EQ(link.proxy, workspace.workspace_from_data(probe));
      continue;
    }
    const ScalarSample s = field->sample(workspace.data_from_workspace(link.proxy), hint);
    EXPECT_EQ(s.status, SampleStatus::kOk);
    counts.worst =
        std::max(counts.worst, std::abs(s.value - isovalues[static_cast<std::size_t>(index)]) / range);
  }
  return counts;
}

void check(const std::shared_ptr<const ScalarField>& field, const std::vector<double>& isovalues) {
  for (const IsosurfaceHold hold : {IsosurfaceHold::kWall, IsosurfaceHold::kLayer}) {
    constexpr int kSteps = 60'000;
    const Counts counts = feel(field, isovalues, hold, kSteps);
    EXPECT_LE(counts.worst, 1e-6);
    // Values are whole numbers, and so are the isovalues: the surface goes through vertices of the grid.
    EXPECT_EQ(counts.stuck, 0) << "only leaps farther than the work reaches may fall back";
    const int held = counts.states[static_cast<std::size_t>(HoldState::kHeld)];
    const int fell_back = counts.states[static_cast<std::size_t>(HoldState::kFellBack)];
    EXPECT_GT(held, kSteps / 20);
    std::printf("%s: worst %.2g of the range; free %d, held %d, fell back %d, released %d\n",
                std::string(name_of(hold)).c_str(), counts.worst, counts.states[0], held, fell_back,
                counts.states[static_cast<std::size_t>(HoldState::kReleased)]);
  }
}

TEST(IsosurfaceVolumes, ToothIsFeltWhereItsInterpolantIs) {
  PALPATE_NEED_DATA(path, "grid/tooth/tooth.raw");
  const auto field = read_volume<std::uint16_t>(path, {103, 94, 161}, std::endian::big, ScalarType::kUint16);
  check(field, {500.0, 700.0, 1000.0});
}

TEST(IsosurfaceVolumes, IronProteinIsFeltWhereItsInterpolantIs) {
  PALPATE_NEED_DATA(path, "grid/ironprot/ironProt.vtk");
  const auto field = read_volume<std::uint8_t>(path, {68, 68, 68}, std::endian::native, ScalarType::kUint8);
  check(field, {20.0, 64.0, 128.0});
}

}  // namespace
}  // namespace palpate
