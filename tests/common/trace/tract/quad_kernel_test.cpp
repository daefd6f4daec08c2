// Four lanes beside one: every kernel must give the bits of the plain functions, whatever its neighbours do.

#include "common/trace/tract/quad_kernel.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/ode/tableau.h"
#include "common/trace/tract/main_direction.h"
#include "common/trace/tract/trace_tracts.h"
#include "common/trace/tract/tract_walk.h"
#include "tests/common/trace/tract/tensor_images.h"

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; }

Vec3 random_direction(std::mt19937_64& random) {
  const double x = unit(random), y = unit(random), z = unit(random);
  return glm::normalize(Vec3{x, y, z});
}

/// Of every kind: prolate, oblate, with negative eigenvalues, isotropic, zero, not a number.
Tensor6 random_tensor(std::mt19937_64& random) {
  const std::uint64_t kind = random() % 12;
  if (kind == 0) return {};
  if (kind == 1) return {.xx = 0.3, .yy = 0.3, .zz = 0.3};
  if (kind == 2) return {.xx = std::nan(""), .yy = 0.3, .zz = 0.3};
  const Vec3 a = random_direction(random), b = random_direction(random);
  const double first = unit(random), second = kind < 4 ? 0.5 * first : 0.1 * unit(random);
  const Mat3 d = Mat3{0.2} + first * glm::outerProduct(a, a) + second * glm::outerProduct(b, b);
  return {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]};
}

void set(Tensors4& d, std::size_t i, const Tensor6& t) {
  d.xx[i] = t.xx;
  d.xy[i] = t.xy;
  d.xz[i] = t.xz;
  d.yy[i] = t.yy;
  d.yz[i] = t.yz;
  d.zz[i] = t.zz;
}
void set(Vectors4& v, std::size_t i, const Vec3& x) {
  v.x[i] = x.x;
  v.y[i] = x.y;
  v.z[i] = x.z;
}
Vec3 get(const Vectors4& v, std::size_t i) { return {v.x[i], v.y[i], v.z[i]}; }

TEST(QuadKernel, DirectionsAndCutOffsAreThoseOfOneTensor) {
  std::mt19937_64 random{11};
  std::size_t certified_lanes = 0, positive_lanes = 0;
  for (int n = 0; n < 5000; ++n) {
    Tensors4 tensors;
    Vectors4 toward;
    std::array<Tensor6, 4> each;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      each[lane] = random_tensor(random);
      set(tensors, lane, each[lane]);
      const Vec3 main = symmetric_eigen(each[lane].matrix()).vectors[0];
      const Vec3 near = main + 0.2 * random_direction(random);
      set(toward, lane,
          random() % 4 == 0 || !is_finite(near) ? random_direction(random) : glm::normalize(near));
    }
    const unsigned wanted = 1U + random() % 15;
    for (const QuadKernel& kernel : quad_kernels()) {
      Vectors4 found;
      const unsigned certified = kernel.directions(tensors, toward, wanted, found);
      EXPECT_EQ(certified & ~wanted, 0U);
      unsigned above = 0;
      const unsigned positive = kernel.positive(tensors, 0.4, above);
      for (unsigned lane = 0; lane < 4; ++lane) {
        if ((certified & 1U << lane) != 0) {
          ASSERT_EQ(get(found, lane), main_direction(each[lane], get(toward, lane))) << kernel.name;
          ++certified_lanes;
        }
        if ((positive & 1U << lane) != 0) {
          ASSERT_EQ((above & 1U << lane) != 0, reaches(TractMeasure::kFa, each[lane], 0.4)) << kernel.name;
          ++positive_lanes;
        }
      }
      EXPECT_EQ(above & ~positive, 0U);
    }
  }
  EXPECT_GT(certified_lanes, 10'000U);
  EXPECT_GT(positive_lanes, 10'000U);
}

template <typename T>
void expect_the_same_samples(unsigned (*QuadKernel::*sample)(const TensorGrid<T>&, const Vectors4&,
                                                             Tensors4&) noexcept) {
  const Vec3 a = glm::normalize(Vec3{2.0, 1.0, 0.5}), b = glm::normalize(glm::cross(a, Vec3{0.0, 0.3, 1.0}));
  for (const Mat3& axes : {Mat3{1.0}, Mat3{a, b, glm::cross(a, b)}}) {
    const UniformTopology topology{{5, 4, 6}, Vec3{-1.0, 0.5, 2.0}, axes};
    const auto field = test::tensor_field<T>(topology, [](const Vec3& x) {
      const bool hole = std::fmod(std::floor(x.x + 2.0 * x.y + 3.0 * x.z), 9.0) == 1.0;
      return hole ? Mat3{std::nan("")} : test::tensor_along({1.0 + x.x, x.y, 0.5 + x.z});
    });
    const UniformTensors<T> one(*field, std::get<std::span<const T>>(field->values()));
    const double to_s = power_of_two(-field->frame().length_exponent);
    std::mt19937_64 random{12};
    std::size_t sampled = 0;
    for (int n = 0; n < 3000; ++n) {
      Vectors4 at;
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const Vec3 u{2.0 + 2.5 * unit(random), 1.5 + 2.0 * unit(random), 2.5 + 3.0 * unit(random)};
        set(at, lane, (topology.origin + axes * u) * to_s);
      }
      if (n == 0) set(at, 1, Vec3{std::nan("")});
      for (const QuadKernel& kernel : quad_kernels()) {
        Tensors4 found;
        const unsigned ok = (kernel.*sample)(one.grid(), at, found);
        for (unsigned lane = 0; lane < 4; ++lane) {
          Tensor6 expected;
          const SampleStatus status = one.sample(get(at, lane), expected);
          if ((ok & 1U << lane) == 0) continue;
          ++sampled;
          ASSERT_EQ(status, SampleStatus::kOk);
          ASSERT_EQ(found.xx[lane], expected.xx) << kernel.name;
          ASSERT_EQ(found.xy[lane], expected.xy);
          ASSERT_EQ(found.xz[lane], expected.xz);
          ASSERT_EQ(found.yy[lane], expected.yy);
          ASSERT_EQ(found.yz[lane], expected.yz);
          ASSERT_EQ(found.zz[lane], expected.zz);
        }
      }
    }
    EXPECT_GT(sampled, 1000U);
  }
}

