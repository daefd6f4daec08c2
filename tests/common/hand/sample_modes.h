/// Two ways of feeling a flow, for tests: held by a streamline, and dragged.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/isotropic_drag.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/constraint/tick_marks.h"

namespace palpate::test {

inline std::vector<HapticMode> sample_modes() {
  const auto streamline = [](const HapticScene& scene) -> HapticChain {
    auto line = std::make_shared<LiveLine>(scene.field, LiveLine::kFollowTolerance, scene.threads);
    auto held = std::make_unique<StreamlineConstraint>(line, scene.workspace);
    const StreamlineConstraint& followed = *held;
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::move(held));
    if (scene.settings.ticks.interval > 0.0) links.push_back(std::make_unique<TickMarks>(followed));
    return {std::make_unique<ProxyChain>(std::move(links), scene.settings), std::move(line)};
  };
  const auto drag = [](const HapticScene& scene) -> HapticChain {
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::make_unique<IsotropicDrag>());
    return {std::make_unique<ProxyChain>(std::move(links), scene.settings), nullptr};
  };
  return {{"streamline", "held by a line", streamline}, {"isotropic", "dragged", drag}};
}

}  // namespace palpate::test
