// Lines of flows in time on meshes, grids and images that move, against closed forms.

#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/unsteady/trace_unsteady.h"
#include "tests/common/trace/unsteady/flows_in_time.h"

namespace palpate {
namespace {

const std::vector<Vec3> kCarried{{0.5, 0.1, 0.2}, {-0.3, 0.6, -0.4}, {0.05, -0.05, 0.0}};

/// Tetrahedra of [-1, 1]^3 moved along with X(t) = Rot_z(turn(t)) X + shift(t), and the flow of that motion, plus a
/// slip along z by which particles move through the mesh.
struct RigidMesh {
  double turn_rate, shift, slip;

  [[nodiscard]] Vec3 moved(const Vec3& x, double t) const {
    const double a = turn_rate * t, c = std::cos(a), s = std::sin(a);
    return {c * x.x - s * x.y + shift * std::sin(t), s * x.x + c * x.y, x.z};
  }
  [[nodiscard]] Vec3 velocity(const Vec3& x, double t) const {
    const double from_axis = x.x - shift * std::sin(t);
    return {-turn_rate * x.y + shift * std::cos(t), turn_rate * from_axis, slip};
  }
  [[nodiscard]] std::shared_ptr<const VectorField> at(double t) const {
    const test::AtMoment formula([&](const Vec3&) { return Vec3{0.0}; });
    DataSet block = test::sample_tetrahedra(formula, Index3{5}, 0.2, 1, test::SampledType::kFloat64);
    auto& topology = std::get<UnstructuredTopology>(block.topology);
    std::vector<double> x, v;
    for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
      const Vec3 at =
          moved({topology.positions.at(p, 0), topology.positions.at(p, 1), topology.positions.at(p, 2)}, t);
      const Vec3 flow = velocity(at, t);
      for (int i = 0; i < 3; ++i) {
        x.push_back(at[i]);
        v.push_back(flow[i]);
      }
    }
    topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
    block.arrays = {make_array(test::kSampledName, Association::kPoint, 3, std::span<const double>(v))};
    return test::field_of(block);
  }
};

/// Pathlines of `data`, which has a member at(t) and moves as `motion`, from between two steps: each point must lie
/// where the motion brings its particle, to within `tolerance`.
template <typename Data>
void expect_carried(const Data& data, const RigidMesh& motion, double tolerance) {
  constexpr double kFrom = 0.12;
  const std::vector<double> times = test::steps_until(2.0, 40);
  const auto read = [&](std::size_t step) { return data.at(times[step]); };
  std::vector<Vec3> seeds;
  for (const Vec3& x : kCarried) seeds.push_back(motion.moved(x, kFrom));
  const UnsteadyResult result = trace_unsteady(
      times, read, seeds, {.order = TimeOrder::kCubic, .from = kFrom, .trace = {.max_length = 1e3}});
  EXPECT_TRUE(result.in_time.moving_mesh);
  EXPECT_FALSE(result.in_time.other_meshes);
  ASSERT_EQ(result.trace.lines.size(), seeds.size());
  for (const Line& line : result.trace.lines) {
    EXPECT_EQ(line.end, End::kEndOfTime) << name_of(line.end) << ", shift " << motion.shift;
    for (const LinePoint& point : line.points) {
      Vec3 there = motion.moved(kCarried[line.seed], kFrom + point.time);
      there.z += motion.slip * point.time;
      EXPECT_LT(glm::distance(point.position, there), tolerance) << "shift " << motion.shift;
    }
  }
}

TEST(Pathlines, GoWithAMeshThatMoves) {
  // Shifts of a part of the mesh, and of more than its size from step to step.
  for (const RigidMesh mesh :
       {RigidMesh{0.5, 0.3, 0.1}, RigidMesh{1.0, 0.0, -0.2}, RigidMesh{0.0, 40.0, 0.05}})
    expect_carried(mesh, mesh, 2e-4 * (1.0 + mesh.shift));
}

/// Points along axes that move and stretch with x(t) = (1 + 0.3 t) X + s sin(t) along x and 1 + 0.1 t along z, and the
/// flow of that motion.
struct StretchedBox {
  bool uniform;
  double shift;

