/// What the render verb and the window show of diffusion tensors: slices, glyphs, domain and labels.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_view.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

// A scalar image below the slices of tensors, and files that hold no tensors: what `dtmri` shows of them.

/// What an explorer of tensors takes a file for.
enum class FileRole : std::uint8_t {
  kTensors,  ///< or nothing of what follows: asking for its tensors says what is wrong
  kTracts,   ///< lines
  kScalar    ///< one volume of one number a voxel
};
/// @pre input.spec().kind is kTensor.
[[nodiscard]] FileRole role_of(const Input& input);

/// `options` with the input in its role: a tractogram as `--tracts`, unless a bundle takes its tracts, a scalar image beside `--tracts` as
/// `--underlay`. @throws Error (usage) where options take that role, too, or seeds have nothing to be traced
/// through; (bad input) where nothing of the input can be shown.
[[nodiscard]] Document with_input_role(Document options, const Input& input);

struct Underlay {
  std::shared_ptr<const VolumeImage> image;  ///< null: none
  std::vector<std::string> notes;            ///< what the user should know
};
/// Reads the default scalar of `file`, of any format that is an image. @throws Error (bad input), Cancelled.
[[nodiscard]] Underlay load_underlay(const Document& document, Progress* progress);

/// Checks what can be checked before anything is read. @throws Error (usage).
void check_underlay_options(const TensorOptions& options);

/// `image` with blend, window and level of the options; what they leave open is taken from the histogram.
/// @pre check_underlay_options(options).
[[nodiscard]] UnderlayView make_underlay_view(std::shared_ptr<const VolumeImage> image,
                                              const TensorOptions& options, int threads);

/// Which slices are shown and where, as `--slices` says.
struct SliceChoice {
  std::array<bool, 3> shown{true, true, true};      ///< sagittal, coronal, axial: across x, y, z
  std::array<std::optional<double>, 3> position{};  ///< [data units]; absent: the middle of the image
};

/// "all", "none", or a place on each axis of the data with commas between; '-' in place of a number leaves
/// the slice across that axis out, "off:" before it does, too, but the crosshair goes there.
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
  const TensorImage* made = nullptr;  ///< that the tensors are of, for slices beside the picture; may be null
};

/// Tracts of `bundle` as the options say.
[[nodiscard]] TractView make_tract_view(std::shared_ptr<const TractBundle> bundle,
                                        const TractAppearance& look);

/// Lets slices show the underlay, and puts crosshair and slices to the same place: that of --cross, or of --slices.
void complete_panes(const PanesOptions& options, TensorView& tensors, VolumeView& volume);
/// The scene seen by the camera that `options` name. The anisotropy of tensors is there as a volume.
/// @param aspect width / height of the picture.
[[nodiscard]] SceneView make_tensor_scene(const Input& input, TensorSceneParts parts, const Document& options,
                                          double aspect);

}  // namespace palpate
