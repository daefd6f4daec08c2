#include "lab/hand/rivals/force_balance.h"

#include <algorithm>
#include <array>

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

}  // namespace palpate