  [[nodiscard]] Vec3 moved(const Vec3& x, double t) const {
    return {(1.0 + 0.3 * t) * x.x + shift * std::sin(t), x.y, (1.0 + 0.1 * t) * x.z};
  }
  [[nodiscard]] Vec3 velocity(const Vec3& x, double t) const {
    const double along = (x.x - shift * std::sin(t)) / (1.0 + 0.3 * t);
    return {0.3 * along + shift * std::cos(t), 0.0, 0.1 * x.z / (1.0 + 0.1 * t)};
  }
  [[nodiscard]] std::shared_ptr<const VectorField> at(double t) const {
    const test::AtMoment formula([&](const Vec3& x) { return velocity(moved(x, t), t); });
    constexpr auto kDouble = test::SampledType::kFloat64;
    DataSet block = uniform ? test::sample_uniform(formula, Index3{5}, kDouble)
                            : test::sample_rectilinear(formula, Index3{5}, 3.0, kDouble);
    if (auto* const image = std::get_if<UniformTopology>(&block.topology)) {
      image->origin = moved(image->origin, t);
      image->axes[0] *= 1.0 + 0.3 * t;
      image->axes[2] *= 1.0 + 0.1 * t;
    } else {
      auto& lines = std::get<RectilinearTopology>(block.topology).coordinates;
      for (double& x : lines[0]) x = moved({x, 0.0, 0.0}, t).x;
      for (double& z : lines[2]) z *= 1.0 + 0.1 * t;
    }
    return test::field_of(block);
  }
};

TEST(Pathlines, GoWithAGridThatMoves) {
  for (const StretchedBox box :
       {StretchedBox{true, 0.3}, StretchedBox{false, 0.3}, StretchedBox{true, 40.0}}) {
    const std::vector<double> times = test::steps_until(2.0, 40);
    const auto read = [&](std::size_t step) { return box.at(times[step]); };
    std::vector<Vec3> seeds{{1.0, 0.1, 0.2}};  // on the border, which moves with the flow
    seeds.insert(seeds.end(), kCarried.begin(), kCarried.end());
    const std::vector<Vec3> first = seeds;
    for (Vec3& x : seeds) x = box.moved(x, 0.12);  // between two steps
    const UnsteadyResult result = trace_unsteady(
        times, read, seeds, {.order = TimeOrder::kCubic, .from = 0.12, .trace = {.max_length = 1e3}});
    EXPECT_TRUE(result.in_time.moving_mesh);
    EXPECT_FALSE(result.in_time.other_meshes);
    std::size_t whole = 0;
    for (const Line& line : result.trace.lines) {
      whole += line.end == End::kEndOfTime ? 1 : 0;
      for (const LinePoint& point : line.points) {
        const Vec3 there = box.moved(first[line.seed], 0.12 + point.time);
        EXPECT_LT(glm::distance(point.position, there), 2e-4 * (1.0 + box.shift)) << box.shift;
      }
    }
    EXPECT_GE(whole, kCarried.size()) << box.shift;
  }
}

/// An image that turns about z and shifts along x, and the flow of that motion, plus a slip along z.
struct TurningImage {
  RigidMesh motion;
  Vec3 spacing{0.25, 0.2, 0.25};

  [[nodiscard]] std::shared_ptr<const VectorField> at(double t) const {
    constexpr Index3 kPoints{9, 11, 9};
    const Vec3 origin = motion.moved(Vec3{-1.0}, t);
    UniformTopology topology{.points = kPoints, .origin = origin, .axes = Mat3{1.0}};
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 next{-1.0};
      next[axis] += spacing[axis];
      topology.axes[axis] = motion.moved(next, t) - origin;
    }
    std::vector<double> v;
    for (int k = 0; k < kPoints.z; ++k) {
      for (int j = 0; j < kPoints.y; ++j) {
        for (int i = 0; i < kPoints.x; ++i) {
          const Vec3 flow = motion.velocity(origin + topology.axes * Vec3(i, j, k), t);
          v.insert(v.end(), {flow.x, flow.y, flow.z});
        }
      }
    }
    DataSet block;
    block.topology = topology;
    block.arrays = {make_array(test::kSampledName, Association::kPoint, 3, std::span<const double>(v))};
    return test::field_of(block);
  }
};

TEST(Pathlines, GoWithAnImageThatTurns) {
  // By half a turn in all, so that its axes are, among others, those of the data, and these backwards.
  constexpr double kHalfTurn = std::numbers::pi / 2.0;
  for (const RigidMesh& motion : {RigidMesh{kHalfTurn, 0.3, 0.1}, RigidMesh{-kHalfTurn, 0.0, -0.2}})
    expect_carried(TurningImage{motion}, motion, 1e-3);
}

}  // namespace
}  // namespace palpate
