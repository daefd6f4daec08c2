/// What can be edited while the hand is held, without letting go. Workspace units unless stated.
///
/// Each constraint has a struct of its own, in constraint/, with its defaults, its bounds and the names by
/// which texts know its values (settings_text.h). All of them are plain values, copied as a whole: to the
/// servo through a buffer that never waits, and into recordings.
#pragma once

#include <cmath>

#include "common/haptics/constraint/grid_axis_settings.h"
#include "common/haptics/constraint/isosurface_settings.h"
#include "common/haptics/constraint/linear_settings.h"
#include "common/haptics/constraint/link_settings.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/haptics/transfer_function.h"

namespace palpate {

struct PassivitySettings {
  double from_links = 2.0;    ///< chains of that many links and more are controlled; a large number: none
  double max_damping = 20.0;  ///< largest alpha [N s/m]; safe while it stays below m / T of the device
  double dead_speed = 1e-4;   ///< [m/s] a slower hand is not damped: there alpha would be that of noise

  bool operator==(const PassivitySettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(from_links) && std::isfinite(max_damping) && max_damping >= 0.0 &&
           std::isfinite(dead_speed) && dead_speed >= 0.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("passivity.from_links", self.from_links);
    visit("passivity.max_damping", self.max_damping);
    visit("passivity.dead_speed", self.dead_speed);
  }
};

struct ForceFieldSettings {
  double strength = 1.0;     ///< [N] of direct display where the flow is fastest, and of a strong vortex
  double damping = 5.0;      ///< [N s/m] of transverse damping and density drag, where they are full
  double fade_speed = 0.05;  ///< part of the largest speed below which transverse damping fades, in (0, 1]

  /// Part of the damping that density drag has, in [0, 1], by value from 0, the lowest, to 1, the highest.
  HapticTransferFunction density{{0.0, 0.0}, {1.0, 1.0}};

  bool operator==(const ForceFieldSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(strength) && std::isfinite(damping) && damping >= 0.0 && fade_speed > 0.0 &&
           fade_speed <= 1.0 && density.lowest() >= 0.0 && density.highest() <= 1.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("force_field.strength", self.strength);
    visit("force_field.damping", self.damping);
    visit("force_field.fade_speed", self.fade_speed);
    visit("force_field.density", self.density);
  }
};

struct ChainSettings {
  double stiffness = 200.0;     ///< k of the coupling [N/m]
  double damping = 0.0;         ///< b of the coupling, where links hold the hand back [N s/m]
  double viscosity = 0.0;       ///< drag of the hand everywhere, as in a syrup [N s/m]
  double even_stiffness = 0.0;  ///< up to which springs make up for forces across them [N/m]; 0: they do not
  PassivitySettings passivity;
  StreamlineSettings streamline;
  TickSettings ticks;
  DragSettings drag;
  ShapeSettings shape;
  CarrySettings carry;
  ContactSettings contact;
  EventSettings events;
  GridAxisSettings grid_axis;
  PlaneWidgetSettings plane_widget;
  IsosurfaceSettings isosurface;
  LinearSettings linear;
  TextureSettings texture;
  AnisotropySettings anisotropy;
  FibreSettings fibre;
  ForceFieldSettings force_field;

  bool operator==(const ChainSettings&) const = default;

  /// Whether every value can be used: finite, none below its least, kappa at most one.
  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(stiffness) && stiffness >= 0.0 && std::isfinite(damping) && damping >= 0.0 &&
           std::isfinite(viscosity) && viscosity >= 0.0 && std::isfinite(even_stiffness) &&
           even_stiffness >= 0.0 && passivity.valid() && streamline.valid() && ticks.valid() &&
           drag.valid() && shape.valid() && carry.valid() && contact.valid() && events.valid() &&
           grid_axis.valid() && plane_widget.valid() && isosurface.valid() && linear.valid() &&
           texture.valid() && anisotropy.valid() && fibre.valid() && force_field.valid();
  }

  /// Calls visit(name, value) for every value, always in the same order: the one table of names.
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("stiffness", self.stiffness);
    visit("damping", self.damping);
    visit("viscosity", self.viscosity);
    visit("even_stiffness", self.even_stiffness);
    PassivitySettings::each(self.passivity, visit);
    StreamlineSettings::each(self.streamline, visit);
    TickSettings::each(self.ticks, visit);
    DragSettings::each(self.drag, visit);
    ShapeSettings::each(self.shape, visit);
    CarrySettings::each(self.carry, visit);
    ContactSettings::each(self.contact, visit);
    EventSettings::each(self.events, visit);
    GridAxisSettings::each(self.grid_axis, visit);
    PlaneWidgetSettings::each(self.plane_widget, visit);
    IsosurfaceSettings::each(self.isosurface, visit);
    LinearSettings::each(self.linear, visit);
    TextureSettings::each(self.texture, visit);
    AnisotropySettings::each(self.anisotropy, visit);
    FibreSettings::each(self.fibre, visit);
    ForceFieldSettings::each(self.force_field, visit);
  }
};

}  // namespace palpate
