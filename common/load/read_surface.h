/// Surfaces of triangles from files: .stl, .ply and .obj, read here, and polygons of VTK's files (.vtp), which the
/// loader's helper program reads.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/math/vec.h"

namespace palpate {

/// As the file has it: points of neighbours may be there several times.
struct SurfaceTriangles {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Whether the ending names a format that holds surfaces and nothing else: .stl, .ply, .obj.
[[nodiscard]] bool names_surface(const std::filesystem::path& file);

/// Polygons of more than three corners are cut in a fan from the first. Materials, normals and colours are left out.
/// @throws Error (bad input) naming the file and the place: damaged, of a kind that is not read (PLY lists of other
/// elements before the faces), or without a triangle; Cancelled.
[[nodiscard]] SurfaceTriangles read_surface(const std::filesystem::path& file, Progress* progress = nullptr);

}  // namespace palpate
