// Tracts beside curves that are known, orders of convergence, and what must not change them.

#include "common/trace/tract/trace_tracts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/trace/tract/tensor_source.h"
#include "common/trace/tract/tract_errors.h"
#include "tests/common/trace/tract/tensor_images.h"

namespace palpate {
namespace {

using test::Helices;
using test::tensor_along;
using test::tensor_field;

constexpr double kRadius = 8.0, kPitch = 10.0;

/// Voxels of one about the helix, in axes of unit length and angle `shear`.
UniformTopology around_helix(const Mat3& axes) {
  const Index3 points{27, 27, 37};
  return {points, -(axes * Vec3{13.0, 13.0, 18.0}), axes};
}

Mat3 turned() {
  const Vec3 a = glm::normalize(Vec3{2.0, 1.0, 0.5}), b = glm::normalize(glm::cross(a, Vec3{0.0, 0.3, 1.0}));
  return {a, b, glm::cross(a, b)};
}

/// Largest distance of points from the helix through (kRadius, 0, 0), each at its own height.
double distance_from_helix(const Tractogram& lines) {
  double most = 0.0;
  for (const Vec3f& point : lines.points) {
    const Vec3 x{point};
    // The closest point lies near the height of this one: a search is enough.
    double least = HUGE_VAL;
    for (int n = -400; n <= 400; ++n) {
      const Vec3 on = Helices{kPitch}.at(kRadius, 0.0, x.z + 0.002 * n * kPitch / 4.0);
      least = std::min(least, glm::distance(x, on));
    }
    most = std::max(most, least);
  }
  return most;
}

TEST(TraceTracts, FollowsTheHelixInPlainTurnedAndShearedImages) {
  const Helices helices{kPitch};
  // Two turns: the seed lies in the middle.
  const double length = 2.0 * std::hypot(2.0 * M_PI * kRadius, kPitch);
  const Mat3 sheared{Vec3{1.0, 0.0, 0.0}, Vec3{0.35, 0.95, 0.0}, Vec3{0.0, -0.2, 1.0}};
  const Mat3 left_handed{Vec3{-1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}};
  for (const Mat3& axes : {Mat3{1.0}, turned(), left_handed, sheared}) {
    UniformTopology image = around_helix(axes);
    if (axes == sheared || axes == turned()) {  // the corners must hold the helix still
      image.points = {41, 41, 49};
      image.origin = -(axes * Vec3{20.0, 20.0, 24.0});
    }
    const auto field = tensor_field(image, [&](const Vec3& x) { return tensor_along(helices.direction(x)); });
    const std::vector<Vec3> seeds{helices.at(kRadius, 0.0, 0.0)};
    for (const Integrator integrator : {Integrator::kDp54, Integrator::kRk4}) {
      TractOptions options;
      options.integrator = integrator;
      options.max_length = length / 2.0;
      const TractResult up = trace_tracts(*field, seeds, options);
      ASSERT_EQ(up.lines.line_count(), 1U);
      // One way uses the whole length up; both ways together make two turns.
      const auto line = up.lines.line(0);
      const double climbed = std::abs(line.back().z - line.front().z);
      EXPECT_NEAR(climbed, kPitch, 0.05 * kPitch);
      EXPECT_LT(distance_from_helix(up.lines), 0.2);
      EXPECT_EQ(up.ends[0][1], End::kMaxLength);
    }
  }
}

/// A single cell: the interpolant is smooth there, and orders show.
std::shared_ptr<const TensorField> one_cell(TensorInterpolation interpolation) {
  const UniformTopology cell{{2, 2, 2}, Vec3{-1.0}, Mat3{2.0}};
  const auto bent = [](const Vec3& x) {
    return tensor_along({1.0, 0.3 + 0.5 * x.x - 0.2 * x.z, 0.2 + 0.3 * x.y * x.x});
  };
  return tensor_field<double>(cell, bent, interpolation);
}

/// The point 1.28 from the seed on.
Vec3 end_point(const TensorField& field, Integrator integrator, double step, double tolerance) {
  TractOptions options;
  options.integrator = integrator;
  options.step = step;
  options.tolerance = tolerance;
  options.max_length = 1.28;
  options.cutoff = 0.05;
  options.max_angle = 80.0;
  const std::vector<Vec3> seeds{{-0.7, -0.3, 0.1}};
  const TractResult result = trace_tracts(field, seeds, options);
  EXPECT_EQ(result.lines.line_count(), 1U);
  EXPECT_EQ(result.ends[0][1], End::kMaxLength);
  return result.lines.points.back();
}

TEST(TraceTracts, ConvergesWithTheOrderOfTheMethod) {
  for (const auto interpolation : {TensorInterpolation::kComponents, TensorInterpolation::kLogEuclidean}) {
    const auto field = one_cell(interpolation);
    const Vec3 exact = end_point(*field, Integrator::kDp54, 0.01, 1e-11);
    const auto error = [&](Integrator integrator, double step) {
      return glm::distance(end_point(*field, integrator, step, 1e-4), exact);
    };
    EXPECT_NEAR(std::log2(error(Integrator::kEuler, 0.04) / error(Integrator::kEuler, 0.02)), 1.0, 0.1);
    // Points are single: 64 times the rounding is the least error that shows an order.
    EXPECT_NEAR(std::log2(error(Integrator::kRk4, 0.64) / error(Integrator::kRk4, 0.32)), 4.0, 0.7);
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
      const double made = glm::distance(end_point(*field, Integrator::kDp54, 0.32, tolerance), exact);
      EXPECT_LT(made, 5.0 * tolerance * 1.28 + 2e-7) << tolerance;
    }
  }
}

// Trilinear images have kinks at the faces of voxels, of which an estimate says a fifteenth.
TEST(TraceTracts, KeepsItsToleranceAndStatesItsErrorAcrossFaces) {
  const Helices helices{kPitch};
  constexpr double kLength = 20.0, kRounding = 4e-6;  // of points: they are single
  for (const auto interpolation : {TensorInterpolation::kComponents, TensorInterpolation::kLogEuclidean}) {
    const auto field = tensor_field(
        around_helix(Mat3{1.0}), [&](const Vec3& x) { return tensor_along(helices.direction(x)); },
        interpolation);
    std::vector<Vec3> seeds;
    for (int n = 0; n < 16; ++n) seeds.push_back(helices.at(6.0 + 0.3 * n, -1.0, 0.3 * n));
    const auto traced = [&](double tolerance) {
      TractOptions options;
      options.integrator = Integrator::kDp54;
      options.step = 0.5;
      options.tolerance = tolerance;
      options.max_length = kLength;
      return trace_tracts(*field, seeds, options);
    };
    const TractResult exact = traced(1e-10);
    ASSERT_EQ(exact.lines.line_count(), seeds.size());
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      const TractResult result = traced(tolerance);
      ASSERT_EQ(result.lines.line_count(), seeds.size());
      for (std::size_t l = 0; l < seeds.size(); ++l) {
        const Vec3f& last = result.lines.line(l).back();
        const double off = glm::distance(Vec3{last}, Vec3{exact.lines.line(l).back()});
        const double stated =
            result.lines.of_points[0].values[static_cast<std::size_t>(&last - result.lines.points.data())];
        EXPECT_LE(off, tolerance * kLength + kRounding) << l << " at " << tolerance;
        EXPECT_LE(off, 6.0 * stated + kRounding)  // lines spread, which the sum does not know
            << l << " at " << tolerance;
      }
    }
  }
}

