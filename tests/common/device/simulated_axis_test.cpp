#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "common/device/simulated_arm.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]

AxisState after(const AxisLoad& load, double force, double rest, double dt, int ticks, AxisState state) {
  for (int n = 0; n < ticks; ++n) (void)advance_axis(load, force, rest, dt, state);
  return state;
}

// The textbook solutions in sines, exponentials and polynomials, which the series knows nothing of.
TEST(SimulatedAxis, FollowsTheClosedSolutions) {
  const AxisState start{0.002, -0.3};
  constexpr double kForce = 1.5, kRest = -0.001, kTime = 0.1;
  {
    const AxisLoad load{.mass = 0.2, .damping = 3.0, .stiffness = 700.0};  // underdamped
    const double s = load.damping / (2.0 * load.mass), w = std::sqrt(load.stiffness / load.mass - s * s);
    const double end = kRest + kForce / load.stiffness, y = start.position - end;
    const double b = (start.velocity + s * y) / w;
    const AxisState x = after(load, kForce, kRest, kTick, 100, start);
    EXPECT_NEAR(x.position, end + std::exp(-s * kTime) * (y * std::cos(w * kTime) + b * std::sin(w * kTime)),
                1e-15);
  }
  {
    const AxisLoad load{.mass = 0.05, .damping = 40.0, .stiffness = 700.0};  // overdamped
    const double s = load.damping / (2.0 * load.mass), w = std::sqrt(s * s - load.stiffness / load.mass);
    const double end = kRest + kForce / load.stiffness, y = start.position - end;
    const double slow = w - s, fast = -w - s;
    const double a = (start.velocity - fast * y) / (slow - fast);
    const AxisState x = after(load, kForce, kRest, kTick, 100, start);
    EXPECT_NEAR(x.position, end + a * std::exp(slow * kTime) + (y - a) * std::exp(fast * kTime), 1e-15);
  }
  {
    const AxisLoad load{.mass = 0.1, .damping = 2.0};  // no spring
    const double end = kForce / load.damping, tau = load.mass / load.damping;
    const AxisState x = after(load, kForce, kRest, kTick, 100, start);
    const double decay = std::exp(-kTime / tau);
    EXPECT_NEAR(x.velocity, end + (start.velocity - end) * decay, 1e-13);
    EXPECT_NEAR(x.position, start.position + end * kTime + (start.velocity - end) * tau * (1.0 - decay),
                1e-14);
  }
  {
    const AxisLoad load{.mass = 0.1};  // neither
    const AxisState x = after(load, kForce, kRest, kTick, 100, start);
    EXPECT_NEAR(x.position,
                start.position + start.velocity * kTime + 0.5 * kForce / load.mass * kTime * kTime, 1e-15);
  }
}

// No step size: cutting the time otherwise gives the same motion, whatever the times of the mass are.
TEST(SimulatedAxis, DoesNotDependOnHowTheTimeIsCut) {
  for (const AxisLoad& load : {AxisLoad{0.1, 2.0, 300.0, 0.0}, AxisLoad{0.1, 2.0, 300.0, 0.4},
                               AxisLoad{0.002, 30.0, 5e4, 0.0}, AxisLoad{0.002, 0.1, 5e4, 0.3}}) {
    const AxisState start{0.01, 0.5};
    const AxisState once = after(load, 0.7, 0.0, 0.05, 1, start);
    const AxisState often = after(load, 0.7, 0.0, 0.05 / 173.0, 173, start);
    EXPECT_NEAR(once.position, often.position, 1e-13);
    EXPECT_NEAR(once.velocity, often.velocity, 1e-11);
  }
}

// Dry friction alone takes the energy evenly along the way: rest after m v^2 / (2 f_c), and then no more
// motion under any force up to f_c.
TEST(SimulatedAxis, SlidesToRestAndSticks) {
  const AxisLoad load{.mass = 0.1, .friction = 0.3};
  AxisState state{0.0, 0.6};
  AxisLoss loss;
  for (int n = 0; n < 500; ++n) loss.friction += advance_axis(load, 0.0, 0.0, kTick, state).friction;
  EXPECT_NEAR(state.position, 0.1 * 0.36 / 0.6, 1e-15);
  EXPECT_EQ(state.velocity, 0.0);
  EXPECT_NEAR(loss.friction, 0.5 * 0.1 * 0.36, 1e-15);
  const AxisState stuck = state;
  EXPECT_EQ(after(load, 0.3, 0.0, kTick, 10, state), stuck);
  EXPECT_EQ(after(load, -0.3, 0.0, kTick, 10, state), stuck);
  const AxisState pushed = after(load, 0.3 + 0.05, 0.0, kTick, 100, state);
  EXPECT_NEAR(pushed.position - stuck.position, 0.5 * (0.05 / 0.1) * 0.01, 1e-14)
      << "only the excess moves it";
}

// A spring with dry friction: each half swing is f_c / k shorter at both ends, and the mass stays where it
// stops once the spring pulls with less than f_c.
TEST(SimulatedAxis, SwingsOutAsCoulombSaysItDoes) {
  const AxisLoad load{.mass = 0.1, .stiffness = 400.0, .friction = 0.22};
  const double lost = 2.0 * load.friction / load.stiffness;  // [m] of the amplitude, a half swing
  const double half = std::numbers::pi * std::sqrt(load.mass / load.stiffness);
  AxisState state{0.01, 0.0};
  double amplitude = 0.01;
  for (int n = 1; amplitude > 0.5 * lost; ++n) {
    (void)advance_axis(load, 0.0, 0.0, half, state);
    amplitude -= lost;
    EXPECT_NEAR(state.position, n % 2 == 1 ? -amplitude : amplitude, 1e-14) << n;
    EXPECT_NEAR(state.velocity, 0.0, 1e-12);
    state.velocity = 0.0;  // of rounding: at the turn itself
  }
  const AxisState last = state;
  EXPECT_EQ(after(load, 0.0, 0.0, kTick, 100, state).position, last.position);
}

// The damper's loss, worked out from the energies, against the integral of b v^2.
TEST(SimulatedAxis, KeepsItsBooks) {
  std::mt19937 random{3};
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const AxisLoad load{.mass = 0.15, .damping = 4.0, .stiffness = 350.0, .friction = 0.2};
  constexpr int kParts = 4000;
  for (int trial = 0; trial < 20; ++trial) {
    AxisState state{0.01 * unit(random), 0.4 * unit(random)}, fine = state;
    const double force = 3.0 * unit(random), rest = 0.01 * unit(random);
    const AxisLoss loss = advance_axis(load, force, rest, 0.02, state);
    double viscous = 0.0, friction = 0.0;
    for (int n = 0; n < kParts; ++n) {
      const double before = fine.velocity;
      (void)advance_axis(load, force, rest, 0.02 / kParts, fine);
      viscous += load.damping * 0.5 * (before * before + fine.velocity * fine.velocity) * 0.02 / kParts;
      friction += load.friction * std::abs(0.5 * (before + fine.velocity)) * 0.02 / kParts;
    }
    EXPECT_NEAR(loss.viscous, viscous, 1e-6 * viscous + 1e-12);
    EXPECT_NEAR(loss.friction, friction, 1e-5 * friction + 1e-12);
    EXPECT_GE(loss.friction, 0.0);
  }
}

TEST(SimulatedAxis, AllocatesNothing) {
  AxisState state{0.0, 1.0};
  const AllocationGuard guard;
  for (int n = 0; n < 100; ++n) (void)advance_axis({0.1, 1.0, 100.0, 0.1}, 0.5, 0.0, kTick, state);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
