/// A bundle of tracts as a table along it and as an image.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/cli/verbs.h"
#include "common/field/data_set.h"
#include "common/geometry/tractogram.h"
#include "common/load/write/image_origin.h"
#include "common/scene/input.h"
#include "common/scene/tensor/tensor_image.h"
#include "common/trace/tract/bundle.h"

namespace palpate {

/// What can be refused of --profile, --density and --bundle-mask before any work is done.
/// @throws Error (usage), (work failed) as OutputFile.
void check_bundle_options(const Document& options);

/// Writes what these ask for, and adds a sentence for each to `notes`. The profile's table has a row
/// a node: node,part,x,y,z,lines,valueless,mean,deviation,lower,median,upper.
/// @param made the tensors of `input`; null: it holds tracts alone. @param voxels that lines are counted in.
/// @throws Error as the writers; (bad input) where the profile's image cannot be read; Cancelled.
void write_bundle(const Document& options, const VerbContext& context, Input& input, const TensorImage* made,
                  const UniformTopology& voxels, const Tractogram& lines, std::vector<std::string>& notes);

/// The table of --profile.
/// @throws Error as OutputFile.
void write_profile(const std::filesystem::path& path, const BundleProfile& profile, bool overwrite);
/// The image of --density, or with `mask` that of --bundle-mask. @return what its format has lost.
/// @throws Error as write_image().
std::vector<std::string> write_density(const std::filesystem::path& file, const BundleDensity& density,
                                       bool mask, const UniformTopology& voxels, const ImageOrigin& origin,
                                       bool overwrite);
/// What is said of it: voxels, lines and volume. @param lines that the bundle has.
[[nodiscard]] std::string density_text(const BundleDensity& density, std::size_t lines);

}  // namespace palpate
