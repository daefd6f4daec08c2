#include "common/haptics/constraint/isosurface.h"

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/proxy_chain.h"
#include "common/haptics/settings_text.h"
#include "tests/common/trace/sampled_scalars.h"

namespace palpate {
namespace {

using test::on_tets;
using test::on_uniform;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }
Vec3 direction(std::mt19937_64& random) {
  for (;;) {
    const double x = unit(random), y = unit(random), z = unit(random);
    const Vec3 v = 2.0 * Vec3{x, y, z} - 1.0;
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1.0) return v / length;
  }
}

/// Data units are metres.
class Felt {
 public:
  Felt(const std::shared_ptr<const ScalarField>& field, const IsosurfaceSettings& settings)
      : constraint(field, Workspace(1.0, field->frame())) {
    apply(settings);
  }
  void apply(const IsosurfaceSettings& settings) {
    ChainSettings all;
    all.isosurface = settings;
    EXPECT_TRUE(all.valid());
    constraint.apply(all);
  }
  LinkUpdate at(const Vec3& probe, int iterations = UpdateBudget{}.iterations) {
    LinkUpdate link;
    constraint.update(probe, {.iterations = iterations}, link);
    return link;
  }
  IsosurfaceConstraint constraint;
};

/// A scalar that rises along x alone, over [-1, 1]^3.
template <typename Profile>
class AlongX final : public AnalyticScalar {
 public:
  [[nodiscard]] double value(const Vec3& x) const noexcept override { return Profile::value(x.x); }
  [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
    return Profile::value(Jet3::variable(x, 0));
  }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
  [[nodiscard]] std::string name() const override { return "x"; }
  [[nodiscard]] std::string description() const override { return "x"; }
};
struct Ramp {
  template <typename T>
  static T value(const T& x) noexcept {
    return x;
  }
};
using RampScalar = AlongX<Ramp>;

const IsosurfaceSettings kSphere{.isovalues = {{1.0}, 1}, .depth = 0.1};

TEST(Isosurface, AWallStopsTheProbeAndLetsItBackWithoutAJump) {
  Felt felt(make_scalar_field(sphere_scalar()), kSphere);
  EXPECT_EQ(felt.at({1.2, 0.0, 0.0}).state, HoldState::kFree);
  const LinkUpdate inside = felt.at({0.95, 0.0, 0.0});
  EXPECT_EQ(inside.state, HoldState::kHeld);
  EXPECT_LT(glm::distance(inside.proxy, {1.0, 0.0, 0.0}), 1e-12);
  EXPECT_FALSE(inside.jumped);
  EXPECT_NEAR(std::abs(inside.frame[0].x), 1.0, 1e-12);
  EXPECT_EQ(felt.constraint.held_by(), 0);
  // Along the surface within, out again elsewhere.
  const LinkUpdate beside = felt.at({0.0, 0.95, 0.0});
  EXPECT_LT(glm::distance(beside.proxy, {0.0, 1.0, 0.0}), 1e-12);
  const LinkUpdate out = felt.at({0.0, 1.05, 0.0});
  EXPECT_EQ(out.state, HoldState::kFree);
  EXPECT_EQ(out.proxy, Vec3(0.0, 1.05, 0.0));
  EXPECT_FALSE(out.jumped);
  EXPECT_EQ(felt.constraint.held_by(), -1);
  EXPECT_EQ(felt.at({2.0, 0.0, 0.0}).state, HoldState::kOutside);
}

TEST(Isosurface, APushedWallLetsThroughAndIsFeltFromBehind) {
  Felt felt(make_scalar_field(sphere_scalar()), kSphere);
  (void)felt.at({1.2, 0.0, 0.0});
  EXPECT_EQ(felt.at({0.91, 0.0, 0.0}).state, HoldState::kHeld);
  const LinkUpdate through = felt.at({0.89, 0.0, 0.0});
  EXPECT_EQ(through.state, HoldState::kReleased);
  EXPECT_TRUE(through.jumped);
  EXPECT_EQ(through.proxy, Vec3(0.89, 0.0, 0.0));
  EXPECT_EQ(felt.at({0.5, 0.0, 0.0}).state, HoldState::kFree);
  const LinkUpdate behind = felt.at({1.08, 0.0, 0.0});
  EXPECT_EQ(behind.state, HoldState::kHeld);
  EXPECT_LT(glm::distance(behind.proxy, {1.0, 0.0, 0.0}), 1e-12);
  EXPECT_EQ(felt.at({0.95, 0.0, 0.0}).state, HoldState::kFree) << "inside is where it came from";
}

