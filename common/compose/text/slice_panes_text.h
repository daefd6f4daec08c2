/// Slices beside a volume, as words: `--layout`, `--cross`, `--slab` and the others of their heading.
#pragma once

#include "common/math/vec.h"
#include "common/render/volume/volume_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// @param bounds of the volume: in its middle lies what is not given.
/// @throws Error (usage) for what is no place or turn.
[[nodiscard]] SlicePanes slice_panes_of(const PanesOptions& options, const Box& bounds);

/// What of the panes of a volume shows nothing, in words: settings of slices where there are none, a crosshair outside, a
/// second image that is not there; empty: nothing.
[[nodiscard]] std::string panes_note(const VolumeView& volume);

/// The inverse.
void keep_panes(const SlicePanes& panes, const Box& bounds, PanesOptions& options);

}  // namespace palpate