TEST(TraceTracts, StatesAnErrorOfTheTrueSize) {
  const auto field = one_cell(TensorInterpolation::kComponents);
  const Vec3 exact = end_point(*field, Integrator::kDp54, 0.01, 1e-11);
  for (const double step : {0.16, 0.32}) {
    TractOptions options;
    options.integrator = Integrator::kEuler;
    options.step = step;
    options.max_length = 1.28;
    options.cutoff = 0.05;
    options.max_angle = 80.0;
    const std::vector<Vec3> seeds{{-0.7, -0.3, 0.1}};
    const TractResult result = trace_tracts(*field, seeds, options);
    const double made = glm::distance(Vec3{result.lines.points.back()}, exact);
    const double stated = result.lines.of_points[0].values.back();
    EXPECT_GT(stated, 0.3 * made);
    EXPECT_LT(stated, 4.0 * made);
  }
}

TEST(TractErrors, CountLinesThatKeepTheToleranceAndThoseThatAreNotHeld) {
  TractResult result;
  result.lines.of_points = {{.name = "error", .values = {}}};
  const auto add = [&](float back, float front) {  // a line of 10 to either side of its seed
    for (const float x : {-10.0F, 0.0F, 10.0F}) result.lines.points.emplace_back(x, 0.0F, 0.0F);
    for (const float error : {back, 0.0F, front}) result.lines.of_points[0].values.push_back(error);
    result.lines.starts.push_back(result.lines.points.size());
    result.seeds.push_back(static_cast<std::uint32_t>(7 + result.seeds.size()));
  };
  add(0.5F, 1.0F);
  add(0.5F, 1.5F);
  add(20.0F, 0.0F);
  const LineErrors errors = tract_errors(result, 100.0, 0.1);
  EXPECT_EQ(errors.within, std::optional<std::size_t>(1));
  EXPECT_EQ(errors.held, 2U);
  EXPECT_EQ(errors.unheld_seeds, std::vector<std::uint32_t>{9});
  EXPECT_FLOAT_EQ(static_cast<float>(errors.worst), 1.5F);
  EXPECT_FLOAT_EQ(static_cast<float>(errors.median), 1.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(errors.max), 20.0F);
  EXPECT_EQ(tract_errors(result, 100.0).within, std::nullopt);
}

