#include "lab/hand/rivals/constraint_pipe.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace palpate {

ConstraintPipe::ConstraintPipe(std::vector<std::unique_ptr<Constraint>> links,
                               const ConstraintPipeSettings& settings)
    : links_(std::move(links)), settings_(settings), active_(links_.size()) {
  PALPATE_CHECK(!links_.empty());
  for (const auto& link : links_) link->apply(settings_.chain);
}

ConstraintPipeStep ConstraintPipe::step(const Vec3& probe) noexcept {
  ConstraintPipeStep result = settle(probe);
  if (active_ == links_.size() && glm::distance(result.proxy, probe) > settings_.release_distance) {
    --active_;
    result = settle(probe);
  }
  result.released = active_ < links_.size();
  result.force = settings_.chain.stiffness * (result.proxy - probe);
  return result;
}

/// (1) with the links that still hold.
ConstraintPipeStep ConstraintPipe::settle(const Vec3& probe) noexcept {
  ConstraintPipeStep result{.proxy = probe};
  while (!result.agreed && result.rounds < settings_.rounds) {
    double moved = 0.0;
    for (std::size_t i = 0; i < active_; ++i) {
      LinkUpdate update;
      links_[i]->update(result.proxy, UpdateBudget{}, update);
      moved = std::max(moved, glm::distance(update.proxy, result.proxy));
      result.proxy = update.proxy;
    }
    ++result.rounds;
    result.agreed = moved <= settings_.tolerance;
  }
  return result;
}

}  // namespace palpate
