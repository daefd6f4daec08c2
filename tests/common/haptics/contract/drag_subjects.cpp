// Isotropic drag under the contract.

#include <algorithm>
#include <cmath>

#include "common/haptics/constraint/anisotropy_drag.h"
#include "tests/common/haptics/contract/constraint_contract.h"

namespace palpate::test {
namespace {

constexpr double kThreshold = 0.02;  // [m]

ContractSubject isotropic_drag() {
  ContractSubject subject;
  subject.name = "IsotropicDrag";
  subject.make = [](const Placement&) {
    auto drag = std::make_shared<IsotropicDrag>();
    ChainSettings settings;
    settings.drag.threshold = kThreshold;
    drag->apply(settings);
    return drag;
  };
  subject.path = [](double s) { return Vec3{0.3 * std::sin(9.0 * s), 0.2 * std::cos(14.0 * s), 0.1 * s}; };
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return std::max(0.0, glm::distance(probe, link.proxy) - kThreshold);
  };
  subject.slope = 2.0;  // |dx| + |dp|, and the proxy goes no farther than the probe
  subject.smooth_at = {0.3, 0.7};
  return subject;
}

INSTANTIATE_TEST_SUITE_P(Drag, ConstraintContract, ::testing::Values(isotropic_drag()), subject_name);

}  // namespace
}  // namespace palpate::test
