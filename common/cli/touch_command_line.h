/// The command line's spelling of what the hand feels: group "Touch".
#pragma once

#include <string>

#include "common/cli/explorer.h"
#include "common/cli/scene_options.h"
#include "common/scene/options.h"

namespace palpate {

/// Binds the options to `touch`, which outlives `options`. @param kind of the explorer's fields.
void add_touch_options(SceneOptions& options, TouchOptions& touch, FieldKind kind);

/// @throws Error (usage) where a value is below zero, infinite or no number, and may not be.
void check_touch_options(const TouchOptions& touch);

/// @param option as it is typed, for the message.
/// @throws Error (usage) unless `value` is finite and not below zero.
void check_not_negative(double value, const std::string& option);

}  // namespace palpate
