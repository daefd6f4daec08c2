// Figure 6.3 and its kin, worked by hand: one axis, the hand out and back, proxy and force at each step.
//
// k = 100 N/m and tau = 2 mm throughout, so that a stretch of 1 mm is 0.1 N. The force on the hand is
// F = kappa k (p - x) (eq. 6.9, in the sense in which it pulls the probe to its proxy).

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/constraint/linear.h"
#include "common/haptics/proxy_chain.h"

namespace palpate {
namespace {

struct Moment {
  double probe;  ///< [mm]
  double proxy;  ///< [mm]
  double force;  ///< [N]
};

/// Runs one axis of a linear constraint through a chain; the others are free.
void expect_profile(AxisRule rule, const HapticTransferFunction& kappa, const std::vector<Moment>& profile) {
  ChainSettings settings;
  settings.stiffness = 100.0;
  settings.linear.axes[1] = {.rule = rule, .kappa = kappa, .tau = 0.002};
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<LinearConstraint>(std::make_unique<FixedFrame>(Mat3{1.0})));
  ProxyChain chain(std::move(links), settings);
  for (std::size_t n = 0; n < profile.size(); ++n) {
    const ChainStep step = chain.step({0.5, 1e-3 * profile[n].probe, -0.25});
    EXPECT_NEAR(1e3 * step.proxies[0].y, profile[n].proxy, 1e-9) << "step " << n;
    EXPECT_NEAR(step.force.y, profile[n].force, 1e-9) << "step " << n;
    EXPECT_NEAR(step.force.x, 0.0, 1e-9) << "the other axes are free";
    EXPECT_NEAR(step.force.z, 0.0, 1e-9);
  }
}

// Figure 6.3 (a). Outward is up. Free above; down to 2 mm below the proxy it resists, 0.1 N a millimetre;
// then it drags at 0.2 N, the same however far; on the way up it is free as soon as the probe has passed it.
TEST(ForceProfile, UnilateralDrag) {
  expect_profile(AxisRule::kUnilateral, 1.0,
                 {{3, 3, 0.0},     // caught
                  {1.5, 3, 0.15},  // dx = -1.5: within tau, stays, pushed out
                  {1, 3, 0.2},     // dx = -2: at the threshold
                  {0, 2, 0.2},     // dx = -3: moves by dx + tau = -1
                  {-2, 0, 0.2},    //
                  {-4, -2, 0.2},   //
                  {-3, -2, 0.1},   // dx = -1
                  {-2, -2, 0.0},   //
                  {-1, -1, 0.0},   // dx = 1 > 0: moves by dx
                  {2, 2, 0.0},     //
                  {1, 2, 0.1}});
}

// Figure 6.3 (b). Nothing moves up to 2 mm of stretch, 0.2 N; beyond, the proxy snaps by 2 mm, and the force
// with it: from 0.2 N against the motion to almost nothing.
TEST(ForceProfile, SnapDrag) {
  expect_profile(AxisRule::kSnap, 1.0,
                 {{0, 0, 0.0},
                  {1, 0, -0.1},
                  {2, 0, -0.2},     // not farther than tau
                  {2.5, 2, -0.05},  // dx = 2.5 > tau: moves by tau
                  {4, 2, -0.2},     //
                  {4.5, 4, -0.05},  //
                  {3, 4, 0.1},      // on the way back the force changes its sign,
                  {2, 4, 0.2},      //
                  {1.5, 2, 0.05},   // and snaps the other way: hysteresis of 2 tau
                  {-0.5, 0, 0.05},  //
                  {7, 6, -0.1}});   // dx = 7 at once: three detents, to within tau
}

// Eq. 6.5. Resists up to 0.2 N, both ways, and drags there.
TEST(ForceProfile, Drag) {
  expect_profile(AxisRule::kDrag, 1.0,
                 {{0, 0, 0.0},
                  {1, 0, -0.1},
                  {2, 0, -0.2},
                  {3, 1, -0.2},  // dx = 3: moves by dx - tau = 1
                  {6, 4, -0.2},  //
                  {5, 4, -0.1},  //
                  {3, 4, 0.1},   // plastic: it is pushed back from where it was left
                  {1, 3, 0.2},   //
                  {-2, 0, 0.2}});
}

// Eq. 6.9: half the stiffness gives half the force, and the same motion.
TEST(ForceProfile, DragAtHalfTheStiffness) {
  expect_profile(AxisRule::kDrag, 0.5,
                 {{0, 0, 0.0}, {1, 0, -0.05}, {3, 1, -0.1}, {6, 4, -0.1}, {3, 4, 0.05}});
}

// Eq. 6.6, and a threshold that no hand reaches.
TEST(ForceProfile, FreeAndFixed) {
  expect_profile(AxisRule::kFree, 1.0, {{0, 0, 0.0}, {5, 5, 0.0}, {-20, -20, 0.0}});
  expect_profile(AxisRule::kFixed, 1.0, {{0, 0, 0.0}, {5, 0, -0.5}, {-20, 0, 2.0}, {0, 0, 0.0}});
}

// Figure 6.4: at a quarter of the stiffness the hand feels a copy of the proxy that has come three quarters
// of the way to it, while the proxy itself stays.
TEST(ForceProfile, FlexibleConstraint) {
  expect_profile(AxisRule::kFixed, 0.25, {{0, 0, 0.0}, {4, 0, -0.1}, {8, 0, -0.2}, {-4, 0, 0.1}});
}

}  // namespace
}  // namespace palpate
