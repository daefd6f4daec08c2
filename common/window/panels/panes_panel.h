/// The part of the panel about slices beside a volume.
#pragma once

#include "common/field/value_histogram.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// Layout, crosshair, slab, grey values. @param histogram of the values, for a window to begin with; may be null.
/// @param anatomical the data are a patient's.
void edit_panes(VolumeView& volume, const ValueHistogram* histogram, bool anatomical);

/// From none to one, to three, and back. @param histogram as above.
void next_layout(VolumeView& volume, const ValueHistogram* histogram);

/// Window and level of what is drawn in grey, as sliders over the range of the values.
void edit_window(VolumeView& volume);

}  // namespace palpate
