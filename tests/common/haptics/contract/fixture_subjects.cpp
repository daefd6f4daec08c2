// Planes, surfaces of triangles, friction on a wall, and landmarks that pull, under the contract.

#include <cmath>
#include <memory>
#include <numbers>

#include "common/haptics/constraint/force_playback.h"
#include "common/haptics/constraint/landmark_pull.h"
#include "common/haptics/constraint/mesh_surface.h"
#include "common/haptics/constraint/shape.h"
#include "common/haptics/constraint/surface_friction.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/support/round_surfaces.h"

namespace palpate::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

ContractSubject plane() {
  ContractSubject subject;
  subject.name = "Plane";
  subject.make = [](const Placement& at) {
    auto shape = std::make_shared<PlaneConstraint>(at.point(Vec3{0.0}), at.direction({0.0, 0.0, 2.0}));
    ChainSettings settings;
    settings.shape = {.snap_distance = 1e3, .release_distance = 1e3};
    shape->apply(settings);
    return shape;
  };
  subject.path = [](double s) { return Vec3{s, 0.1 * s, 0.05 * std::cos(3.0 * kTurn * s)}; };
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return glm::distance(link.proxy, Vec3{probe.x, probe.y, 0.0});
  };
  subject.smooth_at = {0.05, 0.3, 0.5};
  return subject;
}

/// A ball of 512 faces, pressed on from outside; its proxy goes from face to face.
ContractSubject ball_of_triangles() {
  constexpr double kRadius = 0.1;
  static const Triangles kBall = ball_triangles(kRadius, 3);
  ContractSubject subject;
  subject.name = "BallOfTriangles";
  subject.make = [](const Placement& at) {
    std::vector<Vec3> points;
    for (const Vec3& x : kBall.points) points.push_back(at.point(x) * std::ldexp(1.0, at.exponent));
    auto mesh = std::make_shared<const SurfaceMesh>(points, kBall.triangles);
    const Workspace workspace(std::ldexp(1.0, -at.exponent), LocalFrame{});
    auto surface = std::make_shared<MeshConstraint>(std::move(mesh), workspace);
    LinkUpdate link;
    surface->update(at.point({0.2, 0.05, 0.03}), {}, link);
    return surface;
  };
  subject.path = [](double s) {
    // Not through corners and along edges of the eight faces that it is made of, where rounding chooses.
    const double a = kTurn * s + 0.31, b = 0.8 * std::sin(2.0 * kTurn * s) + 0.17, r = kRadius - 0.004;
    return r * Vec3{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
  };
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    static const SurfaceMesh kMesh(kBall.points, kBall.triangles);
    double least = HUGE_VAL;
    for (std::uint32_t t = 0; t < kMesh.triangles().size(); ++t)
      least = std::min(least, glm::distance(link.proxy, kMesh.nearest_on(t, link.proxy).point));
    return least;
  };
  subject.slope = 2.0;
  subject.leap = 0.004;  // from face to face, 0.2 rad apart, of what is pressed in
  subject.moved_error = 1e-9;
  subject.smooth_at = {0.013, 0.31};
  subject.wild = Vec3{0.3};
  return subject;
}

/// A surface that is pressed on by 5 mm, wherever the hand is.
struct PressedPlane final : TouchedSurface {
  explicit PressedPlane(const Vec3& n) : normal(n) {}
  [[nodiscard]] SurfaceContact contact() const noexcept override {
    return {.touches = true, .depth = 0.005, .normal = normal};
  }
  Vec3 normal;
};

ContractSubject friction() {
  ContractSubject subject;
  subject.name = "SurfaceFriction";
  subject.make = [](const Placement& at) {
    struct Rubbed {
      explicit Rubbed(const Vec3& n) : plane(n), friction(plane) {}
      PressedPlane plane;
      SurfaceFriction friction;
    };
    auto both = std::make_shared<Rubbed>(at.direction({0.0, 0.0, 1.0}));
    ChainSettings settings;
    settings.contact = {.sticking = 0.5, .sliding = 0.3};
    both->friction.apply(settings);
    return std::shared_ptr<Constraint>(both, &both->friction);
  };
  subject.path = [](double s) {
    return Vec3{0.1 * std::sin(kTurn * s), 0.05 * std::cos(2.0 * kTurn * s), 0.0};
  };
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return std::max(0.0, glm::distance(probe, link.proxy) - 0.0025);
  };
  subject.slope = 2.0;
  subject.leap = 0.0011;  // from sticking to sliding
  subject.smooth_at = {0.13, 0.4};
  return subject;
}

ContractSubject landmarks() {
  ContractSubject subject;
  subject.name = "Landmarks";
  subject.make = [](const Placement& at) {
    std::vector<Landmark> all{
        {.at = at.point(Vec3{0.0}), .pull = Landmark::Pull::kMagnet, .reach = 0.05, .force = 1.0},
        {.at = at.point({0.05, 0.0, 0.0}), .pull = Landmark::Pull::kWell, .reach = 0.2, .force = 0.5}};
    return std::make_shared<LandmarkPull>(all);
  };
  subject.path = [](double s) { return 0.1 * Vec3{std::cos(kTurn * s), std::sin(kTurn * s), s - 0.5}; };
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return glm::distance(probe, link.proxy);
  };
  subject.smooth_at = {0.1, 0.6};
  return subject;
}

ContractSubject played_back() {
  ContractSubject subject = landmarks();
  subject.name = "ForcePlayback";
  subject.make = [](const Placement& at) {
    auto rows = std::make_shared<const std::vector<TimedForce>>(
        std::vector<TimedForce>{{0.0, at.direction({0.5, 0.0, 0.0})}, {1e6, at.direction({0.5, 0.0, 0.0})}});
    return std::make_shared<ForcePlayback>(rows);
  };
  return subject;
}

INSTANTIATE_TEST_SUITE_P(Fixtures, ConstraintContract,
                         ::testing::Values(plane(), ball_of_triangles(), friction(), landmarks(),
                                           played_back()),
                         subject_name);

}  // namespace
}  // namespace palpate::test
