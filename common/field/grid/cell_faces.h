/// Cell types of the VTK file format: which are volumes, their vertices and outward faces.
///
/// Vertex and face orders follow the VTK file format's cell definitions. Faces are listed so that all of a
/// cell turn the same way; whether that is outwards the sign of the cell's volume tells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

inline constexpr std::uint8_t kTetrahedron = 10;
inline constexpr std::uint8_t kVoxel = 11;
inline constexpr std::uint8_t kHexahedron = 12;
inline constexpr std::uint8_t kWedge = 13;
inline constexpr std::uint8_t kPyramid = 14;
inline constexpr std::uint8_t kPentagonalPrism = 15;
inline constexpr std::uint8_t kHexagonalPrism = 16;
inline constexpr std::uint8_t kQuadraticTetrahedron = 24;
inline constexpr std::uint8_t kTriquadraticHexahedron = 29;
inline constexpr std::uint8_t kPolyhedron = 42;

/// Faces of a linear cell, as indices of its vertices.
struct CellFaces {
  std::vector<std::vector<std::uint8_t>> faces;
};

/// Faces of one cell, as points: face f is ids[ends[f - 1]] … ids[ends[f] - 1].
struct FaceList {
  std::vector<std::uint32_t> ids;
  std::vector<std::size_t> ends;
  void clear() {
    ids.clear();
    ends.clear();
  }
};

inline constexpr std::array<std::array<std::size_t, 4>, 6> kHexahedronFaces{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// The eight hexahedra of a 27-node hexahedron.
inline constexpr std::array<std::array<std::uint8_t, 8>, 8> kTriquadraticParts{
    {{0, 8, 24, 11, 16, 22, 26, 20},
     {8, 1, 9, 24, 22, 17, 21, 26},
     {11, 24, 10, 3, 20, 26, 23, 19},
     {24, 9, 2, 10, 26, 21, 18, 23},
     {16, 22, 26, 20, 4, 12, 25, 15},
     {22, 17, 21, 26, 12, 5, 13, 25},
     {20, 26, 23, 19, 15, 25, 14, 7},
     {26, 21, 18, 23, 25, 13, 6, 14}}};

/// A volume cell that can be split.
[[nodiscard]] bool is_volume(std::uint8_t type) noexcept;
/// A point, line or surface cell.
[[nodiscard]] bool is_flat(std::uint8_t type) noexcept;
/// A surface cell, straight or curved.
[[nodiscard]] bool is_surface(std::uint8_t type) noexcept;
/// Points of a cell of the type; 0 where the type leaves it open (arbitrary order, polyhedra).
[[nodiscard]] std::size_t point_count_of(std::uint8_t type) noexcept;
/// The linear cell at the corners of a higher-order one; linear types are their own.
[[nodiscard]] std::uint8_t linear_type_of(std::uint8_t type) noexcept;
/// Corners of a cell of the type, which come first among its points; 0 for polyhedra.
[[nodiscard]] std::size_t corner_count_of(std::uint8_t type) noexcept;
/// Faces of a linear type other than the polyhedron; null for every other type.
[[nodiscard]] const CellFaces* faces_of(std::uint8_t type) noexcept;

/// Turns faces so that neighbouring ones pass their common edge in opposite directions.
void orient_faces(FaceList& faces);

/// Calls `visit` with both ends of every edge of every polyhedron, skipping what is malformed.
void for_each_polyhedron_edge(const UnstructuredTopology& cells,
                              const std::function<void(std::size_t, std::size_t)>& visit);

}  // namespace palpate
