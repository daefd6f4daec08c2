// Isosurfaces under the contract: walls and layers, of a formula, on trilinear cells and on tetrahedra; and a
// wall that a streamline meets.

#include <cmath>
#include <numbers>

#include "common/field/analytic/volume_examples.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/streamline.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/common/haptics/contract/moved_fields.h"
#include "tests/common/trace/helix_field.h"
#include "tests/common/trace/sampled_scalars.h"

namespace palpate::test {
namespace {

constexpr double kDepth = 0.6;  // [m], of a sphere of radius 1

std::shared_ptr<Constraint> on(const std::shared_ptr<const ScalarField>& field, const Placement& at,
                               IsosurfaceHold hold) {
  auto constraint =
      std::make_shared<IsosurfaceConstraint>(field, Workspace(power_of_two(-at.exponent), field->frame()));
  ChainSettings settings;
  // Values are scaled by 2^(2 exponent), see moved_scalars().
  settings.isosurface.isovalues = {{power_of_two(2 * at.exponent)}, 1};
  settings.isosurface.hold = hold;
  settings.isosurface.depth = kDepth;
  constraint->apply(settings);
  return constraint;
}

/// From outside through the surface, then about within it.
Vec3 through_the_surface(double s) {
  const double radius = s < 0.1 ? 1.2 - 5.0 * s : 0.7 + 0.15 * std::sin(20.0 * (s - 0.1));
  const double angle = 2.0 * std::numbers::pi * s, rise = 0.8 * std::sin(5.0 * s);
  return radius * Vec3{std::cos(angle) * std::cos(rise), std::sin(angle) * std::cos(rise), std::sin(rise)};
}

ContractSubject subject_of(const char* name, IsosurfaceHold hold) {
  ContractSubject subject;
  subject.name = name;
  subject.make = [hold](const Placement& at) { return on(moved_scalars(sphere_scalar(), at), at, hold); };
  subject.path = through_the_surface;
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    return std::abs(glm::length(link.proxy) - 1.0);
  };
  subject.feature_error = 1e-13;
  // |dx| + |dp|, and the proxy goes 1 / r as far as the probe.
  subject.slope = 1.0 + 1.0 / 0.5;
  subject.smooth_at = {0.2, 0.45, 0.8};
  subject.wild = Vec3{2.0};
  subject.moved_error = 1e-10;
  return subject;
}

/// The scalar sampled on a grid with cells of size `cell`, whose lengths and values are scaled as
/// moved_scalars() does. From within, the crease between two facets is a hill: behind it the closest point
/// lies farther on, by the depth (0.45 here) times the angle between them, which on a sphere of radius 1 is
/// at most that of two cells.
template <typename Sample>
ContractSubject sampled(const char* name, IsosurfaceHold hold, double cell, const Sample& sample) {
  ContractSubject subject = subject_of(name, hold);
  subject.make = [hold, sample](const Placement& at) {
    return on(sample(moved_scalars(sphere_scalar(), at)), at, hold);
  };
  subject.movable = false;
  // Linear interpolation makes |x|^2 too large, by 3 h^2 / 4 in a cube: the radius is too small by half of it
  // to first order, and by more where points were moved.
  subject.feature_error = 0.75 * 0.75 * cell * cell;
  subject.leap = 0.45 * 2.0 * cell;
  subject.jacobian_error = 1e-5;
  return subject;
}

/// The data set of a field of a formula, in the units of the data.
class InDataUnits final : public AnalyticScalar {
 public:
  explicit InDataUnits(std::shared_ptr<const ScalarField> field) : field_(std::move(field)) {}
  [[nodiscard]] double value(const Vec3& x) const noexcept override {
    CellHint hint;
    return field_->sample(x, hint).value;
  }
  [[nodiscard]] Jet3 jet(const Vec3&) const noexcept override { return {}; }
  [[nodiscard]] Box bounds() const noexcept override {
    const Box all = field_->bounds();
    return {0.375 * all.lower, 0.375 * all.upper};  // [-1.5, 1.5]^3 of kMovedBounds
  }
  [[nodiscard]] std::string name() const override { return "sphere"; }
  [[nodiscard]] std::string description() const override { return {}; }

