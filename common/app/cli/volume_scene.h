/// What the render verb and the window show of a volume: its voxels, transfer function, domain and labels.
#pragma once

#include <memory>
#include <string>

#include "common/app/cli/options.h"
#include "common/base/progress.h"
#include "common/load/write_image.h"
#include "common/render/scene_view.h"
#include "common/scene/input.h"

namespace palpate {

/// A transfer function to begin with, from the values themselves: the preset for densities over those that
/// Otsu's threshold parts from the background, up to all but the brightest two hundredth of them.
[[nodiscard]] ColorTransfer default_color_transfer(const VolumeImage& image, int threads);

/// One for lenses to begin with: like default_color_transfer(), but of the denser half alone of what that
/// one shows, as Otsu's threshold of those values parts it, so that a lens looks into things.
[[nodiscard]] ColorTransfer default_focus_transfer(const VolumeImage& image, int threads);

/// What `--transfer-function` names: a preset, a file, "points:" with the points themselves
/// (transfer_words()), or nothing for default_color_transfer().
/// @throws Error (usage) for a word that is none of these, (bad input) for a file.
[[nodiscard]] ColorTransfer color_transfer_of(const std::string& name, const VolumeImage& image, int threads);

/// The same of `--focus-tf`, where nothing stands for default_focus_transfer().
[[nodiscard]] ColorTransfer focus_transfer_of(const std::string& name, const VolumeImage& image, int threads);

/// Checks what can be checked of the options "Volume" before anything is read. @throws Error (usage).
void check_volume_options(const VolumeOptions& options);

/// Reads the voxels of the field that the input's spec names.
/// @throws Error, Cancelled.
[[nodiscard]] std::shared_ptr<const VolumeImage> load_volume(Input& input, Progress* progress);

/// Reads the same as one uniform block with one point array of one number: where a voxel is blanked, NaN.
/// @throws Error, Cancelled.
[[nodiscard]] DataSet load_volume_block(Input& input, Progress* progress);

/// What is known of the coordinates of `input`, for images that are made of it.
[[nodiscard]] ImageSpace space_of(const Input& input);

/// The same voxels to be drawn and to be felt, read once.
struct TangibleVolume {
  std::shared_ptr<const VolumeImage> image;
  std::shared_ptr<const ScalarField> field;  ///< null where the image is flat: it has no inside
};
/// @throws Error, Cancelled.
[[nodiscard]] TangibleVolume load_tangible_volume(Input& input, int threads, Progress* progress);

/// A scene of `image` seen by the camera that `options` name.
/// @param aspect width / height of the picture.
[[nodiscard]] SceneView make_volume_scene(const Input& input, std::shared_ptr<const VolumeImage> image,
                                          const Options& options, double aspect);

}  // namespace palpate
