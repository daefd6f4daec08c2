/// How truly a device shows a reference effect: a wall, a groove, a sphere.
///
/// Symbols. x probe, p proxy, s = p - x stretch [m], F force on the hand [N], K stiffness that is asked for.
///
///   felt stiffness     sum F . s / sum s . s     over steps in contact: K, less what caps and slew took
///   leak               |F - (F . u) u| / |F|,  u = s / |s|: force along what should be free
///   given              sum F_(n-1) . (x_n - x_(n-1)) over a contact from touch to release: above zero the
///                      hand got energy from it [J]; the hold alone gives K v T p (haptics/coupling.h)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/work_precision.h"
#include "common/haptics/proxy_chain.h"
#include "common/servo/hand_step.h"

namespace palpate {

enum class FeelEffect : std::uint8_t { kWall, kGroove, kSphere };
inline constexpr std::array<std::string_view, 3> kFeelEffectNames{"wall", "groove", "sphere"};

/// Metres about the middle of the device; z runs towards the hand.
inline constexpr double kFeelSphereRadius = 0.025;
inline constexpr double kFeelGrooveLength = 0.2;  ///< along x, through the middle

/// A wall through the middle that is pushed into along -z; a groove along x; the surface of a sphere.
[[nodiscard]] std::unique_ptr<ProxyChain> feel_chain(FeelEffect effect, double stiffness, double damping);

class FeelScore {
 public:
  /// @param stiffness K.
  explicit FeelScore(double stiffness) : stiffness_(stiffness) {}

  void add(const HandStep& step) noexcept;

  [[nodiscard]] std::size_t steps() const noexcept { return steps_; }
  [[nodiscard]] std::size_t in_contact() const noexcept { return held_; }
  [[nodiscard]] double deepest() const noexcept { return deepest_; }        ///< [m] of stretch
  [[nodiscard]] double largest_force() const noexcept { return largest_; }  ///< [N]
  [[nodiscard]] double free_force() const noexcept { return free_; }        ///< [N] largest in free air
  [[nodiscard]] double leak() const noexcept { return leak_; }  ///< largest, of forces above 0.1 N
  [[nodiscard]] double haptic_stiffness() const noexcept;       ///< [N/m]; 0 without contact
  [[nodiscard]] double most_given() const noexcept { return most_given_; }  ///< [J] by one contact
  [[nodiscard]] std::size_t faults() const noexcept { return faults_; }     ///< steps

  /// Each with its limit.
  [[nodiscard]] std::vector<StabilityCase> cases() const;

 private:
  double stiffness_;
  std::size_t steps_ = 0, held_ = 0, faults_ = 0;
  double deepest_ = 0.0, largest_ = 0.0, free_ = 0.0, leak_ = 0.0;
  double force_stretch_ = 0.0, stretch_stretch_ = 0.0;
  double given_ = 0.0, most_given_ = 0.0;
  bool touching_ = false, known_ = false;
  Vec3 last_probe_{0.0}, last_force_{0.0};
};

}  // namespace palpate
