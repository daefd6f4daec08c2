/// The constraint pipe (Ikits 2006, sec. 2.3.3 and 6.7): one proxy that is put through all constraints, again
/// and again, until none of them moves it any more.
///
///   p <- U_n(... U_2(U_1(p))),   begun at the probe x                                               (1)
///   F = k (p - x)                                                                                   (2)
///
/// (1) are alternating projections: they come to a place that all constraints allow if there is one, the more
/// slowly the flatter the constraints cross, and to none in particular otherwise. The one stretch x - p says
/// nothing of any single constraint, so that the last of them can only be let go by the length of it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/haptics/constraint.h"
#include "common/math/vec.h"

namespace palpate {

struct ConstraintPipeSettings {
  ChainSettings chain;              ///< of the constraints, and k
  double release_distance = 0.005;  ///< stretch beyond which the last constraint is let go, for good [m]
  double tolerance = 1e-9;          ///< (1) ends when no constraint moves the proxy by more [m]
  int rounds = 4096;                ///< or after so many
};

struct ConstraintPipeStep {
  Vec3 proxy{0.0};
  Vec3 force{0.0};        ///< [N]
  bool agreed = false;    ///< whether (1) came to rest
  bool released = false;  ///< whether the last constraint has been let go, now or before
  int rounds = 0;
};

class ConstraintPipe {
 public:
  /// @pre at least one link.
  ConstraintPipe(std::vector<std::unique_ptr<Constraint>> links, const ConstraintPipeSettings& settings);

  [[nodiscard]] ConstraintPipeStep step(const Vec3& probe) noexcept;

 private:
  [[nodiscard]] ConstraintPipeStep settle(const Vec3& probe) noexcept;

  std::vector<std::unique_ptr<Constraint>> links_;
  ConstraintPipeSettings settings_;
  std::size_t active_ = 0;  ///< links that still hold
};

// Force balance (Ikits 2006, sec. 2.3.3 and 6.7): one proxy, where the pull of the probe and the reactions
// of linear primitives balance. The primitives are placed anew each step, by what the data is at the last
// proxy.
//
//   line    through a along t                   g = (1 - t t^T) (p - a)
//   plane   through a, free on the side of n    g = min(n . (p - a), 0) n
//
// A primitive that is left by g pulls back along it with its strength s, and with up to s while it is not:
//
//   p = argmin k/2 |p - x|^2 + sum_i s_i |g_i(p)|                                                   (1)
//
// or, with reactions f_i, |f_i| <= s_i, one after another until they come to rest,
//
//   p = x + sum_i f_i / k,   f_i <- that which alone would bring g_i to 0, cut to s_i               (2)
//
// the dual of (1) by coordinates. The primitives know nothing of the steps before: what the proxy gives way
// by is forgotten, and so the proxy leaves curve and surface for good.

struct HapticPrimitive {
  enum class Kind : std::uint8_t { kLine, kPlane };
  Kind kind = Kind::kLine;
  Vec3 through{0.0};      ///< a [m]
  Vec3 direction{0.0};    ///< t or n, of unit length
  double strength = 0.0;  ///< s [N]
};

/// The proxy of (1), to `tolerance` [m] or 4096 rounds of (2). @pre at most kMostPrimitives; stiffness > 0.
[[nodiscard]] Vec3 balanced_proxy(const Vec3& probe, double stiffness,
                                  std::span<const HapticPrimitive> primitives,
                                  double tolerance = 1e-12) noexcept;
inline constexpr std::size_t kMostPrimitives = 4;

}  // namespace palpate
