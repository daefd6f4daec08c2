// The streamline constraint under the contract, and tick marks along one, on helices about the z axis.

#include <cmath>

#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/streamline.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/common/haptics/contract/moved_fields.h"
#include "tests/common/trace/helix_field.h"

namespace palpate::test {
namespace {

constexpr double kRise = 0.5;
const Vec3 kStart{0.8, 0.0, -0.5};
constexpr double kTick = 0.25;  // [1 / local speed] between marks; one radian a unit of time

/// Along the helix through kStart, 0.05 beside it after the first steps.
Vec3 beside_helix(double s) {
  const Vec3 along = Helix{.seed = kStart, .rise = kRise}.at_time(2.5 * std::sin(4.0 * s));
  const double aside = 0.05 * std::min(1.0, 50.0 * s);
  return along + aside * Vec3{std::sin(20.0 * s), std::cos(30.0 * s), std::sin(25.0 * s)};
}

/// Distance from the helix, measured at the angle of `x`: at most the slope of the helix too much.
double from_helix(const Vec3& x) {
  double best = HUGE_VAL;
  const double angle = std::atan2(x.y, x.x);
  for (int turn = -2; turn <= 2; ++turn) {
    const double t = angle + 2.0 * 3.14159265358979323846 * turn;
    best = std::min(best, glm::distance(x, Helix{.seed = kStart, .rise = kRise}.at_time(t)));
  }
  return best;
}

/// A streamline, and marks that follow it in the same update.
class FollowedTicks final : public Constraint {
 public:
  FollowedTicks(const std::shared_ptr<LiveLine>& line, const Workspace& workspace)
      : streamline_(line, workspace), ticks_(streamline_) {}

  void apply(const ChainSettings& settings) noexcept override {
    streamline_.apply(settings);
    ticks_.apply(settings);
  }
  void reset() noexcept override {
    streamline_.reset();
    ticks_.reset();
  }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    LinkUpdate first;
    streamline_.update(probe, budget, first);
    ticks_.update(first.proxy, budget, link);
  }

 private:
  StreamlineConstraint streamline_;
  TickMarks ticks_;
};

template <typename Followed>
ContractSubject on_a_helix(const char* name) {
  ContractSubject subject;
  subject.name = name;
  subject.make = [](const Placement& at) {
    const auto field = moved_flow(std::make_shared<const HelixField>(kRise), at);
    const Workspace workspace(power_of_two(-at.exponent), field->frame());
    const auto line = std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, 1);
    auto followed = std::make_shared<Followed>(line, workspace);
    ChainSettings settings;
    settings.streamline.release_distance = 0.3;
    settings.ticks.interval = kTick;  // times keep their size: moved_flow() scales speeds like lengths
    followed->apply(settings);
    return followed;
  };
  subject.path = beside_helix;
  subject.settling = 300;  // the line grows a few cells an update
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) { return from_helix(link.proxy); };
  subject.feature_error = 2e-6;  // of a line that is traced to 1e-7 of a diagonal of 7
  subject.moved_error = 2e-6;
  subject.wild = Vec3{2.0};
  return subject;
}

ContractSubject streamline() {
  auto subject = on_a_helix<StreamlineConstraint>("Streamline");
  // |dx| + |dp|, and the proxy goes 1 / (1 - 0.09 kappa) as far as the probe, with kappa = 0.9.
  subject.slope = 2.2;
  subject.smooth_at = {0.2, 0.5};
  subject.jacobian_error = 1e-4;
  return subject;
}

ContractSubject tick_marks() {
  auto subject = on_a_helix<FollowedTicks>("TickMarks");
  subject.slope = 2.2;
  subject.leap = kTick;  // from mark to mark, at a speed below one
  return subject;
}

INSTANTIATE_TEST_SUITE_P(Streamlines, ConstraintContract, ::testing::Values(streamline(), tick_marks()),
                         subject_name);

}  // namespace
}  // namespace palpate::test
