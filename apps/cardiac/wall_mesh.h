/// The tetrahedra of a heart's wall with the numbers at their points: those of the file, or new ones by the
/// mesher.
#pragma once

#include <string>
#include <vector>

#include "apps/cardiac/mesher/mesh_job.h"
#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/heart/heart.h"
#include "common/load/write_mesh.h"

namespace palpate {

struct WallMesh {
  std::vector<Vec3> points;        ///< data coordinates; every one has a cell
  std::vector<TetMesh::Tet> tets;  ///< positively oriented
  std::vector<MeshColumn> columns;
  bool kept = false;          ///< the file's own tetrahedra
  FinishedMesh counts;        ///< of the mesher; its points and tetrahedra are empty
  double cells_volume = 0.0;  ///< of the cells that were meshed
  std::vector<std::string> notes;
};

struct WallMeshOptions {
  Mesher mesher = Mesher::kDelaunay;
  double largest_volume = 0.0;  ///< tetgen; 0: twice the mean volume of the tetrahedra that cells split into
  int threads = 0;
};

/// Point arrays come along where the points of the file do (delaunay, and tetrahedra that are kept);
/// directions of cells are brought to the points as outer products. TetGen's points get the fibres, sheets
/// and depth of where they lie. The file's own tetrahedra are mended where that is possible: points at one
/// place are joined, inverted cells turned and those without a volume left out. @param choice of fibres;
/// null: there are none.
/// @throws Error (bad input) where no tetrahedron has a volume, and as split_into_tetrahedra(), make_heart()
/// and run_mesher(); Cancelled.
[[nodiscard]] WallMesh make_wall_mesh(const DataSet& block, const HeartChoice* choice,
                                      const WallMeshOptions& options, const std::string& file,
                                      Progress* progress);

/// The mesh as a loader would hand it over.
[[nodiscard]] DataSet data_set_of(const WallMesh& mesh);

}  // namespace palpate
