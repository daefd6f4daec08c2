/// Options of the group "Touch" as the haptics want them.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/device/device.h"
#include "common/field/vector_field.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/touch_choice.h"
#include "common/haptics/chain_settings.h"
#include "common/haptics/workspace.h"
#include "common/scene/document/document.h"
#include "common/servo/recording.h"

namespace palpate {

/// @param diagonal of the data [data units].
/// @param frame of the field that is felt.
[[nodiscard]] Workspace touch_workspace(const TouchOptions& options, double diagonal,
                                        const LocalFrame& frame);

/// The tick interval is 0 where none is given, or 'auto' is.
/// @throws Error (usage) for values that make no sense.
[[nodiscard]] ChainSettings touch_settings(const TouchOptions& options);
/// What the user can choose, as the options have it: mode, settings, ticks and strokes; the rest as in `now`.
/// @throws Error (usage) for an unknown mode, too.
[[nodiscard]] TouchChoice touch_choice(const TouchOptions& options, const std::vector<HapticMode>& modes,
                                       TouchChoice now = {});
/// Writes the choice into `options`: the inverse. @param mode name of choice.mode.
void keep_touch(const TouchChoice& choice, const std::string& mode, TouchOptions& options);
/// The settings with 'auto' worked out. @param field null for a volume of scalars alone.
[[nodiscard]] ChainSettings touch_settings(const TouchOptions& options, const VectorField* field,
                                           const Workspace& workspace);
[[nodiscard]] inline bool wants_ticks(const TouchOptions& options) { return !options.ticks.empty(); }

/// A replay takes mode, settings and caps from its recording.
/// @throws Error (usage) where `--replay` is given with one of these, or with another device.
void check_replay_options(const Document& options);

/// One sentence for each input that is not the file that was recorded.
/// @throws Error (bad input) where an input cannot be read; Cancelled.
[[nodiscard]] std::vector<std::string> changed_since(const RecordingHeader& header, const Document& options,
                                                     Progress& progress);

/// Caps of the force; a path or a mouse may be as fast as it likes.
/// @throws Error (usage).
[[nodiscard]] DeviceLimits touch_limits(const TouchOptions& options);

}  // namespace palpate