TEST(QuadKernel, SamplesAreThoseOfOnePlace) {
  expect_the_same_samples<float>(&QuadKernel::sample_float);
  expect_the_same_samples<double>(&QuadKernel::sample_double);
}

/// The way from a seed that starts along `toward`, by one walk after another.
template <class Tableau>
std::vector<Vec3f> walked(const TensorField& field, const Vec3& seed, const Vec3& toward, double step,
                          double max_length) {
  const double to_s = power_of_two(-field.frame().length_exponent), to_data = 1.0 / to_s;
  TractWalk<AnyTensors, Tableau> walk(AnyTensors(field), step * to_s, 1e-4);
  TractState now;
  now.position = seed * to_s;
  EXPECT_EQ(walk.sample(now.position, toward, now.tensor), SampleStatus::kOk);
  now.direction = symmetric_eigen(now.tensor.matrix()).vectors[0];
  if (glm::dot(now.direction, toward) < 0.0) now.direction = -now.direction;
  walk.start(now);
  std::vector<Vec3f> points;
  for (int n = 1; n * step <= max_length; ++n) {
    if (walk.advance_to(n * step * to_s, now) != SampleStatus::kOk) break;
    points.emplace_back(now.position * to_data);
  }
  return points;
}

template <class Tableau>
void expect_the_walked_line(Integrator integrator) {
  const test::Helices helices{10.0};
  const UniformTopology image{{27, 27, 37}, Vec3{-13.0, -13.0, -18.0}, Mat3{1.0}};
  const auto field =
      test::tensor_field(image, [&](const Vec3& x) { return test::tensor_along(helices.direction(x)); });
  TractOptions options;
  options.integrator = integrator;
  options.step = 0.5;
  options.max_length = 20.0;
  options.threads = 1;
  std::vector<Vec3> seeds;
  seeds.reserve(9);
  for (int n = 0; n < 9; ++n) seeds.push_back(helices.at(5.0 + 0.6 * n, -1.0, 0.3 * n));
  const TractResult result = trace_tracts(*field, seeds, options);
  ASSERT_EQ(result.lines.line_count(), seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    ASSERT_EQ(result.seeds[i], i);
    const auto line = result.lines.line(i);
    const auto expected =
        walked<Tableau>(*field, seeds[i], Vec3{line[1] - line[0]}, options.step, options.max_length);
    ASSERT_EQ(line.front(), Vec3f{seeds[i]});  // the way forward takes the whole length
    ASSERT_EQ(line.size(), expected.size() + 1);
    for (std::size_t p = 0; p < expected.size(); ++p) {
      ASSERT_LT(glm::distance(Vec3{line[p + 1]}, Vec3{expected[p]}), 1e-5) << i << " " << p;
    }
  }
  EXPECT_EQ(result.end_counts[static_cast<std::size_t>(End::kMaxLength)], 2 * seeds.size());
}

TEST(QuadTracer, FollowsTheLinesOfOneWalkAfterAnother) {
  expect_the_walked_line<Euler>(Integrator::kEuler);
  expect_the_walked_line<Rk4>(Integrator::kRk4);
  expect_the_walked_line<Dp54>(Integrator::kDp54);
}

TEST(QuadTracer, ALineDoesNotDependOnItsNeighbours) {
  const test::Helices helices{10.0};
  const UniformTopology image{{27, 27, 37}, Vec3{-13.0, -13.0, -18.0}, Mat3{1.0}};
  const auto field = test::tensor_field(image, [&](const Vec3& x) {
    return std::hypot(x.x, x.y) < 10.0 ? test::tensor_along(helices.direction(x)) : Mat3{0.9};
  });
  std::mt19937_64 random{13};
  std::vector<Vec3> seeds;
  seeds.reserve(60);
  for (int n = 0; n < 60; ++n) {
    seeds.emplace_back(14.0 * unit(random), 14.0 * unit(random), 19.0 * unit(random));
  }
  for (const Integrator integrator : {Integrator::kEuler, Integrator::kDp54}) {
    TractOptions options;
    options.integrator = integrator;
    const TractResult together = trace_tracts(*field, seeds, options);
    ASSERT_GT(together.lines.line_count(), 20U);
    ASSERT_LT(together.lines.line_count(), 60U);
    for (std::size_t l = 0; l < together.lines.line_count(); ++l) {
      const TractResult alone = trace_tracts(*field, std::span(&seeds[together.seeds[l]], 1), options);
      const auto line = together.lines.line(l);
      ASSERT_EQ(alone.lines.points, std::vector<Vec3f>(line.begin(), line.end()));
      ASSERT_EQ(alone.ends[0], together.ends[l]);
    }
  }
}

}  // namespace
}  // namespace palpate
