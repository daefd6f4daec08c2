/// Slices beside a volume, as words: `--layout`, `--cross`, `--slab` and the others of their heading.
#pragma once

#include "common/math/vec.h"
#include "common/render/slice/slice_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// @param bounds of the volume: in its middle lies what is not given.
/// @throws Error (usage) for what is no place or turn.
[[nodiscard]] SlicePanes slice_panes_of(const PanesOptions& options, const Box& bounds);

/// The inverse.
void keep_panes(const SlicePanes& panes, const Box& bounds, PanesOptions& options);

}  // namespace palpate
