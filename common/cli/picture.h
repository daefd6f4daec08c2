/// What the verbs that draw share: options and outputs checked, the picture drawn, timed, compared with a
/// finer one, written and summed up. What is in the picture comes from a PictureMaker.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/cli/summaries.h"
#include "common/compose/resampled_volume.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/probe_picture.h"
#include "common/render/scene_view.h"

namespace palpate {

/// A scene to be drawn.
struct DrawnScene {
  SceneView view;
  std::string field;
  std::string what;  ///< in words: "300 lines"
  std::size_t lines = 0;
  std::size_t points = 0;
  std::size_t seeds_left_out = 0;  ///< TraceResult::seeds_left_out
  std::size_t voxels = 0;
  double seconds_trace = 0.0;
  std::vector<TakenScalar> volumes;  ///< of a flow, what drawing them as volumes cost
  /// The hand on --path at a part of its time, asked for in rising order; empty: there is none.
  std::function<ProbeView(double part)> hand;
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

/// Has `hand` follow its path: to its end, for a film of that to its begin.
void show_hand(std::shared_ptr<PathHand> hand, const Document& options, DrawnScene& drawn);

/// Runs a verb that draws. @throws Error, Cancelled.
ExitCode draw_picture(const PictureMaker& maker, const Document& options, const VerbContext& context);

}  // namespace palpate
