/// The force that a chain of links puts on the hand, in two forms.
///
///   x = p_0    probe                    [m]        f_i = K_i (p_i - p_(i-1)) + extra_i   [N]
///   p_i        proxy of link i          [m]        K_i = k sum_a kappa_a e_a e_a^T       [N/m]
///   J_i        dp_i / dp_(i-1)
///
///   sum          F = sum_i f_i                                                                      (1)
///   consistent   F = sum_i L_i^T f_i,   L_i = J_(i-1) ... J_1,   L_1 = 1                             (2)
///
/// (1) is Ikits 2006, sec. 6.7 with the springs of eq. 6.9. f_i pulls at p_(i-1), which the hand moves by
/// dp_(i-1) = L_i dx. In (2) the hand therefore does the work that the links take up, and no other:
///
///   F . dx = sum_i f_i . dp_(i-1)                                                                   (3)
///
/// so that a chain of links each of which is passive on its own probe is passive too, whatever their springs,
/// and gives nothing on any closed loop. (1) lets f_i act at x in place of p_(i-1): it pushes the hand across
/// to where that link's probe is not free to go, and a loop that goes out on one side of a line and comes
/// back on the other yields energy, at equal springs as well (report/chain_work.h measures it). Along the
/// directions that the links before leave free both forms feel the same.
///
/// What (2) costs: where a link takes hold or lets go, L_i and so F jumps, by no more than |f_i|; and near a
/// centre of curvature the proxy runs faster than the hand, so that |L_i| grows without bound. A pull is
/// carried back at most kMostLever times as strong; beyond that (3) does not hold.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/haptics/constraint.h"
#include "common/math/vec.h"

namespace palpate {

enum class ChainForceForm : std::uint8_t {
  kSum,        ///< (1)
  kConsistent  ///< (2)
};

/// The form that hands feel: on the loops of report/chain_work.h it yields nothing, where the sum yields up
/// to as much as the springs hold.
inline constexpr ChainForceForm kDefaultChainForceForm = ChainForceForm::kConsistent;

/// Adds up the links of one step, in the order of the chain.
class ChainForce {
 public:
  static constexpr double kMostLever = 4.0;  ///< largest |L_i^T f_i| / |f_i|

  explicit ChainForce(ChainForceForm form) noexcept : form_(form) {}

  /// @param stretched p_i - p_(i-1) [m]  @param stiffness k [N/m]
  /// @param damper [N] on p_(i-1), beside the spring
  void add(const LinkUpdate& link, const Vec3& stretched, double stiffness,
           const Vec3& damper = Vec3{0.0}) noexcept {
    const Vec3 along_axes = stretched * link.frame;  // row vector times E is E^T times column
    const Vec3 pull = stiffness * (link.frame * (link.kappa * along_axes)) + damper + link.extra_force;
    force_ += form_ == ChainForceForm::kSum ? pull : carried_back(pull);
    active_ += form_ == ChainForceForm::kSum ? link.extra_force : carried_back(link.extra_force);
    lever_ = link.jacobian * lever_;
  }

  [[nodiscard]] const Vec3& force() const noexcept { return force_; }  ///< F of the links so far [N]
  /// The part of F that comes of extra_i: meant to drive the hand, and not to hold it [N].
  [[nodiscard]] const Vec3& active() const noexcept { return active_; }

 private:
  [[nodiscard]] Vec3 carried_back(const Vec3& pull) const noexcept {
    const Vec3 carried = pull * lever_;
    const double most = kMostLever * glm::length(pull), size = glm::length(carried);
    return size > most ? carried * (most / size) : carried;
  }

  ChainForceForm form_;
  Mat3 lever_{1.0};  ///< L of the next link
  Vec3 force_{0.0};
  Vec3 active_{0.0};
};

/// "sum", "consistent"
[[nodiscard]] inline std::string_view name_of(ChainForceForm form) noexcept {
  return form == ChainForceForm::kSum ? "sum" : "consistent";
}

}  // namespace palpate
