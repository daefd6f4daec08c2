/// What can be edited of the links that take a few numbers each: a struct a link, with defaults, bounds and names.
/// Apart from the links themselves, which need all settings (chain_settings.h).
#pragma once

#include <cmath>

#include "common/haptics/transfer_function.h"

namespace palpate {

/// What can be edited of a streamline that is followed. Apart from streamline.h, which needs all settings.
struct StreamlineSettings {
  double release_distance = 0.010;  ///< stretch at which it lets go [m]
  double speed_force = 0.0;         ///< [N] along the line where the flow is fastest; negative: against it

  bool operator==(const StreamlineSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(release_distance) && release_distance > 0.0 && std::isfinite(speed_force);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("streamline.release", self.release_distance);
    visit("streamline.speed_force", self.speed_force);
  }
};

/// What can be edited of tick marks. Apart from detent_marks.h, which needs all settings.
struct TickSettings {
  double interval = 0.0;    ///< time of the flow between two marks [data units]; 0: none
  double stiffness = 0.25;  ///< kappa of the marks, in [0, 1]

  bool operator==(const TickSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(interval) && interval >= 0.0 && stiffness >= 0.0 && stiffness <= 1.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("ticks.interval", self.interval);
    visit("ticks.stiffness", self.stiffness);
  }
};

/// What can be edited of isotropic drag. Apart from anisotropy_drag.h, which needs all settings.
struct DragSettings {
  double threshold = 0.004;  ///< tau: distance at which the proxy follows [m]

  bool operator==(const DragSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept { return std::isfinite(threshold) && threshold >= 0.0; }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("drag.threshold", self.threshold);
  }
};

/// What can be edited of the shapes that widgets are made of (shape.h, which needs all settings).
struct ShapeSettings {
  double snap_distance = 0.005;     ///< a probe that comes this near is held [m]
  double release_distance = 0.010;  ///< stretch at which it is let go, no less than the former [m]

  bool operator==(const ShapeSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return snap_distance > 0.0 && release_distance >= snap_distance && std::isfinite(release_distance);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("shape.snap", self.snap_distance);
    visit("shape.release", self.release_distance);
  }
};

/// What can be edited of a hand that is carried along a curve (shape.h).
struct CarrySettings {
  double speed = 0.0;  ///< [m/s] at which the proxy goes along it; 0: the hand moves it
  double force = 1.0;  ///< [N] along the curve, at most: a hand that holds back or runs ahead feels no more

  bool operator==(const CarrySettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(speed) && speed >= 0.0 && std::isfinite(force) && force >= 0.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("carry.speed", self.speed);
    visit("carry.force", self.force);
  }
};

/// What can be edited of how surfaces rub (surface_friction.h).
struct ContactSettings {
  double sticking = 0.0;  ///< coefficient up to which a hand sticks
  double sliding = 0.0;   ///< coefficient while it slides, no more than the former
  double grain = 0.0;     ///< way by which it sticks and slips as on sandpaper [m]; 0: smooth

  bool operator==(const ContactSettings&) const = default;

  /// Whether anything rubs.
  [[nodiscard]] bool rubs() const noexcept { return sticking > 0.0 || grain > 0.0; }

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(sticking) && sliding >= 0.0 && sliding <= sticking && std::isfinite(grain) &&
           grain >= 0.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("contact.sticking", self.sticking);
    visit("contact.sliding", self.sliding);
    visit("contact.grain", self.grain);
  }
};

/// What can be edited of how events are felt (servo/event_pulse.h).
struct EventSettings {
  double force = 0.0;        ///< of the vibration at its beginning [N]; 0: none
  double frequency = 150.0;  ///< [Hz]

  static constexpr double kHighest = 400.0;  ///< [Hz] that a servo of 1 kHz can show

  bool operator==(const EventSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(force) && force >= 0.0 && frequency > 0.0 && frequency <= kHighest;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("events.force", self.force);
    visit("events.frequency", self.frequency);
  }
};

/// What can be edited of textures that tell of noise. Apart from noise_texture.h, which needs all settings.
struct TextureSettings {
  bool by_noise = false;  ///< whether modes of a volume have one; takes effect when the chain is built

  /// Size of its grain [m], by the noise as a part of the range of the values (field/noise_field.h).
  HapticTransferFunction grain{{0.001, 0.0}, {0.02, 0.002}};

  bool operator==(const TextureSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept { return grain.lowest() >= 0.0 && grain.highest() < 1.0; }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("texture.by_noise", self.by_noise);
    visit("texture.grain", self.grain);
  }
};

/// What can be edited of anisotropy drag. Apart from anisotropy_drag.h, which needs all settings.
struct AnisotropySettings {
  /// tau of eqs. 8.6 to 8.11: drag threshold [m] over a sum of anisotropies in [0, 1]. It is 0 at 0 and never
  /// falls: axes along which nothing is anisotropic are free, whichever way they lie.
  HapticTransferFunction tau{{0.0, 0.0}, {1.0, 0.008}};

  bool operator==(const AnisotropySettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return tau(0.0) == 0.0 && tau.lowest() >= 0.0 && tau.rising() && std::isfinite(tau.highest());
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("anisotropy.tau", self.tau);
  }
};

/// What can be edited of fibres that are felt on a layer. Apart from the constraints, which need all
/// settings.
struct FibreSettings {
  double spacing = 0.004;  ///< of the grooves: stretch across a fibre at which the next one catches [m]
  double least_friction = 0.0005;  ///< tau_min: drag threshold where fibres lie in the layer [m]
  double most_friction = 0.006;    ///< tau_max: where they stand on it [m]

  bool operator==(const FibreSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(spacing) && spacing > 0.0 && least_friction >= 0.0 &&
           most_friction >= least_friction && std::isfinite(most_friction);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("fibre.spacing", self.spacing);
    visit("fibre.least_friction", self.least_friction);
    visit("fibre.most_friction", self.most_friction);
  }
};

}  // namespace palpate
