/// What lies under the mouse on slices through tensors.
#pragma once

#include <optional>

#include "common/render/camera.h"
#include "common/render/tensor/tensor_view.h"

namespace palpate {

struct TensorPick {
  Vec3 position{0.0};  ///< on a slice, data coordinates
  Index3 voxel{0};
  int axis = 0;                    ///< of the image, across which the slice lies
  std::optional<Mat3> tensor;      ///< of the voxel, where it shows
  std::optional<double> underlay;  ///< the value there of the image below
};

/// The nearest slice under the pixel (x, y) from the top left corner that shows something there; none where
/// the ray of the pixel meets none.
[[nodiscard]] std::optional<TensorPick> pick_slice(const TensorView& view, const Camera& camera, int width,
                                                   int height, double x, double y);

}  // namespace palpate
