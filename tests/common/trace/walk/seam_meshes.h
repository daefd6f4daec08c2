/// Meshes whose cells share no points where they meet, with u = (-y, x, 0.3), whose lines have a closed form.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"
#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sample_meshes.h"

namespace palpate::test::seams {

using Field = std::shared_ptr<const VectorField>;

inline Vec3 helix(const Vec3& x) { return {-x.y, x.x, 0.3}; }
inline Vec3 on_helix(const Vec3& x, double t) {
  const double c = std::cos(t), s = std::sin(t);
  return {c * x.x - s * x.y, s * x.x + c * x.y, x.z + 0.3 * t};
}

/// Cells of one block, each with points of its own.
class OwnPoints {
 public:
  /// @param noise by which points that coincide differ; @param jump by which the values of each cell do.
  OwnPoints(double noise, double jump) : noise_(noise), jump_(jump) {}

  void add(std::uint8_t type, const std::vector<Vec3>& corners) {
    const Vec3 shift = jump_ * random_vector();
    for (const Vec3& corner : corners) {
      const Vec3 x = corner + noise_ * random_vector(), v = helix(x) + shift;
      topology_.connectivity.push_back(static_cast<std::int64_t>(position_.size() / 3));
      position_.insert(position_.end(), {x.x, x.y, x.z});
      value_.insert(value_.end(), {v.x, v.y, v.z});
    }
    topology_.types.push_back(type);
    topology_.offsets.push_back(static_cast<std::int64_t>(topology_.connectivity.size()));
  }

  /// A box of n cells along each axis, each a hexahedron, or made of six pyramids, two wedges or five tetrahedra.
  void add_box(std::uint8_t type, const Vec3& lower, const Vec3& upper, const Index3& n) {
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) {
          const auto at = [&](int a, int b, int c) {
            return lower + (upper - lower) * Vec3(i + a, j + b, k + c) / Vec3(n);
          };
          add_cube(type,
                   {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1),
                    at(0, 1, 1)},
                   (i + j + k) % 2 != 0);
        }
      }
    }
  }

  [[nodiscard]] DataSet take() const {
    DataSet block;
    UnstructuredTopology topology = topology_;
    topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position_));
    block.topology = std::move(topology);
    block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(value_)));
    return block;
  }

 private:
  void add_cube(std::uint8_t type, const std::array<Vec3, 8>& x, bool odd) {
    if (type == 12) add(12, {x.begin(), x.end()});
    if (type == 13) {
      add(13, {x[0], x[1], x[2], x[4], x[5], x[6]});
      add(13, {x[0], x[2], x[3], x[4], x[6], x[7]});
    }
    if (type == 14) {
      Vec3 middle{0.0};
      for (const Vec3& corner : x) middle += 0.125 * corner;
      for (const auto& f : std::array<std::array<std::size_t, 4>, 6>{
               {{0, 1, 2, 3}, {7, 6, 5, 4}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}})
        add(14, {x[f[0]], x[f[1]], x[f[2]], x[f[3]], middle});
    }
    if (type == 10) {
      using Five = std::array<std::array<std::size_t, 4>, 5>;
      for (const auto& t : odd ? Five{{{1, 0, 2, 5}, {3, 0, 2, 7}, {4, 0, 5, 7}, {6, 2, 5, 7}, {0, 2, 5, 7}}}
                               : Five{{{0, 1, 3, 4}, {2, 1, 3, 6}, {5, 1, 4, 6}, {7, 3, 4, 6}, {1, 3, 4, 6}}})
        add(10, {x[t[0]], x[t[1]], x[t[2]], x[t[3]]});
    }
  }
  Vec3 random_vector() {
    std::uniform_real_distribution<double> one(-1.0, 1.0);
    const double x = one(random_), y = one(random_);
    return {x, y, one(random_)};
  }

  double noise_, jump_;
  std::mt19937_64 random_{7};
  UnstructuredTopology topology_{.positions = {}, .types = {}, .offsets = {0}, .connectivity = {}};
  std::vector<double> position_, value_;
};

inline Field field_of(const std::vector<DataSet>& blocks) {
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, 1};
  return make_vector_field(blocks, choose_vector({info}, "velocity", "seams"), "seams");
}

