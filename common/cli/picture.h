/// What the verbs that draw share: options and outputs checked, the picture drawn, timed, compared with a
/// finer one, written and summed up. What is in the picture comes from a PictureMaker.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/cli/summaries.h"
#include "common/compose/resampled_volume.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/render/scene_view.h"

namespace palpate {

/// A scene to be drawn.
struct DrawnScene {
  SceneView view;
  std::string field;
  std::string what;  ///< in words: "300 lines"
  std::size_t lines = 0;
  std::size_t points = 0;
  std::size_t voxels = 0;
  double seconds_trace = 0.0;
  std::vector<TakenScalar> volumes;  ///< of a flow, what drawing them as volumes cost
};

struct PictureMaker {
  /// Refuses what can be refused before the input is opened. @throws Error.
  std::function<void(const Document&)> check;
  /// Refuses what the input does not have, before anything is read. @throws Error.
  std::function<void(const Document&, const Input&)> check_input;
  /// @param aspect width / height. @throws Error, Cancelled.
  std::function<DrawnScene(Input&, const Document&, const VerbContext&, double aspect)> make;
};

/// Refuses a path of a hand, a mode and settings of touch that cannot be. @throws Error.
void check_hand(std::span<const HapticMode> modes, const Document& given);

/// Runs a verb that draws. @throws Error, Cancelled.
ExitCode draw_picture(const PictureMaker& maker, const Document& options, const VerbContext& context);

}  // namespace palpate
