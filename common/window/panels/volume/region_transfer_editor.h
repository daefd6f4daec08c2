/// The editor of a transfer function of value and gradient magnitude: its regions over the histogram of both.
#pragma once

#include <optional>

#include "common/render/volume/voxels/value_gradient.h"
#include "common/window/controls/region_transfer_edit.h"

namespace palpate {

/// Corners and regions are dragged; a double click adds a region, a right click takes one out; the one that
/// was touched last has its shape, colour, opacity and border below. The histogram is grey by the logarithm
/// of its counts, so that rare places show.
/// @param id apart from other editors of the panel.
/// @param felt value at the probe, marked; none: no hand is there.
/// @return whether `transfer` changed.
bool draw_region_editor(const char* id, const PlaceHistogram& histogram, RegionTransfer& transfer,
                        std::optional<double> isovalue = std::nullopt);

}  // namespace palpate
