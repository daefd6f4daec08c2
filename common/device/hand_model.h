/// A simulated hand on a simulated arm: what it weighs and how stiffly it holds, and where it wants to be.
///
/// The hand moves with the arm as one mass, on a spring and a damper to where the operator wants to be; both
/// are passive. (More masses in between fit measured hands better above some 30 Hz: Fu & Cavusoglu 2012.) The
/// two grips are representative of hands on a stylus (Kuchenbecker, Park & Niemeyer 2003; Fu & Cavusoglu
/// 2012), and no measurement.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/math/vec.h"

namespace palpate {

struct HandImpedance {
  double mass = 0.0;       ///< that moves with the arm [kg]
  double damping = 0.0;    ///< [N s/m]
  double stiffness = 0.0;  ///< [N/m]

  bool operator==(const HandImpedance&) const = default;
};

inline constexpr HandImpedance kUnheld{};  ///< the arm is free
inline constexpr HandImpedance kRelaxedHand{.mass = 0.05, .damping = 2.0, .stiffness = 80.0};
inline constexpr HandImpedance kFirmHand{.mass = 0.15, .damping = 8.0, .stiffness = 500.0};

/// "relaxed" or "firm". @throws Error (usage) for another name.
[[nodiscard]] const HandImpedance& find_hand(std::string_view name);

/// How an operator follows a target that they see.
///
///   w(t) <- w(t - dt) + (1 - e^(-dt/tau_n)) (y(t - tau_r) - w(t - dt)),   r(t) = w(t) + n(t)
///
/// y the target, tau_r the reaction delay, tau_n the lag of arm and muscles: the crossover model of McRuer &
/// Jex 1967 with the gain of a good tracker. n is physiological tremor: sines of 8 to 12 Hz (Elble & Koller
/// 1990) on each axis, in phases that only the seed decides.
struct OperatorSettings {
  double reaction = 0.20;  ///< tau_r [s], in [0, Operator::kLongestReaction]
  double lag = 0.10;       ///< tau_n [s], >= 0
  double tremor = 5e-5;    ///< root of the mean square of n on each axis [m]
  std::uint64_t seed = 1;  ///< of the tremor
};

/// The same targets at the same times give the same bits. @rt Safe but for the constructor.
class Operator {
 public:
  static constexpr double kLongestReaction = 0.4;  ///< [s]

  explicit Operator(const OperatorSettings& settings = {}) noexcept;

  /// Is at `target`, and has been for long.
  void place(double time, const Vec3& target) noexcept;
  /// Sees `target` [m] at `time` [s], which does not fall.
  /// @return r, where the hand wants to be from now on.
  Vec3 follow(double time, const Vec3& target) noexcept;
  /// Where the operator wants to be, without tremor.
  [[nodiscard]] const Vec3& aim() const noexcept { return aim_; }

 private:
  static constexpr std::size_t kSines = 3;
  static constexpr double kSpacing = 0.001;  // [s] of remembered targets
  static constexpr std::size_t kMemory = 512;
  static_assert(kSpacing * static_cast<double>(kMemory - 2) > kLongestReaction);

  struct Seen {
    double time = 0.0;
    Vec3 target{0.0};
  };
  struct Sine {
    double angular = 0.0;  ///< [rad/s]
    double phase = 0.0;
  };

  [[nodiscard]] const Seen& seen(std::size_t back) const noexcept {
    return memory_[(newest_ + kMemory - back) % kMemory];
  }
  [[nodiscard]] Vec3 seen_at(double time) const noexcept;
  [[nodiscard]] Vec3 tremor_at(double time) const noexcept;

  OperatorSettings settings_;
  std::array<std::array<Sine, kSines>, 3> tremor_{};  ///< by axis
  std::array<Seen, kMemory> memory_{};
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  Vec3 aim_{0.0};
  double time_ = 0.0;
};

}  // namespace palpate
