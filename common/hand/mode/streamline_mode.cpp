// The mode `streamline`: held by the streamline through the probe.
#include <utility>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/streamline.h"

namespace palpate {

HapticChain make_streamline(const HapticScene& scene) {
  auto line = std::make_shared<LiveLine>(scene.field, LiveLine::kFollowTolerance, scene.threads);
  auto streamline = std::make_unique<StreamlineConstraint>(line, scene.workspace);
  const StreamlineConstraint& followed = *streamline;
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(streamline));
  // Without tick marks the chain ends with the streamline's proxy, which is then the one that is logged.
  if (scene.settings.ticks.interval > 0.0) links.push_back(std::make_unique<TickMarks>(followed));
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  made.followed = std::move(line);
  return made;
}

}  // namespace palpate
