/// What the picture shows of a hand that has followed a recorded path: the headless twin of the window.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/device/probe_path.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/proxy_chain.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Time between stream balls [data units].
[[nodiscard]] double ball_interval(const VectorField& field, const Workspace& workspace) noexcept;

/// Over which forces the colours of a path through tensors spread: up to the most that their thresholds let the hand
/// feel, which may be little of what the device could show. None where that is none.
[[nodiscard]] std::optional<ValueRange> tension_range(const ChainSettings& settings, double force_cap);

/// The proxies of all links [data units], in the order of the chain.
[[nodiscard]] std::vector<Vec3> link_proxies(const ChainStep& step, const Workspace& workspace);

/// The fixtures that the options ask for are added to `scene` and, drawn, to `view`; what is to be known of them is
/// returned, a sentence each. @throws Error as FixtureStore::list().
[[nodiscard]] std::vector<std::string> take_fixtures(const TouchOptions& options, const Box& bounds,
                                                     HapticScene& scene, SceneView& view, Progress* progress);

/// A hand that follows a recorded path through a chain, a step a row, as far as it is asked to.
class PathHand {
 public:
  /// @param options say what the hand can bear, and what of it is shown. @param style of the scene's lines.
  PathHand(std::vector<PathRow> path, HapticChain made, const HapticScene& scene, const TouchOptions& options,
           const LineStyle& style);
  ~PathHand();
  PathHand(const PathHand&) = delete;
  PathHand& operator=(const PathHand&) = delete;

  /// Goes on to where `part` of the path's time is over, and describes the hand there: probe and proxies, the line that
  /// is followed then, the tensor at the proxy of an image of tensors, and where the first proxy has been. A hand does not
  /// go back.
  /// @param part in [0, 1]; 1 is the last row, whatever its time.
  [[nodiscard]] ProbeView at(double part);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The speed for which a velocity's arrow has its full length: that of the fastest lines, without outliers.
[[nodiscard]] double reference_speed(const SceneView& view);

/// Makes the scene's own lines step back, so that what the hand does stands out.
void fade_lines(SceneView& view);

}  // namespace palpate
