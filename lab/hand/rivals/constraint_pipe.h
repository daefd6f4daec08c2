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

#include <memory>
#include <vector>

#include "common/haptics/constraint.h"

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

}  // namespace palpate