TEST(Isosurface, AOneSidedWallIsPassedFromBehind) {
  IsosurfaceSettings settings = kSphere;
  settings.hold = IsosurfaceHold::kAbove;  // outside the sphere is above
  Felt felt(make_scalar_field(sphere_scalar()), settings);
  (void)felt.at({0.5, 0.0, 0.0});
  EXPECT_EQ(felt.at({1.05, 0.0, 0.0}).state, HoldState::kFree);
  EXPECT_EQ(felt.at({0.95, 0.0, 0.0}).state, HoldState::kHeld);
  settings.hold = IsosurfaceHold::kBelow;
  felt.apply(settings);
  felt.constraint.reset();
  (void)felt.at({1.05, 0.0, 0.0});
  EXPECT_EQ(felt.at({0.95, 0.0, 0.0}).state, HoldState::kFree);
  EXPECT_EQ(felt.at({1.05, 0.0, 0.0}).state, HoldState::kHeld);
}

TEST(Isosurface, ALayerHoldsFromBothSidesAndGoesOverToItsNeighbour) {
  IsosurfaceSettings settings{.isovalues = {{0.81, 1.0, 1.21}, 3},  // radii 0.9, 1, 1.1
                              .hold = IsosurfaceHold::kLayer,
                              .depth = 0.3,
                              .snap_distance = 0.02};
  Felt felt(make_scalar_field(sphere_scalar()), settings);
  EXPECT_EQ(felt.at({1.15, 0.0, 0.0}).state, HoldState::kFree);
  const LinkUpdate caught = felt.at({1.115, 0.0, 0.0});
  EXPECT_EQ(caught.state, HoldState::kHeld) << "within the snap distance";
  EXPECT_TRUE(caught.jumped);
  EXPECT_LT(glm::distance(caught.proxy, {1.1, 0.0, 0.0}), 1e-12);
  for (const double r : {1.2, 1.01}) {
    EXPECT_LT(glm::distance(felt.at({r, 0.0, 0.0}).proxy, {1.1, 0.0, 0.0}), 1e-12) << r;
  }
  const LinkUpdate next = felt.at({0.99, 0.0, 0.0});
  EXPECT_LT(glm::distance(next.proxy, {1.0, 0.0, 0.0}), 1e-12) << "over the surface of the next";
  EXPECT_TRUE(next.jumped);
  EXPECT_FALSE(felt.at({1.05, 0.0, 0.0}).jumped) << "back between them it still belongs to the last";
  EXPECT_EQ(felt.constraint.held_by(), 1);
  (void)felt.at({0.8, 0.0, 0.0});
  EXPECT_EQ(felt.constraint.held_by(), 0);
  EXPECT_EQ(felt.at({0.5, 0.0, 0.0}).state, HoldState::kReleased);
  EXPECT_EQ(felt.at({0.5, 0.0, 0.0}).state, HoldState::kFree);
}

TEST(Isosurface, NoStepIsTooLongAndNoShellTooThin) {
  // A step of many shells: each that is passed by more than its depth lets through, the last one holds.
  const IsosurfaceSettings shells{.isovalues = {{-0.6, -0.2, 0.2, 0.6}, 4}, .depth = 0.3};
  for (const auto& field : {make_scalar_field(std::make_shared<RampScalar>()),
                            on_uniform(std::make_shared<RampScalar>(), Index3{40}),
                            on_tets(std::make_shared<RampScalar>(), Index3{12})}) {
    Felt felt(field, shells);
    (void)felt.at({-0.95, 0.01, 0.02});
    const LinkUpdate far = felt.at({0.35, 0.01, 0.02});
    EXPECT_EQ(far.state, HoldState::kReleased);
    EXPECT_TRUE(far.jumped);
    EXPECT_LT(glm::distance(far.proxy, {0.2, 0.01, 0.02}), 1e-12);
    EXPECT_EQ(felt.at({0.36, 0.01, 0.02}).state, HoldState::kHeld);
  }
}

TEST(Isosurface, EditedIsovaluesTakeTheProxyAlong) {
  Felt felt(make_scalar_field(sphere_scalar()), kSphere);
  (void)felt.at({1.2, 0.0, 0.0});
  (void)felt.at({0.95, 0.0, 0.0});
  IsosurfaceSettings settings = kSphere;
  settings.isovalues.value[0] = 1.05 * 1.05;
  settings.depth = 0.2;
  felt.apply(settings);
  const LinkUpdate moved = felt.at({0.95, 0.0, 0.0});
  EXPECT_EQ(moved.state, HoldState::kHeld);
  EXPECT_TRUE(moved.jumped);
  EXPECT_LT(glm::distance(moved.proxy, {1.05, 0.0, 0.0}), 1e-12);
  settings.isovalues = {};
  felt.apply(settings);
  EXPECT_EQ(felt.at({0.95, 0.0, 0.0}).state, HoldState::kFree) << "no isovalue, no surface";
}

