/// A mouse moves the probe in the plane of the view, its wheel along the view, both along one axis if locked
/// (probe_mouse.h). While a line holds the proxy the probe is moved from the proxy's depth, so that what is
/// followed may lead away from the viewer; along surfaces it is led by whoever knows them (surface_drag.h).
#pragma once

#include "common/hand/technique/interaction_technique.h"

namespace palpate {

class DesktopTechnique final : public InteractionTechnique {
 public:
  void put(const Vec3& probe) noexcept override { intent_.probe = probe; }
  bool take(const HandEvent& event, const HandsView& view) noexcept override;
};

}  // namespace palpate