/// A bundle of helices in noise-free tissue, and seeds all over it.
struct Case {
  std::shared_ptr<const TensorField> field;
  std::vector<Vec3> seeds;
};
Case many_lines(double scale = 1.0) {
  Case made;
  UniformTopology image = around_helix(Mat3{1.0});
  image.origin *= scale;
  image.axes *= scale;
  made.field = tensor_field(image, [&](const Vec3& x) {
    const double r = std::hypot(x.x, x.y) / scale;
    const Vec3 along = Helices{kPitch}.direction(x / scale);
    return scale * (r > 3.0 && r < 11.0 ? tensor_along(along) : Mat3{0.9});
  });
  for (int n = 0; n < 500; ++n) {
    made.seeds.push_back(scale * Vec3{-15.0 + 0.061 * n, 13.0 * std::sin(1.7 * n), 15.0 * std::cos(2.3 * n)});
  }
  return made;
}

TEST(TraceTracts, GivesTheSameLinesForAnyNumberOfThreads) {
  const Case made = many_lines();
  TractOptions options;
  options.threads = 1;
  const TractResult one = trace_tracts(*made.field, made.seeds, options);
  EXPECT_GT(one.lines.line_count(), 100U);
  EXPECT_GT(one.dropped.outside, 0U);
  EXPECT_GT(one.dropped.below_cutoff, 0U);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    const TractResult other = trace_tracts(*made.field, made.seeds, options);
    EXPECT_EQ(one.lines.points, other.lines.points);
    EXPECT_EQ(one.lines.starts, other.lines.starts);
    EXPECT_EQ(one.seeds, other.seeds);
    EXPECT_EQ(one.ends, other.ends);
    EXPECT_EQ(one.lines.of_points[0].values, other.lines.of_points[0].values);
  }
}

TEST(TraceTracts, PowersOfTwoScaleTheLinesAndNothingElse) {
  const Case plain = many_lines();
  const TractResult expected = trace_tracts(*plain.field, plain.seeds, {});
  for (const double scale : {0x1p-30, 0x1p40}) {
    const Case made = many_lines(scale);
    const TractResult found = trace_tracts(*made.field, made.seeds, {});
    ASSERT_EQ(found.lines.starts, expected.lines.starts);
    for (std::size_t i = 0; i < found.lines.points.size(); ++i) {
      ASSERT_EQ(Vec3{found.lines.points[i]}, scale * Vec3{expected.lines.points[i]});
    }
  }
}

