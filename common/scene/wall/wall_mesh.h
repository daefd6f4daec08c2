/// The tetrahedra of a heart's wall with the numbers at their points: those of the file, or new ones by the
/// mesher.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/heart/heart.h"
#include "common/load/write/write_mesh.h"
#include "common/scene/wall/mesh_job.h"

namespace palpate {

struct WallMesh {
  std::vector<Vec3> points;        ///< data coordinates; every one has a cell
  std::vector<TetMesh::Tet> tets;  ///< positively oriented
  /// For each point which of the file's it is: the file's point arrays are those of these. Empty where all
  /// points are new (TetGen's).
  std::vector<std::uint32_t> point_of_file;
  std::vector<MeshColumn> columns;  ///< arrays of points that the file does not give
  bool kept = false;                ///< the file's own tetrahedra
  FinishedMesh counts;              ///< of the mesher; its points and tetrahedra are empty
  double cells_volume = 0.0;        ///< of the cells that were meshed
  std::vector<std::string> notes;
};

/// What fills the wall.
enum class WallFilling : std::uint8_t { kCells, kDelaunay, kTetgen };

/// "cells", "delaunay", "tetgen": the words of --mesher.
[[nodiscard]] std::string name_of(WallFilling mesher);
/// @throws Error (usage) for another word.
[[nodiscard]] WallFilling wall_filling_from_name(const std::string& name);

struct WallMeshOptions {
  WallFilling mesher = WallFilling::kDelaunay;  ///< kCells: the tetrahedra that the file's cells split into
  double largest_volume = 0.0;  ///< tetgen; 0: twice the mean volume of the tetrahedra that cells split into
  int threads = 0;
};

/// Whether cells have fibres or sheets, which are brought to the points.
[[nodiscard]] bool has_cell_directions(const HeartChoice& choice) noexcept;

/// Whether all cells are tetrahedra, which are kept.
[[nodiscard]] bool tetrahedra_alone(const DataSet& block);

/// Directions of cells are brought to the points as outer products. TetGen's points get the fibres, sheets
/// and depth of where they lie. The file's own tetrahedra are mended where that is possible: points at one
/// place are joined, inverted cells turned and those without a volume left out. @param choice of fibres;
/// null: there are none.
/// @throws Error (bad input) where no tetrahedron has a volume, and as split_into_tetrahedra(), make_heart()
/// and run_mesher(); Cancelled.
[[nodiscard]] WallMesh make_wall_mesh(const DataSet& block, const HeartChoice* choice,
                                      const WallMeshOptions& options, const std::string& file,
                                      Progress* progress);

/// Appends the file's point arrays to the mesh's columns, where its points are the file's.
void carry_arrays(const DataSet& block, WallMesh& mesh);

/// The mesh as a loader would hand it over.
[[nodiscard]] DataSet data_set_of(const WallMesh& mesh);

}  // namespace palpate
