/// Writer of triangles with numbers: .vtp (VTK XML, PolyData, raw appended data). Written under a temporary name and
/// renamed, so an output is never half a file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// What the triangles of a surface are part of.
struct SurfaceLabels {
  std::string name;                ///< of the array of integers, one a triangle
  std::vector<std::int32_t> of;    ///< of each triangle
  std::vector<std::string> words;  ///< what 0, 1, … mean: field data, the array `name`_names of strings
};

/// Numbers at the points of a surface.
struct SurfaceColumn {
  std::string name;
  std::vector<double> values;  ///< one a point
};

/// Checks that `path` ends in .vtp, may be written, and does not exist unless `overwrite`.
/// @throws Error (usage, or work failed where the folder cannot be written).
void check_surface_output(const std::filesystem::path& path, bool overwrite);

/// @throws Error as check_surface_output(); (work failed) where the disk refuses.
void write_surface(const std::filesystem::path& path, std::span<const Vec3> points,
                   std::span<const std::array<std::uint32_t, 3>> triangles, const SurfaceLabels& labels,
                   std::span<const SurfaceColumn> columns, bool overwrite);

}  // namespace palpate
