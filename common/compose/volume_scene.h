/// What the render verb and the window show of a volume: its voxels, transfer function, domain and labels.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/compose/taken_scalar.h"
#include "common/load/write/write_image.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// A transfer function to begin with, from the values themselves: the preset for densities over those that
/// Otsu's threshold parts from the background, up to all but the brightest two hundredth of them.
[[nodiscard]] ColorTransfer default_color_transfer(const VolumeImage& image, int threads);

/// One for lenses to begin with: like default_color_transfer(), but of the denser half alone of what that
/// one shows, as Otsu's threshold of those values parts it, so that a lens looks into things.
[[nodiscard]] ColorTransfer default_focus_transfer(const VolumeImage& image, int threads);

/// Where all values lie but a few far ones (bulk_histogram()).
[[nodiscard]] ValueWindow window_of_bulk(const VolumeImage& image, int threads);

/// A transfer function of values, or of values and gradient magnitudes.
struct VolumeTransfer {
  ColorTransfer colors;
  std::optional<RegionTransfer> regions;  ///< in place of `colors`
};
/// Has a lens show what it says.
void take_transfer(VolumeTransfer transfer, Lens& lens);

/// What `--transfer-function` names: a preset, a file of either kind, "points:" or "regions:" with the points
/// or regions themselves (transfer_text(), region_text()), or nothing for default_color_transfer().
/// @throws Error (usage) for a word that is none of these, (bad input) for a file.
[[nodiscard]] VolumeTransfer volume_transfer_of(const std::string& name, const VolumeImage& image,
                                                int threads);

/// The same of `--focus-tf`, where nothing stands for default_focus_transfer().
[[nodiscard]] VolumeTransfer focus_transfer_of(const std::string& name, const VolumeImage& image,
                                               int threads);

/// The preset of both measures, beside those of ColorPreset: boundary_regions().
inline constexpr const char* kBoundariesPreset = "boundaries";

/// Checks what can be checked of the options "Volume" before anything is read. @throws Error (usage).
void check_volume_options(const VolumeOptions& options);

/// Said of a volume that is drawn in colours of its own.
inline constexpr const char* kOwnColorsNote =
    "drawn in the voxels' own colours: a transfer function gives the opacity, by their magnitude, and no colour; a "
    "fourth number is left out, and slices show the magnitude; --field colors:0, 1 or 2 shows one of them";

/// What is said of the colours of an image: of its own, of labels, and where its numbers may be labels; else nothing.
[[nodiscard]] std::string color_note(const VolumeImage& image);

/// `image` with the colours of its points, where `colors` holds red, green and blue from 0 to 255 (a fourth
/// number is left out) for each; else as it is. They are drawn in place of those of transfer functions, which
/// give opacity alone.
[[nodiscard]] std::shared_ptr<const VolumeImage> with_own_colors(std::shared_ptr<const VolumeImage> image,
                                                                 const DataArray& colors);

/// How data that are neither an image nor a rectilinear grid are read as an image.
struct Resampling {
  std::string asked;      ///< as `--resample`; empty: only what lies along straight axes is read
  std::string otherwise;  ///< becomes `asked` where that is empty and data do not
  int threads = 0;
  std::vector<TakenScalar> taken;  ///< what reading has resampled, added to what is there

  /// Their texts (taken_text()).
  [[nodiscard]] std::vector<std::string> notes() const;
};

/// Reads the voxels of the field that the input's spec names, with their own colours where it is the magnitude
/// of some.
/// @param resampling null: only what lies along straight axes is read.
/// @throws Error, Cancelled.
[[nodiscard]] std::shared_ptr<const VolumeImage> load_volume(Input& input, Progress* progress,
                                                             Resampling* resampling = nullptr);

/// Reads the same as one uniform or rectilinear block with one point array of one number: where a voxel is blanked, NaN.
/// @throws Error, Cancelled.
[[nodiscard]] DataSet load_volume_block(Input& input, Progress* progress, Resampling* resampling = nullptr);

/// What is known of the coordinates of `input`, for images that are made of it.
[[nodiscard]] ImageSpace space_of(const Input& input);

/// Whether its file says that values are Hounsfield units: then the preset of computed tomography is the transfer function
/// where none is named.
[[nodiscard]] bool values_in_hounsfield(const Input& input);

/// What the file states of black and white; nothing where it says nothing that can be.
[[nodiscard]] std::optional<ValueWindow> stated_window(const Input& input);

/// The same voxels to be drawn and to be felt, read once.
struct TangibleVolume {
  std::shared_ptr<const VolumeImage> image;
  std::shared_ptr<const ScalarField>
      field;                           ///< on its own grid; null where the image is flat: it has no inside
  std::vector<VolumeField> secondary;  ///< other scalars, to be drawn in lenses
};
/// @throws Error, Cancelled.
[[nodiscard]] TangibleVolume load_tangible_volume(Input& input, int threads, Progress* progress,
                                                  Resampling* resampling = nullptr);

/// `shown` as the options have it drawn: transfer functions, lenses, cuts, rays.
/// @throws Error (usage), (bad input) as take_parts() and volume_transfer_of().
[[nodiscard]] VolumeView make_volume_view(const TangibleVolume& shown, const Document& options);

/// How the options project.
[[nodiscard]] Projection projection_of(const VolumeOptions& options);

/// A scene of `volume` seen by the camera that `options` name.
/// @param aspect width / height of the picture.
[[nodiscard]] SceneView make_volume_scene(const Input& input, const TangibleVolume& volume,
                                          const Document& options, double aspect);

}  // namespace palpate