/// No gradient at x = 0, where the value is 0.
struct Cubic {
  template <typename T>
  static T value(const T& x) noexcept {
    return x * x * x;
  }
};

TEST(Isosurface, SaysSoWhereTheGradientVanishes) {
  Felt felt(make_scalar_field(std::make_shared<AlongX<Cubic>>()), {.isovalues = {{0.0}, 1}, .depth = 0.5});
  (void)felt.at({-0.1, 0.0, 0.0});
  const LinkUpdate flat = felt.at({0.1, 0.0, 0.0});
  EXPECT_EQ(flat.state, HoldState::kFellBack);
  EXPECT_LT(std::abs(flat.proxy.x), 0.02);
}

/// Zero up to x = 0, then rising: a plateau at the isovalue.
struct Plateau {
  static double value(double x) noexcept { return x < 0.0 ? 0.0 : x; }
  static Jet3 value(const Jet3& x) noexcept { return x.value < 0.0 ? Jet3(0.0) : x; }
};

TEST(Isosurface, PlateausAtTheIsovalueBelongToWhatIsAbove) {
  // 21 points: one of them at 0. From below zero there is no way, and from above nothing is crossed.
  for (const auto& field : {on_uniform(std::make_shared<AlongX<Plateau>>(), Index3{21}),
                            on_tets(std::make_shared<AlongX<Plateau>>(), Index3{21}, 0.0)}) {
    Felt felt(field, {.isovalues = {{0.0}, 1}, .depth = 0.5});
    (void)felt.at({0.31, 0.01, 0.02});
    EXPECT_EQ(felt.at({-0.23, 0.01, 0.02}).state, HoldState::kFree);
    // Just above the plateau the border is where it should be.
    felt.apply({.isovalues = {{1e-9}, 1}, .depth = 0.5});
    felt.constraint.reset();
    (void)felt.at({0.31, 0.01, 0.02});
    const LinkUpdate held = felt.at({-0.23, 0.11, 0.02});
    EXPECT_EQ(held.state, HoldState::kHeld);
    EXPECT_LT(glm::distance(held.proxy, {0.0, 0.11, 0.02}), 1e-8);
  }
}

/// The layers of a wall, numbered: whole numbers at the points of a grid, which every layer passes through.
struct Layers {
  template <typename T>
  static T value(const T& x) noexcept {
    return T(10.0) * x;
  }
};

// The surface is made of faces of the mesh: every point of it lies on faces, edges and vertices of cells.
TEST(Isosurface, LayersThroughThePointsOfAMeshAreFollowedExactly) {
  const auto field = on_tets(std::make_shared<AlongX<Layers>>(), Index3{21}, 0.0);  // points 0.1 apart
  Felt felt(field, {.isovalues = {{-2.0, 0.0, 2.0, 3.0}, 4},
                    .hold = IsosurfaceHold::kLayer,
                    .depth = 0.15,
                    .snap_distance = 0.05});
  std::mt19937_64 random(5);
  Vec3 probe{0.01, 0.0, 0.0};
  int held = 0;
  for (int n = 0; n < 20'000; ++n) {
    probe += 0.01 * direction(random);
    probe = glm::clamp(probe, Vec3{-0.9}, Vec3{0.9});
    const LinkUpdate link = felt.at(probe);
    if (felt.constraint.held_by() < 0) continue;
    ++held;
    const double layer = std::array{-0.2, 0.0, 0.2, 0.3}[static_cast<std::size_t>(felt.constraint.held_by())];
    ASSERT_LT(glm::distance(link.proxy, {layer, probe.y, probe.z}), 1e-12) << n;
    ASSERT_LE(link.residual, 1e-12);
    ASSERT_NE(link.state, HoldState::kFellBack);
  }
  EXPECT_GT(held, 5000);
}

