// Sliders and knobs under the hand: held on their way, caught by detents along it alone, without a leap and
// without work on closed ways.

#include "common/haptics/widget/dial_chain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/haptics/constraint/detent_marks.h"
#include "tests/support/allocation_guard.h"

namespace palpate {
namespace {

constexpr double kStiffness = 400.0;  // [N/m]
const Vec3 kLeft{-0.1, 0.02, 0.03}, kRight{0.1, 0.02, 0.03};
constexpr int kDetents = 11;  // 20 mm apart

Dial slider(int detents) { return {.start = kLeft, .end = kRight, .detents = detents}; }

ChainSettings firm() {
  ChainSettings settings;
  settings.stiffness = kStiffness;
  settings.shape = {.snap_distance = 0.05, .release_distance = 0.1};
  return settings;
}

TEST(DialChain, HoldsASliderOnItsWayAndCatchesAtItsDetents) {
  const auto chain = make_dial_chain(slider(kDetents), firm());
  (void)chain->step(kLeft);
  const test::AllocationGuard guard;
  Vec3 last{0.0};
  double strongest = 0.0;
  constexpr double kStep = 1e-5;
  for (int i = 0; i <= 18000; ++i) {
    const double x = -0.09 + kStep * i;
    const ChainStep step = chain->step({x, 0.025, 0.03});
    // Across: 5 mm from the way. Along: towards the nearest detent, as the notch says, nothing between two.
    const double d = std::remainder(x, 0.02), part = 1.0 - std::pow(d / 0.01, 2);
    ASSERT_NEAR(step.force.x, -kStiffness * part * part * d, 1e-9) << x;
    ASSERT_NEAR(step.force.y, -kStiffness * 0.005, 1e-9);
    ASSERT_NEAR(step.force.z, 0.0, 1e-9);
    if (i > 0) {
      ASSERT_LT(glm::distance(step.force, last), 1.01 * kStiffness * kStep) << "no leap";
    }
    last = step.force;
    strongest = std::max(strongest, std::abs(step.force.x));
  }
  EXPECT_EQ(guard.count(), 0);
  EXPECT_NEAR(strongest, 0.286 * kStiffness * 0.01, 0.01);
}

// Round and round the knob, on and off its way: what the hand gets back is what it gave.
TEST(DialChain, TakesNoWorkOnAClosedWayOfAKnob) {
  const Vec3 center{0.1, -0.2, 0.05}, normal{0.3, 0.2, 0.9};
  const Vec3 n = glm::normalize(normal), u = glm::normalize(glm::cross(n, Vec3(1.0, 0.0, 0.0))),
             t = glm::cross(n, u);
  const Dial knob{.kind = Dial::Kind::kKnob,
                  .start = center + 0.04 * u + 0.01 * n,  // off the plane it is the same knob
                  .end = center,
                  .normal = normal,
                  .detents = 24};
  const auto chain = make_dial_chain(knob, firm());
  double work = 0.0, given = 0.0;
  Vec3 before{0.0};
  constexpr int kSteps = 40000;
  const auto way = [&](int i) {
    const double s = 2.0 * std::numbers::pi * i / kSteps;
    return center + (0.045 + 0.01 * std::sin(3.0 * s)) * (std::cos(2.0 * s) * u + std::sin(2.0 * s) * t) +
           0.01 * std::sin(s) * n;
  };
  (void)chain->step(way(0));
  Vec3 force = chain->step(way(0)).force;
  for (int i = 1; i <= kSteps; ++i) {
    before = force;
    force = chain->step(way(i)).force;
    const double step = glm::dot(0.5 * (force + before), way(i) - way(i - 1));
    work += step;
    given += std::abs(step);
  }
  EXPECT_GT(given, 1e-3);
  EXPECT_LT(std::abs(work), 1e-4 * given);
}

TEST(DialChain, ComesBackFromItsWordsToTheBitAndRefusesOthers) {
  Dial knob{.kind = Dial::Kind::kKnob,
            .start = {0.1 / 3.0, 0.2, 0.3},
            .end = {1e-30, -0.2, 0.7},
            .normal = {0.3, 1.0 / 7.0, 0.9},
            .detents = 24};
  for (const Dial& dial : {knob, slider(11), slider(0)}) {
    Dial read;
    ASSERT_EQ(read_text(text_of(dial), read), std::nullopt);
    if (dial.kind == Dial::Kind::kSlider) read.normal = dial.normal;
    EXPECT_EQ(read, dial);
    EXPECT_TRUE(names_dial(text_of(dial)));
  }
  EXPECT_FALSE(names_dial("isosurface"));
  for (const char* wrong :
       {"slider:1,2,3,4,5,6", "slider:1,2,3,1,2,3,4", "slider:1,2,3,4,5,nan,4", "slider:1,2,3,4,5,6,129",
        "slider:1,2,3,4,5,6,1.5", "knob:0,0,0,0,0,1,0,0,2,8", "knob:0,0,0,0,0,1,1,0,0,8,9", "wheel:1"}) {
    Dial read;
    EXPECT_TRUE(read_text(wrong, read)) << wrong;
  }
}

TEST(DialChain, IsSmoothWithoutDetents) {
  const auto chain = make_dial_chain(slider(0), firm());
  (void)chain->step({0.0, 0.02, 0.03});
  EXPECT_EQ(chain->size(), 1);
  EXPECT_LT(glm::length(chain->step({0.013, 0.02, 0.03}).force), 1e-12);
  EXPECT_THROW((void)make_dial_chain(slider(1000), firm()), std::length_error);
  EXPECT_THROW(DetentMarks({}, 1.0), std::length_error);
}

}  // namespace
}  // namespace palpate
