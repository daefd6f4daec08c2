/// Regions that tracts are traced by, as options, sessions and panels say them:
///
///   sphere:x,y,z,r          a ball
///   box:x,y,z,x,y,z         between two corners, along the axes of the data
///   beyond:nx,ny,nz,d       all x with n . x > d
///   brush:r,x,y,z,x,y,z,…   balls of radius r about points, as a brush leaves them
///   mask:FILE               voxels of an image above 0.5 (voxel_mask.h)
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/write/image_origin.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/trace/tract/tract_region.h"

namespace palpate {

/// What a region is for.
enum class RegionRole : std::uint8_t { kSeed, kInclude, kExclude, kStop };
inline constexpr std::array<const char*, 4> kRegionRoleNames{"seed", "include", "exclude", "stop"};

/// The name of a file is that of a mask.
using RegionShape = std::variant<Sphere, Box, HalfSpace, BrushStroke, std::string>;

/// Whether `text` begins as a region does: seeds may be something else.
[[nodiscard]] bool is_region(std::string_view text) noexcept;
/// @param refusal the line of the error. @throws Error (usage).
[[nodiscard]] RegionShape parse_region(std::string_view text, const std::string& refusal);
/// @pre not that of a mask.
[[nodiscard]] TractRegion tract_region(const RegionShape& shape);
/// The inverse of parse_region(), to the last bit.
[[nodiscard]] std::string region_text(const RegionShape& shape);

// Seeds of images with several directions a voxel: from the longest, or from each ("peaks:" before the text).

[[nodiscard]] bool from_every_peak(std::string_view seeds) noexcept;
/// What is left without that word.
[[nodiscard]] std::string_view seed_places(std::string_view seeds) noexcept;
/// `places` with it or without.
[[nodiscard]] std::string seeds_text(std::string_view places, bool every_peak);

/// All regions of `options`, seeds first.
struct RegionEntry {
  RegionRole role = RegionRole::kInclude;
  std::string text;
};
[[nodiscard]] std::vector<RegionEntry> regions_of(const TractTracingOptions& options);
/// The inverse: seeds that are no region stay, unless `regions` have one.
void set_regions(const std::vector<RegionEntry>& regions, TractTracingOptions& options);

/// As pictures outline them: seeds yellow, include green, exclude red, stop blue. Masks have no outline.
/// @throws Error (usage) for what is no region.
[[nodiscard]] std::vector<RegionView> region_views(const TractTracingOptions& options);
/// The outline of one.
[[nodiscard]] RegionView region_view(RegionRole role, const RegionShape& shape);

/// Writes the regions: as .csv a row each, with its role and text, else as an image in which a voxel has the sum of
/// 1 (seed), 2 (include), 4 (exclude) and 8 (stop) of those that hold its centre. Masks are read for that.
/// @return what the user should know. @throws Error.
std::vector<std::string> write_regions(const std::filesystem::path& file, const TractTracingOptions& options,
                                       bool left_handed, const UniformTopology& image,
                                       const ImageOrigin& origin, bool overwrite);

}  // namespace palpate
