/// What slices of tensors may show, by the words of --slice-show.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/render/scene_view.h"
#include "common/render/slice/slice_view.h"
#include "common/render/tensor/tensor_view.h"
#include "common/scene/tensor/tensor_image.h"

namespace palpate {

/// "direction", "fa" and "md"; of fitted tensors "b0", the fitted signal without weighting, and "cone", the 95 % cone of
/// the main direction in degrees.
/// @param anisotropy make_anisotropy_volume() of the same tensors. @param file for messages. @throws Error (bad input).
[[nodiscard]] std::vector<SliceImage> slice_images_of(const TensorImage& made,
                                                      const std::shared_ptr<const VolumeImage>& anisotropy,
                                                      const std::string& file, int threads);

/// "underlay", with the window that it has below the slices of the scene.
[[nodiscard]] SliceImage slice_image_of(const UnderlayView& underlay);

/// Those that the slices of a scene show: of its volume, or the underlay alone.
[[nodiscard]] std::vector<SliceImage> slice_images_in(const std::optional<VolumeView>& volume,
                                                      const std::optional<TensorView>& tensors);

/// The one of that name; null: there is none.
[[nodiscard]] const SliceImage* find_slice_image(const std::vector<SliceImage>& images,
                                                 const std::string& name);

}  // namespace palpate
