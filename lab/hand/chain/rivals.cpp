#include "lab/hand/chain/rivals.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/base/check.h"

namespace palpate {
namespace {

constexpr int kRounds = 4096;

/// k times what would bring a proxy at `p` on to the primitive, cut to its strength.
Vec3 reaction(const HapticPrimitive& primitive, const Vec3& p, double stiffness) noexcept {
  const Vec3 away = p - primitive.through;
  const double along = glm::dot(away, primitive.direction);
  const Vec3 left = primitive.kind == HapticPrimitive::Kind::kLine
                        ? away - along * primitive.direction
                        : std::min(along, 0.0) * primitive.direction;
  const double pull = stiffness * glm::length(left);
  return pull > primitive.strength ? left * (-stiffness * primitive.strength / pull) : -stiffness * left;
}

}  // namespace

Vec3 balanced_proxy(const Vec3& probe, double stiffness, std::span<const HapticPrimitive> primitives,
                    double tolerance) noexcept {
  PALPATE_CHECK(primitives.size() <= kMostPrimitives && stiffness > 0.0);
  std::array<Vec3, kMostPrimitives> reactions;
  reactions.fill(Vec3{0.0});
  Vec3 proxy = probe;
  for (int round = 0; round < kRounds; ++round) {
    double moved = 0.0;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const Vec3 without = proxy - reactions[i] / stiffness;
      reactions[i] = reaction(primitives[i], without, stiffness);
      const Vec3 next = without + reactions[i] / stiffness;
      moved = std::max(moved, glm::distance(next, proxy));
      proxy = next;
    }
    if (moved <= tolerance) break;
  }
  return proxy;
}

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
