/// The pixels of a slice, computed by the processor: exactly the values of the image, in whatever memory they stand,
/// and quick enough for a picture to follow the hand without a graphics card.
#pragma once

#include "common/math/vec.h"
#include "common/render/camera.h"
#include "common/render/scene_view.h"
#include "common/render/slice/slice_view.h"

namespace palpate {

/// Values v(x) are trilinear between points (VolumeImage::value_at()). Grey is
///
///   (v - (level - width / 2)) / width, clamped to [0, 1]                                          (1)
///
/// of the middle of each pixel: in the plane, or of the mean, highest or lowest value of planes no farther apart than
/// half a step of the image that fill the slab, as far as the volume reaches; fewer where SliceView::most_planes says so. Where there is no value, outside and at voxels that have none, the
/// picture is clear. Where SliceView::colored, grey is the brightness of the colour of the nearest point (in the middle
/// of a slab).
/// @param camera orthographic. @param threads 0: all cores. The result does not depend on it.
[[nodiscard]] Image slice_raster(const SliceView& slice, const Camera& camera, int width, int height,
                                 int threads = 0);

/// Whether both have the same pixels: what is drawn over them may differ.
[[nodiscard]] bool same_pixels(const SliceView& a, const SliceView& b);

}  // namespace palpate