TEST(TraceTracts, GoesTheWayAndTheStepsThatItIsTold) {
  const Helices helices{kPitch};
  const UniformTopology uniform = around_helix(Mat3{1.0});
  DataSet image =
      test::tensor_image(uniform, [&](const Vec3& x) { return tensor_along(helices.direction(x)); });
  const auto packed = make_tensor_field(image, {.array = "D"}, "image");
  RectilinearTopology lattice;  // the same, read one line at a time
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < uniform.points[axis]; ++i)
      lattice.coordinates[static_cast<std::size_t>(axis)].push_back(uniform.origin[axis] + i);
  }
  image.topology = lattice;
  const auto single = make_tensor_field(image, {.array = "D"}, "image");
  const std::vector<Vec3> seeds{helices.at(kRadius, 0.0, 0.0), helices.at(kRadius, 0.0, 1.0)};
  for (const auto& field : {packed, single}) {
    TractOptions options;
    options.max_length = 6.0;
    options.step = 0.25;
    options.sense = TractSense::kForward;
    const TractResult forward = trace_tracts(*field, seeds, options);
    options.sense = TractSense::kBackward;
    const TractResult backward = trace_tracts(*field, seeds, options);
    options.sense = TractSense::kBoth;
    options.max_steps = 10;
    const TractResult both = trace_tracts(*field, seeds, options);
    ASSERT_EQ(forward.lines.line_count(), 2U);
    ASSERT_EQ(backward.lines.line_count(), 2U);
    ASSERT_EQ(both.lines.line_count(), 2U);
    for (std::size_t l = 0; l < 2; ++l) {
      const auto up = forward.lines.line(l), down = backward.lines.line(l), short_one = both.lines.line(l);
      ASSERT_EQ(up.size(), 25U);  // 6 / 0.25 steps
      ASSERT_EQ(down.size(), 25U);
      EXPECT_EQ(up.front(), Vec3f{seeds[l]});
      EXPECT_EQ(down.front(), Vec3f{seeds[l]});
      // The helix runs along y there: forward is where its longest part is positive.
      EXPECT_GT(up[4].y, up[0].y);
      EXPECT_LT(down[4].y, down[0].y);
      EXPECT_EQ(forward.ends[l], (std::array{End::kStoppedByRule, End::kMaxLength}));
      EXPECT_EQ(backward.ends[l], (std::array{End::kStoppedByRule, End::kMaxLength}));
      ASSERT_EQ(short_one.size(), 21U);
      EXPECT_EQ(both.ends[l], (std::array{End::kMaxSteps, End::kMaxSteps}));
      for (std::size_t p = 0; p <= 10; ++p) {
        EXPECT_LT(glm::distance(short_one[10 + p], up[p]), 1e-4F);
        EXPECT_LT(glm::distance(short_one[10 - p], down[p]), 1e-4F);
      }
    }
  }
  TractOptions none;
  none.max_steps = 0;
  EXPECT_THROW((void)trace_tracts(*packed, seeds, none), Error);
}

TEST(TraceTracts, BothWaysOfReadingTensorsAgree) {
  // A rectilinear grid at equal steps is the same image, read through TensorField::sample().
  const Case made = many_lines();
  const UniformTopology uniform = around_helix(Mat3{1.0});
  DataSet image = test::tensor_image(uniform, [&](const Vec3& x) {
    CellHint hint;
    return made.field->sample(x, hint).value;
  });
  RectilinearTopology lines;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < uniform.points[axis]; ++i) {
      lines.coordinates[static_cast<std::size_t>(axis)].push_back(uniform.origin[axis] + i);
    }
  }
  image.topology = lines;
  const auto other = make_tensor_field(image, {.array = "D"}, "image");
  TractOptions options;
  options.max_length = 30.0;
  const TractResult a = trace_tracts(*made.field, made.seeds, options);
  const TractResult b = trace_tracts(*other, made.seeds, options);
  ASSERT_EQ(a.lines.starts, b.lines.starts);
  for (std::size_t i = 0; i < a.lines.points.size(); ++i) {
    // Rounding may refuse a step of one that the other takes: both keep the tolerance, and lines spread.
    ASSERT_LT(glm::distance(a.lines.points[i], b.lines.points[i]),
              4.0 * options.tolerance * options.max_length);
  }
}

