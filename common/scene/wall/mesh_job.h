/// What is asked of the mesher, the helper program palpate-mesh, what it answers, and the messages in
/// which both travel. The wire is that of the loaders (common/load/helper/channel.h): JSON with arrays in shared
/// memory.
///
///   {"mesher": "delaunay" or "tetgen", "largest_volume": v, "points": A, "tets": A, "cell_of_tet": A}
///   request
///   {"points": A, "tets": A, "outside", "flat", "shared", "seconds_triangulate",
///    "seconds_choose", "note"} answer
///   A = {"offset", "count"}: float64 x 3, uint32 x 4, uint32 a row
/// An answer without points means those of the request.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/load/helper/memory_file.h"
#include "common/math/vec.h"

namespace palpate {

/// The helper program.
inline constexpr const char* kMesherProgram = "palpate-mesh";

enum class Mesher : std::uint8_t { kDelaunay, kTetgen };

/// A wall as its model was sampled: cells of any shape, each split into tetrahedra.
struct SampledWall {
  std::vector<Vec3> points;                ///< data coordinates; no two at one place
  std::vector<TetMesh::Tet> tets;          ///< in either orientation
  std::vector<std::uint32_t> cell_of_tet;  ///< tetrahedra of one cell stand together
};

struct MeshJob {
  Mesher mesher = Mesher::kDelaunay;
  double largest_volume = 0.0;  ///< tetgen: of a tetrahedron; 0: no limit
  SampledWall wall;
};

struct FinishedMesh {
  std::vector<Vec3> points;  ///< empty: those of the wall
  std::vector<TetMesh::Tet> tets;
  std::uint64_t outside = 0;  ///< delaunay: left out because they lie in no cell of the wall
  std::uint64_t flat = 0;     ///< delaunay: slivers left out at the border
  std::uint64_t shared = 0;   ///< delaunay: kept because a cell of the wall has all four corners
  double seconds_triangulate = 0.0;
  double seconds_choose = 0.0;  ///< which tetrahedra belong to the wall
  std::string note;             ///< what else is to be said; empty: nothing
};

/// Appends the arrays to `memory` and returns the JSON that speaks of them.
[[nodiscard]] std::string encode(const MeshJob& job, MemoryFile& memory);
[[nodiscard]] std::string encode(const FinishedMesh& mesh, MemoryFile& memory);

/// @throws ProtocolError where sizes, offsets or indices make no sense.
[[nodiscard]] MeshJob decode_mesh_job(std::string_view json, std::span<const std::byte> memory);
/// @param wall_points of the request. @throws ProtocolError; Error where the answer is a failure.
[[nodiscard]] FinishedMesh decode_finished_mesh(std::string_view json, std::span<const std::byte> memory,
                                                std::size_t wall_points);

}  // namespace palpate
