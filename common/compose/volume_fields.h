/// Scalars of a scene beside the one that is shown around lenses (VolumeView::fields): others of the same
/// input, or of files of their own with grids of their own.
///
/// A name is that of a scalar of the input ("pressure", "velocity:0"), a file, or FILE:NAME for another
/// scalar than the likeliest one of that file. `--field A,B` and `,field=B` of a lens name them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/late.h"
#include "common/base/progress.h"
#include "common/compose/volume_scene.h"
#include "common/render/volume/volume_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// The names, each once, in the order of VolumeView::fields; not that of what is shown around lenses.
/// @throws Error (usage) for a name that is neither a scalar of the input nor a file, and for more than a
/// picture can have.
[[nodiscard]] std::vector<std::string> secondary_names(const Input& input, const VolumeOptions& options);
/// The same of another choice of scalars.
/// @param shown names of what is shown around lenses. @param beside those asked for, but for lenses.
/// @param check refuses a name that means nothing.
[[nodiscard]] std::vector<std::string> secondary_names(const std::vector<std::string>& shown,
                                                       const std::vector<std::string>& secondary,
                                                       const VolumeOptions& options,
                                                       const std::function<void(const std::string&)>& check);

/// Refuses a `name` that is no file, either. @param option that has it. @param known names that would do.
/// @throws Error (usage).
void check_file_field(const std::string& name, const std::string& option,
                      const std::vector<std::string>& known, const std::string& input);
/// The voxels that FILE or FILE:NAME means. @throws Error, Cancelled.
[[nodiscard]] std::shared_ptr<const VolumeImage> load_file_field(const std::string& name, Progress* progress);

/// With the window of its bulk (window_of_bulk()), found where a slice asks for it.
[[nodiscard]] VolumeField volume_field(std::shared_ptr<const VolumeImage> image, std::string name);
/// Reads their voxels. @throws Error as secondary_names() and of the files; Cancelled.
[[nodiscard]] std::vector<VolumeField> load_secondary(Input& input, const VolumeOptions& options,
                                                      Progress* progress, Resampling* resampling = nullptr);

/// All voxels of a picture that nobody feels. @throws Error, Cancelled.
[[nodiscard]] TangibleVolume load_seen_volume(Input& input, const VolumeOptions& options, Progress* progress,
                                              Resampling* resampling = nullptr);

/// How lenses show each field, by Lens::field: as `--focus-tf` says, of the values of that field; where it
/// says nothing the context's denser half, and all of another field, found where a lens asks for it.
/// @param volume has its fields. @throws Error as focus_transfer_of().
[[nodiscard]] std::vector<Late<Lens>> lens_appearances(const VolumeView& volume, const std::string& focus,
                                                       int threads);

/// The lenses and cuts that the options ask for, with the fields and transfer functions that they name.
/// @param volume has its fields; @param appearances of lens_appearances() for it.
/// @throws Error (usage) as make_parts(), and for more transfer functions than a picture can have; of files.
void take_parts(VolumeView& volume, const VolumeOptions& options, const std::vector<Late<Lens>>& appearances,
                int threads);

/// What is told of pictures by value and gradient magnitude.
inline constexpr const char* kRegionsNote =
    "regions of value and gradient magnitude are classified along rays that are sampled twice as often; they "
    "have no preintegrated tables";

}  // namespace palpate