TEST(TraceTracts, BothWaysOfReadingTensorsAgreeAroundHoles) {
  const UniformTopology topology{{4, 4, 4}, Vec3{0.0}, Mat3{1.0}};
  const auto field = tensor_field(topology, [](const Vec3& x) {
    const bool hole = std::fmod(x.x + 2.0 * x.y + 3.0 * x.z, 4.0) == 1.0;
    return hole ? Mat3{std::nan("")} : tensor_along({1.0 + x.x, x.y, x.z});
  });
  const UniformTensors<float> fast(*field, std::get<std::span<const float>>(field->values()));
  AnyTensors plain(*field);
  const double to_s = power_of_two(-field->frame().length_exponent);
  int missing = 0, there = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vec3 x{std::fmod(0.7548776662 * n, 3.0), std::fmod(0.5698402910 * n, 3.0),
                 std::fmod(0.4387 * n, 3.0)};
    Tensor6 a, b;
    const SampleStatus status = fast.sample(x * to_s, a);
    ASSERT_EQ(status, plain.sample(x * to_s, b));
    ++(status == SampleStatus::kOk ? there : missing);
    if (status != SampleStatus::kOk) continue;
    for (const double difference :
         {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz}) {
      ASSERT_NEAR(difference, 0.0, 1e-14);
    }
  }
  EXPECT_GT(missing, 100);
  EXPECT_GT(there, 1000);
}

TEST(TraceTracts, EndsWhereTheEigenvaluesCross) {
  // Along x where x < 0, along y where x > 0: the main eigenvector jumps by a right angle.
  const UniformTopology image{{21, 21, 5}, Vec3{-10.0, -10.0, -2.0}, Mat3{1.0}};
  const auto field = tensor_field(image, [](const Vec3& x) {
    return Mat3{Vec3{1.0 - 0.05 * x.x, 0.0, 0.0}, Vec3{0.0, 1.0 + 0.05 * x.x, 0.0}, Vec3{0.0, 0.0, 0.2}};
  });
  for (const Integrator integrator : {Integrator::kEuler, Integrator::kRk4, Integrator::kDp54}) {
    TractOptions options;
    options.integrator = integrator;
    options.cutoff = 0.05;
    const std::vector<Vec3> seeds{{-6.0, 0.3, 0.1}};
    const TractResult result = trace_tracts(*field, seeds, options);
    ASSERT_EQ(result.lines.line_count(), 1U);
    EXPECT_EQ(result.ends[0][0], End::kLeftDomain);
    EXPECT_EQ(result.ends[0][1], End::kSharpTurn);
    EXPECT_NEAR(result.lines.points.back().x, 0.0, 0.3);
    // Over the jump controlled steps are the shortest ones: no line turns by more than such a step.
    constexpr double kSpacing = 0.25, kShortest = kSpacing / 64.0;
    for (const Vec3f& x : result.lines.points) EXPECT_NEAR(x.y, 0.3, kShortest);
  }
}

TEST(TraceTracts, ReachesTheBorderAndHolesWhenStepsAreControlled) {
  const UniformTopology image{{11, 5, 5}, Vec3{0.0}, Mat3{1.0}};
  const double nan = std::nan("");
  const auto field = tensor_field(image, [&](const Vec3& x) {
    return x.x > 8.5 ? Mat3{nan} : tensor_along({1.0, 0.0, 0.0});
  });
  const std::vector<Vec3> seeds{{3.1, 2.0, 2.0}, {8.75, 2.0, 2.0}, {3.0, nan, 2.0}, {-1.0, 2.0, 2.0}};
  const TractResult result = trace_tracts(*field, seeds, {});
  ASSERT_EQ(result.lines.line_count(), 1U);
  EXPECT_EQ(result.ends[0], (std::array{End::kLeftDomain, End::kBadData}));
  EXPECT_NEAR(result.lines.points.front().x, 0.0, 0.01);
  // Half way into the first voxel without a tensor.
  EXPECT_NEAR(result.lines.points.back().x, 8.5, 0.01);
  EXPECT_EQ(result.dropped.outside, 2U);
  EXPECT_EQ(result.dropped.bad_data, 1U);
}

