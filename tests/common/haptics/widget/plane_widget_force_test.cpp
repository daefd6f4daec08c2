// What the hand feels where the cutting-plane widget goes from one state to another: from one step to the
// next the force changes by no more than the probe's own way asks for, twice the stiffness times that, and
// 0.02 N, which is 200 N/s, the smallest slew limit of the devices, at 10 kHz. No safety stage is in between.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "common/device/device_profile.h"
#include "common/haptics/frame_along.h"
#include "common/haptics/widget/widget_text.h"
#include "tests/common/haptics/widget/widget_bench.h"

namespace palpate::test {
namespace {

constexpr double kMostStep = 0.02;    // [N]
constexpr double kFastest = 1.5e-3;   // [m] a step of the fastest hand that gets a force, at 1 kHz
constexpr double kFastestRate = 1e4;  // [Hz]
constexpr double kRounding = 1e-12;   // [N]

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(Vec3{normal(random), normal(random), normal(random)});
}

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>{low, high}(random);
}

/// From 10 nm to 1.5 mm a step: slow hands show what fast ones hide in what springs may do.
double any_speed(std::mt19937& random) { return kFastest * std::exp(between(random, -12.0, 0.0)); }

/// One to four planes anywhere about the origin, and a widget of any size.
ChainSettings any_settings(std::mt19937& random, int edit) {
  ChainSettings settings;
  settings.stiffness = std::exp(between(random, std::log(50.0), std::log(2000.0)));
  PlaneWidgetSettings& widget = settings.plane_widget;
  widget.radius = between(random, 0.01, 0.04);
  widget.reach = between(random, 0.002, 0.05);  // that of some is more than their radius
  widget.detent = between(random, 0.0, 1.0) < 0.3 ? 0.0 : between(random, 1.0, 90.0);
  widget.poses.count = 1 + static_cast<int>(random() % PlanePoses::kMax);
  for (int i = 0; i < widget.poses.count; ++i) {
    const Vec3 normal = direction(random), near = 0.03 * direction(random);
    widget.poses.pose[static_cast<std::size_t>(i)] =
        pose_of_plane(normal, between(random, -0.02, 0.02), near);
  }
  widget.edit = edit;
  return settings;
}

TEST(PlaneWidgetForce, TheBoundIsTheSmallestSlewLimitOfTheDevices) {
  double smallest = DeviceLimits{}.slew_cap;
  for (const DeviceProfile& profile : device_profiles())
    smallest = std::min(smallest, safe_limits(profile).slew_cap);
  EXPECT_GE(smallest, kMostStep * kFastestRate);
}

/// A hand goes from place to place, slowly and in leaps, presses and lets go at any moment, is lost and comes
/// back, while planes are put elsewhere and settings are edited.
TEST(PlaneWidgetForce, NoTransitionJumps) {
  constexpr int kRuns = 40, kSteps = 15'000;
  std::array<int, kWidgetTransitions.size()> seen{};
  double steepest = 0.0;  // part of the bound
  for (unsigned run = 0; run < kRuns; ++run) {
    std::mt19937 random{run};
    ChainSettings settings = any_settings(random, 1);
    Bench bench(settings, frame_along(direction(random)));
    const bool edits = run % 2 == 1;
    Vec3 hand{0.05}, goal{0.0}, before{0.0};
    double speed = any_speed(random);
    bool down = false;
    for (int n = 0; n < kSteps; ++n) {
      const WidgetState state = bench.widget().state();
      bool lost = false;
      // A twentieth of all steps is some event while the hand stands still.
      const unsigned event = random() % 400U;
      if (event < 14) down = !down;
      if (event == 14 || event == 15) {
        bench.chain().reset();
        ASSERT_EQ(bench.widget().state(), WidgetState::kFree);
        before = Vec3{0.0};  // nobody is there who would feel it
        lost = true;
      }
      if (edits && event >= 16 && event < 20) {
        settings = any_settings(random, settings.plane_widget.edit + (event < 18 ? 1 : 0));
        bench.chain().apply(settings);
      }
      Vec3 step{0.0};
      if (event >= 20) {
        const Vec3 way = goal - hand;
        const double left = glm::length(way);
        step = left > speed ? (speed / left) * way : way;
        if (left <= speed || event == 20) {
          goal = 0.045 * between(random, 0.0, 1.0) * direction(random);
          speed = any_speed(random);
        }
      }
      hand += step;
      const ChainStep result = bench.at(hand, down);
      const WidgetState now = bench.widget().state();
      for (std::size_t t = 0; t < kWidgetTransitions.size(); ++t) {
        const WidgetTransition& each = kWidgetTransitions[t];
        const bool this_one = lost ? each.event == WidgetEvent::kLost : each.to == now;
        if (each.from == state && this_one) ++seen[t];
      }
      const double springs = 2.0 * settings.stiffness * glm::length(step);
      const double change = glm::distance(result.force, before);
      ASSERT_LE(change, kMostStep + springs + kRounding)
          << "run " << run << ", step " << n << ", event " << event << ", " << name_of(state) << " to "
          << name_of(now) << ", " << 1e3 * glm::length(step) << " mm at " << settings.stiffness << " N/m";
      steepest = std::max(steepest, change / (kMostStep + springs));
      before = result.force;
    }
  }
  for (std::size_t t = 0; t < seen.size(); ++t) {
    EXPECT_GT(seen[t], 0) << name_of(kWidgetTransitions[t].from) << " to "
                          << name_of(kWidgetTransitions[t].to) << " by "
                          << name_of(kWidgetTransitions[t].event);
  }
  EXPECT_GT(steepest, 0.5) << "nothing was asked of the widget";
}

}  // namespace
}  // namespace palpate::test
