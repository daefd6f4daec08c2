/// The proxy chain (Ikits 2006, sec. 6.7): constraints in series, each proxy the probe of the next.
///
///   f_i = K_i (p_i - p_(i-1)),   K_i = k sum_a kappa_a e_a e_a^T,   p_0 the probe
///
/// is the force of a spring: eq. 6.1 in the sense in which it pulls the probe to its proxy; chain_force.h
/// adds them up on the hand. The damper of that equation, which would spike where a proxy jumps, acts on the
/// hand instead, along the axes of a link that asks for it:
///
///   F -= sum_i B_i xdot,   B_i = sum_a b_a e_a e_a^T,   b_a >= 0, so that F . xdot <= 0
///
/// and with the damping b of the coupling, at p_(i-1) beside the spring and added up as springs are, on what
/// link i holds back of the motion:
///
///   -b (1 - J_i) u_i,   u_i = J_(i-1) ... J_1 xdot
///
/// left out where it would push (u_i . (1 - J_i) u_i < 0: a proxy that outruns its probe). A viscosity drags the
/// hand everywhere: F -= b_v xdot.
///
/// How stiff a link feels beside the others' forces across it is said (perceived_stiffness.h, eq. 6.11), and made up for
/// where ChainSettings::even_stiffness asks for it: the link's spring is c_i k_i, c_i of (1) there, no stiffer than that.
/// Such a chain is no potential's: the passivity controller looks after it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/base/index.h"
#include "common/haptics/chain_force.h"
#include "common/haptics/constraint.h"

namespace palpate {

/// The result of one servo step, workspace frame.
struct ChainStep {
  static constexpr int kMaxLinks = 12;  ///< four of a mode, and four fixtures that rub

  Vec3 force{0.0};                        ///< [N] before the safety stage
  Vec3 active{0.0};                       ///< [N] part of it that is meant to drive the hand
  std::array<Vec3, kMaxLinks> proxies{};  ///< [m], in the order of the chain
  int links = 0;
  HoldState state = HoldState::kFree;
  double residual = 0.0;  ///< [m] of the last proxy from its own feature
  bool jumped = false;    ///< a feature changed: the force must start from zero
  bool at_end = false;    ///< a line that holds the hand ends here
  bool crossed = false;   ///< a surface was met, left or passed
  double perceived_stiffness =
      0.0;  ///< [N/m] of the spring that feels softest beside the others; 0: none pulls
  int iterations = 0;
  int cells = 0;

  /// The last proxy; the probe itself where the chain is empty.
  [[nodiscard]] Vec3 proxy(const Vec3& probe) const noexcept {
    return links > 0 ? proxies[as_size(links - 1)] : probe;
  }
};

class ProxyChain {
 public:
  /// @pre at most ChainStep::kMaxLinks links; valid settings.
  ProxyChain(std::vector<std::unique_ptr<Constraint>> links, const ChainSettings& settings);

  void apply(const ChainSettings& settings) noexcept;
  [[nodiscard]] const ChainSettings& settings() const noexcept { return settings_; }
  void set_budget(const UpdateBudget& budget) noexcept { budget_ = budget; }
  /// How the links' springs add up on the hand; kDefaultChainForceForm to begin with.
  void set_force_form(ChainForceForm form) noexcept { form_ = form; }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(links_.size()); }

  /// Puts links in front of its own, and behind them. @pre at most ChainStep::kMaxLinks in all.
  void surround(std::vector<std::unique_ptr<Constraint>> before,
                std::vector<std::unique_ptr<Constraint>> after);

  /// Forgets all proxies.
  void reset() noexcept;
  /// The buttons of the device from the next step on.
  void press(std::uint32_t buttons) noexcept;
  /// Time passes before the next step [s], finite, >= 0.
  void advance(double seconds) noexcept;
  /// Moves the proxies after `probe`, one after the other.
  /// @param velocity xdot of the hand [m/s]. @pre both finite.
  [[nodiscard]] ChainStep step(const Vec3& probe, const Vec3& velocity = Vec3{0.0}) noexcept;

 private:
  std::vector<std::unique_ptr<Constraint>> links_;
  ChainSettings settings_;
  UpdateBudget budget_;
  ChainForceForm form_ = kDefaultChainForceForm;
};

}  // namespace palpate
