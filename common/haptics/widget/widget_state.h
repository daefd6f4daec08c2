/// The states of the cutting-plane widget, as one table: README.md beside it is the same for readers, and a
/// test holds both against each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/index.h"

namespace palpate {

enum class WidgetState : std::uint8_t {
  kFree,       ///< no plane and no sphere is near
  kOnPlane,    ///< explores the cutting plane
  kOnSphere,   ///< is on the sphere, ready to turn the plane
  kTranslate,  ///< moves the plane
  kRotate      ///< turns it
};
inline constexpr int kWidgetStateCount = 5;
[[nodiscard]] constexpr std::string_view name_of(WidgetState state) noexcept {  ///< "on_plane"
  constexpr std::array<std::string_view, kWidgetStateCount> kNames{"free", "on_plane", "on_sphere",
                                                                   "translate", "rotate"};
  return kNames[as_size(state)];
}

enum class WidgetEvent : std::uint8_t {
  kNearPlane,   ///< the probe is within reach of a plane, and of no sphere
  kNearSphere,  ///< within reach of a sphere's surface
  kFar,         ///< within reach of neither
  kPress,       ///< the button goes down
  kRelease,     ///< and up
  kLost         ///< the hand is gone, or the chain starts anew
};
inline constexpr int kWidgetEventCount = 6;
[[nodiscard]] constexpr std::string_view name_of(WidgetEvent event) noexcept {  ///< "near_plane"
  constexpr std::array<std::string_view, kWidgetEventCount> kNames{"near_plane", "near_sphere", "far",
                                                                   "press",      "release",     "lost"};
  return kNames[as_size(event)];
}

struct WidgetTransition {
  WidgetState from;
  WidgetEvent event;
  WidgetState to;
};

/// All that change the state; everything else leaves it.
inline constexpr std::array kWidgetTransitions{
    WidgetTransition{WidgetState::kFree, WidgetEvent::kNearPlane, WidgetState::kOnPlane},
    WidgetTransition{WidgetState::kFree, WidgetEvent::kNearSphere, WidgetState::kOnSphere},
    WidgetTransition{WidgetState::kOnPlane, WidgetEvent::kNearSphere, WidgetState::kOnSphere},
    WidgetTransition{WidgetState::kOnPlane, WidgetEvent::kFar, WidgetState::kFree},
    WidgetTransition{WidgetState::kOnPlane, WidgetEvent::kPress, WidgetState::kTranslate},
    WidgetTransition{WidgetState::kOnPlane, WidgetEvent::kLost, WidgetState::kFree},
    WidgetTransition{WidgetState::kOnSphere, WidgetEvent::kNearPlane, WidgetState::kOnPlane},
    WidgetTransition{WidgetState::kOnSphere, WidgetEvent::kFar, WidgetState::kFree},
    WidgetTransition{WidgetState::kOnSphere, WidgetEvent::kPress, WidgetState::kRotate},
    WidgetTransition{WidgetState::kOnSphere, WidgetEvent::kLost, WidgetState::kFree},
    WidgetTransition{WidgetState::kTranslate, WidgetEvent::kRelease, WidgetState::kOnPlane},
    WidgetTransition{WidgetState::kTranslate, WidgetEvent::kLost, WidgetState::kFree},
    WidgetTransition{WidgetState::kRotate, WidgetEvent::kRelease, WidgetState::kOnSphere},
    WidgetTransition{WidgetState::kRotate, WidgetEvent::kLost, WidgetState::kFree},
};

[[nodiscard]] constexpr WidgetState state_after(WidgetState state, WidgetEvent event) noexcept {
  for (const WidgetTransition& each : kWidgetTransitions) {
    if (each.from == state && each.event == event) return each.to;
  }
  return state;
}

}  // namespace palpate
