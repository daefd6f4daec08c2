// The robust path of the exact cell against the matrix exponential.

#include "common/trace/exact/affine_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

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
    vertices[i].v[3] = 0x1p-52 * glm::length(v);
  }
  return vertices;
}

constexpr TetMesh::Tet kTet{0, 1, 2, 3};
using Four = AffineModes::Four;

/// Uniform coordinates of sum 1, on a face where `on_face`.
Four random_point(std::mt19937& random, bool on_face) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Four b{};
  double sum = 0.0;
  for (std::size_t i = on_face ? 1 : 0; i < 4; ++i) sum += b[i] = unit(random);
  for (double& value : b) value /= sum;
  return b;
}

using Matrix = Eigen::Matrix<long double, 4, 4>;

/// B of exact_cell.h by another way: the vectors times the inverse of the corners.
Matrix rates_of(const std::array<PackedVertex, 4>& vertices) {
  Matrix x = Matrix::Ones(), v = Matrix::Zero();
  for (int j = 0; j < 4; ++j) {
    for (int a = 0; a < 3; ++a) {
      x(a, j) = vertices[static_cast<std::size_t>(j)].x[a];
      v(a, j) = vertices[static_cast<std::size_t>(j)].v[a];
    }
  }
  return x.inverse() * v;
}

/// exp(tB) b by the matrix exponential of Eigen.
Four exact_at(const Matrix& rates, const Four& b, double t) {
  const Eigen::Matrix<long double, 4, 1> start(b[0], b[1], b[2], b[3]);
  const Matrix exponential = (rates * static_cast<long double>(t)).exp();
  const Eigen::Matrix<long double, 4, 1> end = exponential * start;
  return {static_cast<double>(end(0)), static_cast<double>(end(1)), static_cast<double>(end(2)),
          static_cast<double>(end(3))};
}

// The exit lies on the face that it names, within that face, and the line has not been outside before.
TEST(AffineModes, ExitIsTheFirstThatTheMatrixExponentialHas) {
  std::mt19937 random{5};
  int exits = 0, rests = 0;
  for (const double stiffness : {0.0, 1.0, 1e2, 1e4, 1e6}) {
    for (const double flat : {1.0, 0.1, 0.01}) {
      for (int n = 0; n < 60; ++n) {
        const auto vertices = random_cell(random, flat, stiffness, n % 4 == 0);
        const Four b = random_point(random, n % 3 == 0);
        AffineModes modes(vertices.data(), kTet, 1.0, b);
        if (modes.rest()) {
          ++rests;
          continue;
        }
        ASSERT_GE(modes.exit().face, 0) << stiffness << " " << flat << " " << n;
        ++exits;
        const Matrix rates = rates_of(vertices);
        const double end = modes.exit().time;
        // Rounding of a double for each unit of rate times time, and of the time itself; long doubles have some as well.
        const double allowed = 0x1p-44 + 0x1p-46 * modes.rate() * end;
        constexpr int kParts = 12;
        for (int k = 1; k <= kParts; ++k) {
          const double t = end * k / kParts;
          const Four found = modes.at(t), exact = exact_at(rates, b, t);
          for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(found[i], exact[i], allowed) << stiffness << " " << flat << " " << n << " " << k;
            EXPECT_GE(exact[i], -allowed);
          }
        }
        EXPECT_NEAR(exact_at(rates, b, end)[static_cast<std::size_t>(modes.exit().face)], 0.0, allowed);
        EXPECT_FALSE(modes.leave_earlier(0.0, end));
      }
    }
  }
  EXPECT_GT(rests, 10);
  EXPECT_GT(exits, 500);
}

// A slow mode beside a rate of 1e12 has no digits in a double.
TEST(AffineModes, RatesTooFastForDoublesTakeTwiceTheDigits) {
  std::mt19937 random{6};
  int longs = 0;
  for (int n = 0; n < 100; ++n) {
    const auto vertices = random_cell(random, 1.0, 1e12, false);
    const AffineModes modes(vertices.data(), kTet, 1.0, random_point(random, false));
    if (modes.is_long()) {
      ++longs;
    } else {
      EXPECT_LE(modes.rate() * modes.exit().time, AffineModes::kDoublesReach);
    }
  }
  EXPECT_GT(longs, 20);
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