inline DataSet lattice(const Index3& n, const Vec3& lower, const Vec3& upper, double turn = 0.0) {
  std::vector<Vec3> positions;
  for (int k = 0; k <= n.z; ++k) {
    for (int j = 0; j <= n.y; ++j) {
      for (int i = 0; i <= n.x; ++i) {
        const Vec3 x = lower + (upper - lower) * Vec3(i, j, k) / Vec3(n);
        positions.emplace_back(std::cos(turn) * x.x - std::sin(turn) * x.y,
                               std::sin(turn) * x.x + std::cos(turn) * x.y, x.z);
      }
    }
  }
  return test::structured_block(n + 1, positions, helix);
}

inline std::vector<Vec3> seeds(int count) {
  std::vector<Vec3> out = test::random_seeds(count, 0.7, 5);
  for (Vec3& x : out) x.z = 0.05 + 0.2 * std::abs(x.z);
  return out;
}

/// Every line follows the helix up to z = 2 or to a side of the box, within `tolerance`.
/// @param stated and within the error that it states, up to rounding
inline void expect_helices(const Field& field, double tolerance, bool stated = false) {
  const std::vector<Vec3> from = seeds(40);
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54, Integrator::kRodas4}) {
    SCOPED_TRACE(name_of(integrator));
    TraceOptions options;
    options.integrator = integrator;
    options.tolerance = 1e-9;
    options.threads = 1;
    const TraceResult result = trace_lines(*field, from, options);
    ASSERT_EQ(result.lines.size(), from.size());
    for (const Line& line : result.lines) {
      const LinePoint& last = line.points.back();
      EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end) << " seed " << line.seed;
      const double side = std::max(std::abs(last.position.x), std::abs(last.position.y));
      EXPECT_NEAR(std::max(side, last.position.z - 1.0), 1.0, 1e-6) << "seed " << line.seed;
      for (const LinePoint& p : line.points) {
        const double off = glm::distance(p.position, on_helix(from[line.seed], p.time));
        ASSERT_LE(off, tolerance) << "seed " << line.seed << " t " << p.time;
        constexpr double kRounding = 1e-12;
        if (stated) {
          ASSERT_LE(off, p.error + kRounding) << "seed " << line.seed << " t " << p.time;
        }
      }
    }
  }
}

inline bool noted(const Field& field, const std::string& words) {
  for (const std::string& line : field->notes().lines) {
    if (line.find(words) != std::string::npos) return true;
  }
  return false;
}

/// Kinds of block: an image, a rectilinear grid, a curvilinear one, or cells of a type that share no points.
inline constexpr std::array<int, 7> kBlockKinds{-1, -2, -3, 10, 12, 13, 14};

/// Kinds of block whose cells share their points, by the type of these.
inline constexpr std::array<int, 4> kJoinedKinds{-10, -12, -13, -14};

/// The same cells, with one point where several coincide.
inline DataSet joined(DataSet block) {
  auto& mesh = std::get<UnstructuredTopology>(block.topology);
  std::map<std::array<double, 3>, std::int64_t> points;
  std::vector<double> position, value;
  const std::vector<std::int64_t> before = mesh.connectivity;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto p = static_cast<std::size_t>(before[i]);
    const std::array<double, 3> x{mesh.positions.at(p, 0), mesh.positions.at(p, 1), mesh.positions.at(p, 2)};
    const auto [at, made] = points.try_emplace(x, static_cast<std::int64_t>(points.size()));
    mesh.connectivity[i] = at->second;
    for (int axis = 0; made && axis < 3; ++axis) {
      position.push_back(x[static_cast<std::size_t>(axis)]);
      value.push_back(block.arrays[0].at(p, axis));
    }
  }
  mesh.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  block.arrays = {make_array("velocity", Association::kPoint, 3, std::span<const double>(value))};
  return block;
}

inline DataSet block_of(int kind, const Index3& n, const Vec3& lower, const Vec3& upper) {
  if (kind <= -10) return joined(block_of(-kind, n, lower, upper));
  if (kind > 0) {
    OwnPoints cells(0.0, 0.0);
    cells.add_box(static_cast<std::uint8_t>(kind), lower, upper, n);
    return cells.take();
  }
  DataSet block = lattice(n, lower, upper);
  const Vec3 step = (upper - lower) / Vec3(n);
  if (kind == -1) {
    Mat3 axes{0.0};
    for (int axis = 0; axis < 3; ++axis) axes[axis][axis] = step[axis];
    block.topology = UniformTopology{.points = n + 1, .origin = lower, .axes = axes};
  }
  if (kind == -2) {
    RectilinearTopology lines;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i <= n[axis]; ++i)
        lines.coordinates[static_cast<std::size_t>(axis)].push_back(lower[axis] + i * step[axis]);
    }
    block.topology = lines;
  }
  return block;
}

}  // namespace palpate::test::seams
