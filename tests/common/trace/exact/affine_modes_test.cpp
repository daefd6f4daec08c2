// The robust path of the exact cell: doubles against long doubles, where doubles claim to be certain. Long
// doubles are held against the matrix exponential in exact_linear_test.cpp.

#include "common/trace/exact/affine_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "common/trace/exact/exact_walk.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

/// Four corners, flattened by `flat`, with a linear field on them that contracts along a random direction
/// `stiffness` times faster than it changes along others; to a sink within where `sink`.
std::array<PackedVertex, 4> random_cell(std::mt19937& random, double flat, double stiffness, bool sink) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto any = [&] {
    const double x = unit(random), y = unit(random);
    return Vec3{x, y, unit(random)};
  };
  const Mat3 turning{any(), any(), any()};
  const Mat3 slow = sink ? 0.3 * turning - Mat3{1.0} : turning;
  const Vec3 normal = glm::normalize(any()), onto = any(), drift = any();
  std::array<Vec3, 4> corners{};
  for (Vec3& x : corners) x = any() * Vec3{1.0, 1.0, flat};
  const Vec3 center = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::array<PackedVertex, 4> vertices{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 x = sink ? corners[i] - center : corners[i];
    const Vec3 direction = sink ? normal : normal + 0.3 * onto;
    const Vec3 v = (sink ? Vec3{0.0} : drift) + slow * x - stiffness * glm::dot(normal, x) * direction;
    for (int axis = 0; axis < 3; ++axis) {
      vertices[i].x[axis] = corners[i][axis];
      vertices[i].v[axis] = v[axis];
    }
  }
  return vertices;
}

constexpr TetMesh::Tet kTet{0, 1, 2, 3};

/// Uniform coordinates of sum 1, on a face where `on_face`.
std::array<double, 4> random_point(std::mt19937& random, bool on_face) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::array<double, 4> b{};
  double sum = 0.0;
  for (std::size_t i = on_face ? 1 : 0; i < 4; ++i) sum += b[i] = unit(random);
  for (double& value : b) value /= sum;
  return b;
}

std::array<long double, 4> as_long(const std::array<double, 4>& b) { return {b[0], b[1], b[2], b[3]}; }

double largest_difference(const std::array<double, 4>& x, const std::array<long double, 4>& y) {
  double largest = 0.0;
  for (std::size_t i = 0; i < 4; ++i) largest = std::max(largest, std::abs(static_cast<double>(x[i] - y[i])));
  return largest;
}

TEST(AffineModes, DoublesAgreeWithLongDoublesWhereCertain) {
  std::mt19937 random{5};
  int exits = 0, rests = 0, count = 0;
  for (const double stiffness : {0.0, 1.0, 1e2, 1e4, 1e6}) {
    for (const double flat : {1.0, 0.1, 0.01}) {
      for (int n = 0; n < 150; ++n) {
        const auto vertices = random_cell(random, flat, stiffness, n % 4 == 0);
        const std::array<double, 4> b = random_point(random, n % 3 == 0);
        const AffineModes<double> modes(vertices.data(), kTet, 1.0, b, -1);
        ++count;
        if (!modes.certain()) continue;
        const AffineModes<long double> exact(vertices.data(), kTet, 1.0, as_long(b), -1);
        ASSERT_EQ(modes.exit().face, exact.exit().face) << stiffness << " " << flat << " " << n;
        constexpr double kRounding = 0x1p-45;  // per unit of rate times time; 2^-48 but for flows that spread
        if (modes.exit().face < 0) {
          // It took less than 2^18 such units.
          EXPECT_LE(largest_difference(*modes.rest(), *exact.rest()), 0x1p-53 * 0x1p18);
          ++rests;
          continue;
        }
        const double allowed = kRounding * (1.0 + modes.rate() * modes.exit().time);
        EXPECT_LE(largest_difference(modes.at(modes.exit().time), exact.at(exact.exit().time)), allowed)
            << stiffness << " " << flat << " " << n;
        ++exits;
      }
    }
  }
  EXPECT_GT(rests, 10);
  EXPECT_GT(exits + rests, 0.97 * count);
}

// A slow mode beside a rate of 1e12 has no digits in a double.
TEST(AffineModes, DoublesAreNotCertainBesideRatesTooFast) {
  std::mt19937 random{6};
  int uncertain = 0;
  for (int n = 0; n < 100; ++n) {
    const auto vertices = random_cell(random, 1.0, 1e12, false);
    const AffineModes<double> modes(vertices.data(), kTet, 1.0, random_point(random, false), -1);
    if (modes.certain()) {
      EXPECT_LE(modes.rate() * modes.exit().time, 0x1p18);
    } else {
      ++uncertain;
    }
  }
  EXPECT_GT(uncertain, 20);
}

// The cells that a hand pops over to must not cost what long doubles do: 160 ordinary pieces.
TEST(AffineModes, StiffnessOfAMillionTakesDoubles) {
  const DataSet block = test::sample_tetrahedra(*example("boundary-layer"), Index3{16}, 0.2);
  const VectorChoice choice{
      VectorChoice::Kind::kArray, Association::kPoint, {test::kSampledName}, test::kSampledName};
  const auto field = make_vector_field({block}, choice, "boundary-layer");
  const ExactMesh mesh(*field, 1);
  ExactWalk walk(mesh, 1e-9, TraceDirection::kForward);
  std::int64_t robust = 0;
  for (const Vec3& x : test::random_seeds(30, 0.4, 9)) {
    const Vec3 seed = field->frame().local_from_data(field->bounds().center() + x * field->bounds().size());
    ASSERT_TRUE(walk.start(seed));
    for (int step = 0; step < 200 && !walk.advance(); ++step) EXPECT_LE(walk.work(), 64);
    robust += walk.robust_pieces();
    EXPECT_EQ(walk.long_cells(), 0);
  }
  EXPECT_GT(robust, 1000);
}

}  // namespace
}  // namespace palpate