 private:
  std::shared_ptr<const ScalarField> field_;
};

std::shared_ptr<const ScalarField> in_boxes(const std::shared_ptr<const ScalarField>& field) {
  return on_uniform(std::make_shared<InDataUnits>(field), Index3{25});
}
std::shared_ptr<const ScalarField> in_tets(const std::shared_ptr<const ScalarField>& field) {
  return on_tets(std::make_shared<InDataUnits>(field), Index3{13});
}

/// A streamline, and a wall that its proxy meets, in the same update (Ikits 2006, figure 6.7); the spring is
/// that of both, from the last proxy to the probe.
class WallOnAStreamline final : public Constraint {
 public:
  WallOnAStreamline(const std::shared_ptr<LiveLine>& line, const Workspace& on_line,
                    std::shared_ptr<Constraint> wall)
      : streamline_(line, on_line), wall_(std::move(wall)) {}

  void apply(const ChainSettings& settings) noexcept override { streamline_.apply(settings); }
  void reset() noexcept override {
    streamline_.reset();
    wall_->reset();
  }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    LinkUpdate first;
    streamline_.update(probe, budget, first);
    wall_->update(first.proxy, budget, link);
    if (link.state == HoldState::kFree) link.state = first.state;
    link.frame = Mat3(1.0);
    link.kappa = Vec3(1.0);
    link.residual = std::max(link.residual, first.residual);
    link.iterations = std::max(link.iterations, first.iterations);
  }

 private:
  StreamlineConstraint streamline_;
  std::shared_ptr<Constraint> wall_;
};

constexpr double kLineRise = 0.5;
const Helix kMeets{.seed = {0.8, 0.0, -0.5}, .rise = kLineRise};

// Beside the helix that enters the unit sphere where z = -0.6, in and out again.
Vec3 in_along_the_line(double s) {
  const Vec3 along = kMeets.at_time(-1.15 * std::cos(3.0 * std::numbers::pi * s));
  const double aside = 0.05 * std::min(1.0, 50.0 * s);
  return along + aside * Vec3{std::sin(20.0 * s), std::cos(30.0 * s), std::sin(25.0 * s)};
}

ContractSubject met_along_a_streamline() {
  ContractSubject subject;
  subject.name = "WallOnAStreamline";
  subject.make = [](const Placement& at) {
    const auto flow = moved_flow(std::make_shared<const HelixField>(kLineRise), at);
    auto both = std::make_shared<WallOnAStreamline>(
        std::make_shared<LiveLine>(flow, LiveLine::kFollowTolerance, 1),
        Workspace(power_of_two(-at.exponent), flow->frame()),
        on(moved_scalars(sphere_scalar(), at), at, IsosurfaceHold::kWall));
    ChainSettings settings;
    settings.streamline.release_distance = 0.3;
    both->apply(settings);
    return both;
  };
  subject.path = in_along_the_line;
  subject.settling = 300;  // the line grows a few cells an update
  // On the sphere, or while that lets it be, on the line outside.
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    const double from_sphere = std::abs(glm::length(link.proxy) - 1.0);
    const double angle = std::atan2(link.proxy.y, link.proxy.x);
    double from_line = HUGE_VAL;
    for (int turn = -1; turn <= 1; ++turn)
      from_line = std::min(from_line,
                           glm::distance(link.proxy, kMeets.at_time(angle + 2.0 * std::numbers::pi * turn)));
    return glm::length(link.proxy) > 1.0 + 1e-9 ? from_line : from_sphere;
  };
  subject.feature_error = 2e-6;  // of the line, as in streamline_subjects.cpp
  subject.moved_error = 2e-6;
  // |dx| + |dp|: the line's proxy goes 1.09 times as far as the probe, the wall's 1 / 0.8 times as far again.
  subject.slope = 2.4;
  subject.wild = Vec3{2.0};
  return subject;
}

INSTANTIATE_TEST_SUITE_P(MetAlongAStreamline, ConstraintContract, ::testing::Values(met_along_a_streamline()),
                         subject_name);

INSTANTIATE_TEST_SUITE_P(
    Isosurfaces, ConstraintContract,
    ::testing::Values(subject_of("IsosurfaceWall", IsosurfaceHold::kWall),
                      subject_of("IsosurfaceLayer", IsosurfaceHold::kLayer),
                      sampled("TrilinearWall", IsosurfaceHold::kWall, 3.0 / 24, in_boxes),
                      sampled("TrilinearLayer", IsosurfaceHold::kLayer, 3.0 / 24, in_boxes),
                      sampled("TetrahedraWall", IsosurfaceHold::kWall, 3.0 / 12, in_tets),
                      sampled("TetrahedraLayer", IsosurfaceHold::kLayer, 3.0 / 12, in_tets)),
    subject_name);

}  // namespace
}  // namespace palpate::test
