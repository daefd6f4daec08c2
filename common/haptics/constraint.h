/// A haptic constraint: owns one proxy and moves it after its probe (Ikits 2006, sec. 6.2 and 6.6).
///
/// All positions are in the workspace frame [m]. update() is called once a servo step: it never allocates,
/// locks, throws or logs, and does no more work than its budget allows.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/haptics/chain_settings.h"
#include "common/math/vec.h"

namespace palpate {

/// What a proxy does, in order of precedence: a chain is in the last of its links' states.
enum class HoldState : std::uint8_t {
  kFree,      ///< nothing holds the proxy; it is the probe
  kHeld,      ///< the proxy obeys its constraint
  kFellBack,  ///< it stays where the constraint was last certain: budget used up, or a critical point
  kReleased,  ///< let go in this very step, to be caught again elsewhere
  kOutside,   ///< the probe is where the data says nothing, and nothing holds it
  kFault      ///< the input made no sense
};
inline constexpr int kHoldStateCount = 6;
[[nodiscard]] std::string_view name_of(HoldState state) noexcept;  ///< "fell_back"

/// What one update may cost. Counted, never timed, so that a replay does the same. The defaults are what
/// `report` shows to pay: more lessen neither residual nor force error; half the iterations, or a quarter of
/// the cells, show after jumps of the hand.
struct UpdateBudget {
  int iterations = 128;  ///< pieces passed and Newton steps of a closest-point search
  int cells = 4;         ///< cells by which a line is grown
};

/// A proxy and how it is tied to its probe.
struct LinkUpdate {
  Vec3 proxy{0.0};
  Mat3 frame{1.0};        ///< orthonormal, columns e_a
  Vec3 kappa{1.0};        ///< stiffness factors along e_a, in [0, 1] (eq. 6.9)
  Vec3 damping{0.0};      ///< viscous drag along e_a [N s/m], >= 0: it takes energy from the hand only
  Vec3 extra_force{0.0};  ///< [N] on top of springs and drag
  /// J = dp/dx: how the proxy moves with its probe, all memory of earlier steps held fixed. Dimensionless and
  /// finite. Forces of later links reach the hand through its transpose (chain_force.h).
  ///
  ///   proxy is the probe, or the link says nothing     1, the default
  ///   proxy stays where it is (fixed, stuck, on a tick mark, at the end of its feature)      0
  ///   nearest point of a curve c(s) of arc length, with t = c'      t t^T / (1 - (x - p) . c'')
  ///   nearest point of a surface with normal n, shape operator S = grad n and d = (x - p) . n
  ///                                                              (1 - n n^T) (1 + d S)^-1
  ///   dragged at a distance of tau, with u the unit vector from the last proxy to the probe at distance l
  ///                                                              1 - (tau / l) (1 - u u^T)
  Mat3 jacobian{1.0};
  double residual = 0.0;  ///< [m] distance of the proxy from its own feature
  HoldState state = HoldState::kFree;
  bool jumped = false;   ///< the feature itself changed: the force must start from zero
  bool at_end = false;   ///< its line ends here
  bool crossed = false;  ///< a surface was met, left or passed in this very step
  int iterations = 0;    ///< used
  int cells = 0;         ///< used
};

class Constraint {
 public:
  Constraint() = default;
  Constraint(const Constraint&) = delete;
  Constraint& operator=(const Constraint&) = delete;
  virtual ~Constraint() = default;

  /// Takes new values of the settings that concern it; keeps its proxy.
  virtual void apply(const ChainSettings& settings) noexcept = 0;
  /// Forgets its proxy: the next update catches afresh.
  virtual void reset() noexcept = 0;
  /// The buttons of the device from now on, bit i: button i is down.
  virtual void press(std::uint32_t /*buttons*/) noexcept {}
  /// Time passes before the next update [s], finite, >= 0: for what moves by itself.
  virtual void advance(double /*seconds*/) noexcept {}
  /// Moves the proxy after `probe`, which is finite.
  virtual void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept = 0;
};

}  // namespace palpate
