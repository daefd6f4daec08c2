// The fast path of the exact cell: its series against the matrix exponential, and one kind of processor
// against the other.

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include "common/base/parallel.h"
#include "common/field/analytic/examples.h"
#include "common/trace/exact/exact_walk.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

using Matrix = Eigen::Matrix<long double, 4, 4>;

/// A cell of random corners and vectors, flattened by `flat`.
AffineCell random_cell(std::mt19937& random, double flat) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  PackedVertex vertices[4]{};
  for (PackedVertex& vertex : vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      vertex.x[axis] = (axis == 2 ? flat : 1.0) * unit(random);
      vertex.v[axis] = unit(random);
    }
  }
  constexpr std::uint32_t kTet[4] = {0, 1, 2, 3};
  AffineCell cell;
  EXPECT_TRUE(load_cell(cell, vertices, kTet, 1.0));
  return cell;
}

Course course_of(const AffineCell& cell, const Pack4& b) {
  Course course{.b = b, .w = rate(cell, b), .a = {}, .j = {}};
  course.a = apply(cell, course.w);
  course.j = apply(cell, course.a);
  return course;
}

TEST(ExactCell, SeriesIsTheMatrixExponentialToRounding) {
  std::mt19937 random{3};
  for (const double theta : {1e-7, 1e-3, 0.03, 0.2, 0.7, 1.3, 2.0}) {
    for (int n = 0; n < 200; ++n) {
      const AffineCell cell = random_cell(random, n % 2 == 0 ? 1.0 : 1e-3);
      const double h = theta / cell.norm;
      const Course course = course_of(cell, {0.1, 0.2, 0.3, 0.4});
      const Flow found = flow(cell, course, h, pair_count(theta));

      Matrix c = Matrix::Zero();
      Eigen::Matrix<long double, 4, 1> w;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 3; ++j) c(i, j) = cell.column[j][i];
        w(i) = course.w[i];
      }
      const Eigen::Matrix<long double, 4, 1> exact = (c * static_cast<long double>(h)).exp() * w;
      const double allowed = 64.0 * 0x1p-52 * max_abs(course.w);
      for (int i = 0; i < 4; ++i) EXPECT_NEAR(found.w[i], static_cast<double>(exact(i)), allowed) << theta;
      // What rounding of w makes of the speed.
      const Pack4 v = velocity(cell, found.w);
      EXPECT_NEAR(std::sqrt(found.squared_speed[3]), std::sqrt(dot3(v, v)), 3.0 * cell.size * allowed);
    }
  }
}

// b' = w: the positions are the integral of the rates, here by Simpson's rule over 64 parts.
TEST(ExactCell, PositionsAreTheIntegralOfTheRates) {
  std::mt19937 random{4};
  for (int n = 0; n < 50; ++n) {
    const AffineCell cell = random_cell(random, 1.0);
    const Course course = course_of(cell, {0.1, 0.2, 0.3, 0.4});
    const double h = 0.5 / cell.norm;
    constexpr int kParts = 64;
    Pack4 sum;
    for (int i = 0; i <= kParts; ++i) {
      const double weight = i == 0 || i == kParts ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      const double t = h * i / kParts;
      sum += weight * (i == 0 ? course.w : flow(cell, course, t, pair_count(t * cell.norm)).w);
    }
    const Pack4 expected = course.b + (h / (3.0 * kParts)) * sum;
    const Pack4 found = flow(cell, course, h, pair_count(0.5)).b;
    EXPECT_LE(max_abs(found - expected), 1e-10 * h * max_abs(course.w));
  }
}

TEST(ExactMesh, IsPackedOnceAFieldWhoeverAsks) {
  const auto field = test::on_tetrahedra(Mat3{1.0}, Vec3{0.0}, 4, 0.2, 1);
  const auto other = test::on_tetrahedra(Mat3{2.0}, Vec3{0.0}, 4, 0.2, 1);
  std::array<const ExactMesh*, 8> found{};
  parallel_for(found.size(), 2, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) found[i] = &ExactMesh::of(*field, 1);
  });
  for (const ExactMesh* mesh : found) EXPECT_EQ(mesh, found[0]);
  EXPECT_EQ(&found[0]->mesh(), field->tet_mesh());
  EXPECT_NE(&ExactMesh::of(*other, 1), found[0]);
}

TEST(ExactKernel, EveryKindOfProcessorGivesTheSameBits) {
  const std::span<const ExactKernel> kernels = exact_kernels();
  if (kernels.size() < 2) GTEST_SKIP() << "this processor runs one kind only";
  const DataSet block =
      test::sample_tetrahedra(*example("abc"), Index3{9}, 0.3, 3, test::SampledType::kFloat64);
  const ArrayInfo& array = {block.arrays[0].name, block.arrays[0].association, block.arrays[0].components,
                            block.arrays[0].type, block.arrays[0].tuples};
  const auto field = make_vector_field({block}, choose_vector({array}, "", "abc"), "abc");
  const ExactMesh mesh(*field, 1);
  std::vector<Vec3> seeds = test::random_seeds(60, 0.4, 3);
  for (const TraceDirection direction : {TraceDirection::kForward, TraceDirection::kBackward}) {
    ExactWalk one(mesh, 1e-9, direction, kernels[0]), two(mesh, 1e-9, direction, kernels[1]);
    std::size_t pieces = 0;
    for (Vec3& x : seeds) {
      const Vec3 seed = field->frame().local_from_data(field->bounds().center() + x * field->bounds().size());
      ASSERT_EQ(one.start(seed), two.start(seed));
      for (int step = 0; step < 300; ++step) {
        const std::optional<End> end = one.advance();
        ASSERT_EQ(end, two.advance());
        if (!one.has_piece()) break;
        const LinePoint &p = one.end(), &q = two.end();
        ASSERT_EQ(std::memcmp(&p, &q, sizeof(LinePoint)), 0) << kernels[1].name << " step " << step;
        ++pieces;
        if (end) break;
      }
    }
    EXPECT_GT(pieces, 1000u);
  }
}

}  // namespace
}  // namespace palpate
