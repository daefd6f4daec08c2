/// What the render verb and the window show of diffusion tensors: slices, glyphs, domain and labels.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/dtmri/underlay.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_volume.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// Which slices are shown and where, as `--slices` says.
struct SliceChoice {
  std::array<bool, 3> shown{true, true, true};      ///< sagittal, coronal, axial: across x, y, z
  std::array<std::optional<double>, 3> position{};  ///< [data units]; absent: the middle of the image
};

/// "all", "none", or a place on each axis of the data with commas between; '-' in place of a number leaves
/// the slice across that axis out.
/// @throws Error (usage).
[[nodiscard]] SliceChoice parse_slices(const std::string& text);
/// The view's slices as `--slices` says them.
[[nodiscard]] std::string slices_text(const TensorView& view);

/// Checks what can be checked before anything is read. @throws Error (usage), (bad input) for a transfer
/// function.
void check_tensor_options(const Document& options);

/// How a lens shows the directions in it: solid, or as `--focus-tf` says. @throws Error (bad input).
[[nodiscard]] Lens direction_lens(const VolumeOptions& options, const VolumeImage& image);

/// Anisotropy as a volume with the lenses of the options, shown if they ask for it.
/// @throws Error (bad input) for a transfer function.
[[nodiscard]] VolumeView make_tensor_volume(std::shared_ptr<const VolumeImage> anisotropy,
                                            const Document& options);

/// What the options say about `voxels`: slices through its middle where nothing else is said.
/// @throws Error (usage).
[[nodiscard]] TensorView make_tensor_view(std::shared_ptr<const TensorVoxels> voxels,
                                          const TensorOptions& options);

/// Puts `underlay` below the slices of `tensors`, or where there are none makes slices through it.
/// @pre underlay.image is not null. @return what the user should know. @throws Error (usage) for --slices.
std::vector<std::string> show_underlay(const Underlay& underlay, const Document& options,
                                       std::optional<TensorView>& tensors);

/// What a scene consists of; tensors, tracts or both.
struct TensorSceneParts {
  std::optional<TensorView> tensors;
  std::optional<TractView> tracts;
};
/// The scene seen by the camera that `options` name. The anisotropy of tensors is there as a volume.
/// @param aspect width / height of the picture.
[[nodiscard]] SceneView make_tensor_scene(const Input& input, TensorSceneParts parts, const Document& options,
                                          double aspect);

}  // namespace palpate