// A finger-proxy of triangles gets stuck at their edges where steps are large against them: here every step
// passes many cells, and the proxy is still the closest point of the sphere, within what the mesh differs
// from it.
TEST(Isosurface, IsNeverFurtherBehindThanTheSurfaceDemands) {
  const auto field = on_tets(sphere_scalar(), Index3{41});  // cells of 0.075
  const double too_far = 0.75 * 0.075 * 0.075;  // of linear interpolation of |x|^2: 3 h^2 / 4 at most
  Felt felt(field, {.isovalues = {{1.0}, 1}, .hold = IsosurfaceHold::kLayer, .depth = 0.9});
  std::mt19937_64 random(2);
  (void)felt.at({1.2, 0.0, 0.0});
  (void)felt.at({0.9, 0.0, 0.0});
  double longest = 0.0;
  for (int n = 0; n < 3000; ++n) {
    // Three cells a step, on a path that winds over the whole sphere.
    const double angle = 0.2 * n, rise = 1.4 * std::sin(0.037 * n);
    const Vec3 radial{std::cos(angle) * std::cos(rise), std::sin(angle) * std::cos(rise), std::sin(rise)};
    const double r = 0.5 + 0.9 * unit(random);
    const LinkUpdate link = felt.at(r * radial);
    ASSERT_NE(felt.constraint.held_by(), -1) << n;
    if (link.state == HoldState::kFellBack) continue;
    const double behind = glm::distance(link.proxy, r * radial) - std::abs(1.0 - r);
    longest = std::max(longest, behind);
    ASSERT_LE(behind, too_far + 1e-12) << n << " at radius " << r;
  }
  EXPECT_GT(longest, 0.0);
}

/// Along x at unit speed.
class Stream final : public AnalyticField {
 public:
  [[nodiscard]] Vec3 velocity(const Vec3&) const noexcept override { return {1.0, 0.0, 0.0}; }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override { return Mat3{0.0}; }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.5}, Vec3{1.5}}; }
  [[nodiscard]] std::string name() const override { return "stream"; }
  [[nodiscard]] std::string description() const override { return "stream"; }
};

// Ikits 2006, figure 6.7 (c), on the streamline y = 0.1 into the unit sphere: both constraints hold exactly,
// the depth is felt on top of the line's pull, and once the surface gives way the line is still the same.
TEST(Isosurface, AStreamlineIsFollowedIntoAPenetrableSurface) {
  const auto flow = make_vector_field(std::make_shared<const Stream>());
  const auto scalar = make_scalar_field(sphere_scalar());
  const Workspace workspace(1.0, flow->frame());
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(
      std::make_unique<StreamlineConstraint>(std::make_shared<LiveLine>(flow, 1e-7, 1), workspace));
  links.push_back(std::make_unique<IsosurfaceConstraint>(scalar, workspace));
  ChainSettings settings;
  settings.streamline.release_distance = 0.5;
  settings.isosurface = kSphere;  // lets through at 0.1
  ProxyChain chain(std::move(links), settings);
  const double entry = -std::sqrt(1.0 - 0.01);
  bool released = false;
  for (int n = 0; n <= 400; ++n) {
    // The hand drifts off the line by up to 0.05.
    const double x = -1.3 + 0.002 * n;
    const ChainStep step = chain.step({x, 0.1 + 0.05 * std::min(1.0, n / 100.0), 0.0});
    ASSERT_LT(glm::distance(step.proxies[0], {x, 0.1, 0.0}), 1e-9) << "on the same line all along";
    if (step.state == HoldState::kReleased) released = true;
    const bool held = x > entry && !released;
    const Vec3 on_sphere = glm::normalize(Vec3{x, 0.1, 0.0});
    const Vec3 expected = held ? on_sphere : step.proxies[0];
    ASSERT_LT(glm::distance(step.proxies[1], expected), 1e-9) << x;
    ASSERT_EQ(released, glm::length(Vec3{x, 0.1, 0.0}) < 0.9) << x;
  }
  EXPECT_TRUE(released);
}

TEST(Isosurface, SettingsReadBackFromTheirText) {
  ChainSettings settings, read;
  settings.isosurface = {.isovalues = {{0.1, -2e30, 3.0}, 3},
                         .hold = IsosurfaceHold::kLayer,
                         .depth = 0.02,
                         .snap_distance = 0.003};
  EXPECT_EQ(read_settings(settings_text(settings), read), std::nullopt);
  EXPECT_EQ(read, settings);
  settings.isosurface.isovalues = {};
  EXPECT_EQ(read_settings(settings_text(settings), read), std::nullopt);
  EXPECT_EQ(read, settings);
  settings.isosurface.isovalues = {{NAN}, 1};
  EXPECT_FALSE(settings.valid());
  EXPECT_FALSE((ChainSettings{.isosurface = {.depth = 0.0}}.valid()));
  EXPECT_FALSE((ChainSettings{.isosurface = {.depth = 0.1, .snap_distance = 0.2}}.valid()));
}

}  // namespace
}  // namespace palpate
