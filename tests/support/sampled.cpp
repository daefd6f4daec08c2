#include "tests/support/sampled.h"

#include <cmath>
#include <numbers>
#include <random>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/field/grid/cell_split.h"

namespace palpate::test {
namespace {

/// Calls `visit(i, j, k)` in the order of structured points.
template <typename Visit>
void for_each_point(const Index3& n, Visit&& visit) {
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) visit(Index3{i, j, k});
    }
  }
}

Vec3 fraction(const Index3& at, const Index3& n) { return Vec3(at) / Vec3(n - 1); }

DataArray vectors_at(const AnalyticField& field, const std::vector<Vec3>& positions, SampledType type) {
  std::vector<double> values;
  values.reserve(3 * positions.size());
  for (const Vec3& x : positions) {
    const Vec3 v = field.velocity(x);
    values.insert(values.end(), {v.x, v.y, v.z});
  }
  if (type == SampledType::kFloat64) {
    return make_array(kSampledName, Association::kPoint, 3, std::span<const double>(values));
  }
  const std::vector<float> floats(values.begin(), values.end());
  return make_array(kSampledName, Association::kPoint, 3, std::span<const float>(floats));
}

DataArray position_array(const std::vector<Vec3>& positions) {
  std::vector<double> values;
  values.reserve(3 * positions.size());
  for (const Vec3& x : positions) values.insert(values.end(), {x.x, x.y, x.z});
  return make_array("points", Association::kPoint, 3, std::span<const double>(values));
}

}  // namespace

DataSet sample_uniform(const AnalyticField& field, const Index3& points, SampledType type) {
  PALPATE_CHECK(points.x >= 2 && points.y >= 2 && points.z >= 2);
  const Box box = field.bounds();
  UniformTopology topology;
  topology.points = points;
  topology.origin = box.lower;
  const Vec3 spacing = box.size() / Vec3(points - 1);
  for (int axis = 0; axis < 3; ++axis) topology.axes[axis][axis] = spacing[axis];
  std::vector<Vec3> positions;
  for_each_point(points, [&](const Index3& at) { positions.push_back(box.lower + spacing * Vec3(at)); });
  DataSet out;
  out.name = field.name();
  out.arrays.push_back(vectors_at(field, positions, type));
  out.topology = topology;
  return out;
}

DataSet sample_rectilinear(const AnalyticField& field, const Index3& points, double growth,
                           SampledType type) {
  PALPATE_CHECK(points.x >= 2 && points.y >= 2 && points.z >= 2 && growth > 0.0);
  const Box box = field.bounds();
  RectilinearTopology topology;
  for (int axis = 0; axis < 3; ++axis) {
    const int intervals = points[axis] - 1;
    const double ratio = intervals > 1 ? std::pow(growth, 1.0 / (intervals - 1)) : 1.0;
    std::vector<double> lines{0.0};
    double width = 1.0;
    for (int i = 0; i < intervals; ++i, width *= ratio) lines.push_back(lines.back() + width);
    const double total = lines.back();
    for (double& x : lines) x = box.lower[axis] + box.size()[axis] * (x / total);
    topology.coordinates[as_size(axis)] = std::move(lines);
  }
  std::vector<Vec3> positions;
  for_each_point(points, [&](const Index3& at) {
    positions.emplace_back(topology.coordinates[0][as_size(at.x)], topology.coordinates[1][as_size(at.y)],
                           topology.coordinates[2][as_size(at.z)]);
  });
  DataSet out;
  out.name = field.name();
  out.arrays.push_back(vectors_at(field, positions, type));
  out.topology = std::move(topology);
  return out;
}

DataSet sample_mapped(const AnalyticField& field, const Index3& points,
                      const std::function<Vec3(const Vec3& u)>& position, SampledType type) {
  PALPATE_CHECK(points.x >= 2 && points.y >= 2 && points.z >= 2);
  std::vector<Vec3> positions;
  for_each_point(points, [&](const Index3& at) { positions.push_back(position(fraction(at, points))); });
  DataSet out;
  out.name = field.name();
  out.arrays.push_back(vectors_at(field, positions, type));
  out.topology = StructuredTopology{points, position_array(positions)};
  return out;
}

DataSet sample_curvilinear(const AnalyticField& field, const Index3& points, double warp, SampledType type) {
  const Box box = field.bounds();
  const Vec3 cell = box.size() / Vec3(points - 1);
  return sample_mapped(
      field, points,
      [&](const Vec3& u) {
        // Waves that vanish on the border; the three differ, so that no family of lines stays straight.
        const auto wave = [](double s, double waves) { return std::sin(std::numbers::pi * waves * s); };
        const double inside = 64.0 * u.x * (1.0 - u.x) * u.y * (1.0 - u.y) * u.z * (1.0 - u.z);
        const Vec3 shift{wave(u.y, 3.0) * wave(u.z, 2.0), wave(u.z, 3.0) * wave(u.x, 2.0),
                         wave(u.x, 3.0) * wave(u.y, 2.0)};
        return box.lower + box.size() * u + cell * shift * (warp * inside);
      },
      type);
}

DataSet sample_tetrahedra(const AnalyticField& field, const Index3& points, double jitter, std::uint64_t seed,
                          SampledType type) {
  const Box box = field.bounds();
  const Vec3 cell = box.size() / Vec3(points - 1);
  std::mt19937_64 random(seed);
  // The engine's own bits, since distributions differ between libraries.
  const auto symmetric = [&random] { return 2.0 * (static_cast<double>(random() >> 11U) * 0x1p-53) - 1.0; };
  DataSet block = sample_mapped(
      field, points,
      [&](const Vec3& u) {
        Vec3 move{symmetric(), symmetric(), symmetric()};
        for (int axis = 0; axis < 3; ++axis) {
          if (u[axis] == 0.0 || u[axis] == 1.0) move[axis] = 0.0;
        }
        return box.lower + box.size() * u + cell * move * jitter;
      },
      type);
  const SplitMesh split = split_into_tetrahedra(std::span(&block, 1), field.name());
  UnstructuredTopology topology;
  topology.positions = std::get<StructuredTopology>(block.topology).positions;
  topology.types.assign(split.tets.size(), 10);
  topology.offsets.push_back(0);
  for (const auto& tet : split.tets) {
    topology.connectivity.insert(topology.connectivity.end(), tet.begin(), tet.end());
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  block.topology = std::move(topology);
  return block;
}

}  // namespace palpate::test
