// The error-against-time model of a frame budget.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "common/render/budget/quality_errors.h"
#include "common/render/budget/quality_times.h"

namespace palpate {
namespace {

TEST(QualityErrors, AddAsThoseOfIndependentCauses) {
  QualityErrors errors;
  errors.asked = {0.01, 0.02};
  errors.context[1] = {0.03, 0.04};
  errors.focus[0] = {0.05, 0.06};
  errors.viewport[0] = {0.07, 0.08};
  errors.resolution[2] = {0.09, 0.10};
  errors.focus_share = 0.25;
  const FrameQuality all{.context = 0.25, .focus = 0.5, .viewport = 0.5, .resolution = 0.5};
  const double focus = 0.0001 + 0.0009 + 0.0025 + 0.0049 + 0.0081;
  const double context = 0.0004 + 0.0016 + 0.0036 + 0.0064 + 0.01;
  EXPECT_NEAR(errors.of(all).focus, std::sqrt(focus), 1e-15);
  EXPECT_NEAR(errors.of(all).context, std::sqrt(context), 1e-15);
  EXPECT_NEAR(errors.rms(all), std::sqrt(0.25 * focus + 0.75 * context), 1e-15);
  EXPECT_EQ(errors.of({}).focus, 0.01);
  EXPECT_EQ(errors.of({.viewport = 0.25}).context, 0.02) << "another share";
}

TEST(QualityErrors, UsualOnesGrowAsMoreIsGivenUp) {
  const QualityErrors& usual = usual_errors();
  for (const FrameQuality& a : frame_qualities(true, true)) {
    for (const FrameQuality& b : frame_qualities(true, true)) {
      if (a.context < b.context || a.focus < b.focus || a.viewport < b.viewport ||
          a.resolution < b.resolution)
        continue;
      EXPECT_LE(weighed(usual.of(a)), weighed(usual.of(b)));
      EXPECT_LE(usual.rms(a), usual.rms(b));
    }
  }
}

/// A machine that follows (1) of quality_times.h.
double time_of(const FrameQuality& q, const std::array<double, 4>& p) {
  const double pixels = q.resolution * q.resolution;
  return p[0] + pixels * (p[1] + p[2] * q.context * q.viewport * q.viewport + p[3] * q.focus);
}

TEST(QualityTimes, FindWhereTheTimeOfFramesLies) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> log_time(-2.0, 4.0), part(0.02, 1.0), noise(0.98, 1.02);
  const std::vector<FrameQuality> all = frame_qualities(true, true);
  std::uniform_int_distribution<std::size_t> which(0, all.size() - 1);
  for (int i = 0; i < 50; ++i) {
    const double scale = std::pow(10.0, log_time(random));
    const std::array<double, 4> p{scale * part(random), scale * part(random), scale * part(random),
                                  scale * part(random)};
    QualityTimes times(true, true);
    EXPECT_FALSE(times.known());
    for (std::size_t k = 0; k < 4 * QualityTimes::kChanges; ++k) {
      const FrameQuality& quality = all[which(random)];
      times.add(quality, time_of(quality, p) * noise(random));
    }
    EXPECT_TRUE(times.known());
    for (const FrameQuality& quality : all)
      EXPECT_NEAR(times.of(quality), time_of(quality, p), 0.25 * time_of(quality, p)) << i;
  }
}

// Frames of one quality tell how fast the machine is, not where its time goes.
TEST(QualityTimes, OfOneQualityScaleTheUsualOnes) {
  for (const double t : {1e-6, 30.0, 1e9}) {
    QualityTimes usual(true, true), times(true, true);
    const FrameQuality quality{.context = 0.5, .resolution = 0.7};
    for (int k = 0; k < 40; ++k) times.add(quality, t);
    for (const FrameQuality& other : frame_qualities(true, true)) {
      EXPECT_NEAR(times.of(other), t * usual.of(other) / usual.of(quality), 1e-6 * times.of(other)) << t;
    }
  }
}

// Of lines alone segments go before pixels, and no less than half of these.
TEST(QualityErrors, OfLinesSegmentsGoBeforePixels) {
  const QualityErrors& usual = usual_errors();
  double least = 1.0;
  for (const FrameQuality& q : frame_qualities(false, false)) {
    EXPECT_GE(q.resolution, kLeastOfLines);
    least = std::min(least, q.detail);
    if (q.resolution == 1.0) continue;
    EXPECT_GT(usual.rms(q), usual.rms({.detail = kDetailShares.back()}));
  }
  EXPECT_EQ(least, kDetailShares.back());
  for (const FrameQuality& q : frame_qualities(true, true)) EXPECT_EQ(q.detail, 1.0);
}

TEST(QualityTimes, FindWhetherLinesTakeSegmentsOrPixels) {
  const auto time = [](const FrameQuality& q, double pixels, double segments) {
    return 5.0 + pixels * q.resolution * q.resolution + segments * q.detail;
  };
  for (const auto& [pixels, segments] : {std::pair(200.0, 10.0), std::pair(10.0, 200.0)}) {
    QualityTimes times;
    for (int k = 0; k < 16; ++k) {
      const FrameQuality q{.resolution = k % 2 == 0 ? 1.0 : 0.5, .detail = k / 2 % 2 == 0 ? 1.0 : 0.25};
      times.add(q, time(q, pixels, segments));
    }
    for (const FrameQuality& q : {FrameQuality{.resolution = 0.5}, FrameQuality{.detail = 0.25}})
      EXPECT_NEAR(times.of(q), time(q, pixels, segments), 0.25 * time(q, pixels, segments));
  }
}

// Later frames have more weight, whatever came before; less quality never takes more.
TEST(QualityTimes, FollowTheSceneAndStayInOrder) {
  QualityTimes times(true, false);
  for (int k = 0; k < 40; ++k) times.add({}, 500.0);
  for (int k = 0; k < 24; ++k) times.add({.context = 0.5}, 20.0);
  EXPECT_NEAR(times.of({.context = 0.5}), 20.0, 1e-6);
  for (const FrameQuality& a : frame_qualities(true, false)) {
    for (const FrameQuality& b : frame_qualities(true, false)) {
      if (a.context <= b.context && a.resolution <= b.resolution) {
        EXPECT_LE(times.of(a), times.of(b));
      }
      EXPECT_GT(times.of(a), 0.0);
    }
  }
}

}  // namespace
}  // namespace palpate
