#include "common/haptics/chain_force.h"

namespace palpate {

std::string_view name_of(ChainForceForm form) noexcept {
  return form == ChainForceForm::kSum ? "sum" : "consistent";
}

void ChainForce::add(const LinkUpdate& link, const Vec3& stretched, double stiffness,
                     const Vec3& damper) noexcept {
  const Vec3 along_axes = stretched * link.frame;  // row vector times E is E^T times column
  const Vec3 pull = stiffness * (link.frame * (link.kappa * along_axes)) + damper + link.extra_force;
  force_ += form_ == ChainForceForm::kSum ? pull : carried_back(pull);
  active_ += form_ == ChainForceForm::kSum ? link.extra_force : carried_back(link.extra_force);
  lever_ = link.jacobian * lever_;
}

/// L^T times `pull`, not longer than kMostLever allows.
Vec3 ChainForce::carried_back(const Vec3& pull) const noexcept {
  const Vec3 carried = pull * lever_;
  const double most = kMostLever * glm::length(pull), size = glm::length(carried);
  return size > most ? carried * (most / size) : carried;
}

}  // namespace palpate
