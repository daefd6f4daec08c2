/// A scalar image below the slices of tensors, and files that hold no tensors: what `dtmri` shows of them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/render/tensor/tensor_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// What an explorer of tensors takes a file for.
enum class FileRole : std::uint8_t {
  kTensors,  ///< or nothing of what follows: asking for its tensors says what is wrong
  kTracts,   ///< lines
  kScalar    ///< one volume of one number a voxel
};
/// @pre input.spec().kind is kTensor.
[[nodiscard]] FileRole role_of(const Input& input);

/// `options` with the input in its role: a tractogram as `--tracts`, a scalar image beside `--tracts` as
/// `--underlay`. @throws Error (usage) where options take that role, too, or seeds have nothing to be traced
/// through; (bad input) where nothing of the input can be shown.
[[nodiscard]] Document with_input_role(Document options, const Input& input);

struct Underlay {
  std::shared_ptr<const VolumeImage> image;  ///< null: none
  std::vector<std::string> notes;            ///< what the user should know
};
/// Reads the default scalar of `file`, of any format that is an image. @throws Error (bad input), Cancelled.
[[nodiscard]] Underlay load_underlay(const std::filesystem::path& file, Progress* progress);

/// Checks what can be checked before anything is read. @throws Error (usage).
void check_underlay_options(const TensorOptions& options);

/// `image` with blend, window and level of the options; what they leave open is taken from the histogram.
/// @pre check_underlay_options(options).
[[nodiscard]] UnderlayView make_underlay_view(std::shared_ptr<const VolumeImage> image,
                                              const TensorOptions& options, int threads);

}  // namespace palpate