// A bundle along x through voxels (y = 4, 8, 12, 16) that hold no direction: nothing starts there, lines end
// before them, and no number is lost on the way.
TEST(TraceTracts, DefinesWhatZeroNegativeIsotropicAndMissingTensorsGive) {
  const UniformTopology image{{21, 21, 5}, Vec3{0.0, 0.0, -2.0}, Mat3{1.0}};
  const auto odd = [](double y) -> Mat3 {
    if (y == 4.0) return Mat3{0.0};
    if (y == 8.0) return Mat3{Vec3{-0.5, 0.0, 0.0}, Vec3{0.0, -0.5, 0.0}, Vec3{0.0, 0.0, -0.5}};
    if (y == 12.0) return Mat3{0.7};
    return Mat3{std::nan("")};
  };
  const auto field = tensor_field(image, [&](const Vec3& x) {
    const bool is_odd = x.x >= 10.0 && x.x <= 12.0 && std::fmod(x.y, 4.0) == 0.0 && x.y > 0.0 && x.y < 20.0;
    return is_odd ? odd(x.y) : tensor_along({1.0, 0.0, 0.0});
  });
  for (const Integrator integrator : {Integrator::kEuler, Integrator::kRk4, Integrator::kDp54}) {
    TractOptions options;
    options.integrator = integrator;
    const std::vector<Vec3> inside{{11.0, 4.0, 0.0}, {11.0, 8.0, 0.0}, {11.0, 12.0, 0.0}, {11.0, 16.0, 0.0}};
    const TractResult none = trace_tracts(*field, inside, options);
    EXPECT_EQ(none.lines.line_count(), 0U);
    EXPECT_EQ(none.dropped.below_cutoff, 3U);
    EXPECT_EQ(none.dropped.bad_data, 1U);

    const std::vector<Vec3> before{{3.0, 4.0, 0.0}, {3.0, 8.0, 0.0}, {3.0, 12.0, 0.0}, {3.0, 16.0, 0.0}};
    const TractResult result = trace_tracts(*field, before, options);
    ASSERT_EQ(result.lines.line_count(), 4U);
    for (std::size_t l = 0; l < 4; ++l) {
      EXPECT_EQ(result.ends[l][1], l == 3 ? End::kBadData : End::kBelowCutoff) << l;
      const auto line = result.lines.line(l);
      EXPECT_GT(line.back().x, 9.0F);
      EXPECT_LT(line.back().x, 10.01F);
      for (const Vec3f& x : line) ASSERT_TRUE(is_finite(Vec3{x}));
    }
  }
}

TEST(TraceTracts, RefusesOptionsThatMakeNoSense) {
  const auto field = one_cell(TensorInterpolation::kComponents);
  const auto refused = [&](auto set) {
    TractOptions options;
    set(options);
    EXPECT_THROW((void)trace_tracts(*field, {}, options), Error);
  };
  refused([](TractOptions& o) { o.step = -1.0; });
  refused([](TractOptions& o) { o.step = 1e-9; });  // a line of too many points
  refused([](TractOptions& o) { o.cutoff = 1.5; });
  refused([](TractOptions& o) { o.max_angle = 120.0; });
  refused([](TractOptions& o) { o.tolerance = 0.0; });
  refused([](TractOptions& o) { o.min_length = 2.0, o.max_length = 1.0; });
  refused([](TractOptions& o) { o.max_length = std::nan(""); });
  EXPECT_EQ(trace_tracts(*field, {}, {}).lines.line_count(), 0U);
}

}  // namespace
}  // namespace palpate
