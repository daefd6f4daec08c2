// The helper program palpate-mesh: fills walls with tetrahedra. CGAL (GPL) and TetGen (AGPL) are in here and
// nowhere else; what crashes or eats memory takes this program along and no explorer.
#include <new>

#include "apps/cardiac/mesher/border.h"
#include "apps/cardiac/mesher/delaunay.h"
#include "apps/cardiac/mesher/tetgen_filling.h"
#include "apps/cardiac/mesher/wall_cells.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/load/helper/serve.h"
#include "common/scene/wall/mesh_job.h"

namespace {

using namespace palpate;

FinishedMesh mesh_of(const MeshJob& job) {
  const Stopwatch watch;
  if (job.mesher == Mesher::kTetgen) {
    FinishedMesh mesh = fill_border(border_of(job.wall), job.largest_volume);
    mesh.seconds_triangulate = watch.seconds();
    return mesh;
  }
  DelaunayCells cells = delaunay_cells(job.wall.points, point_spacing(job.wall));
  const double triangulated = watch.seconds();
  FinishedMesh mesh = choose_wall(job.wall, std::move(cells));
  mesh.seconds_triangulate = triangulated;
  mesh.seconds_choose = watch.seconds() - triangulated;
  if (mesh.tets.empty()) throw work_error("no tetrahedron between the points lies in the wall");
  return mesh;
}

}  // namespace

int main() {
  Service service;
  service.answer = [](std::string_view json, std::span<const std::byte> arrays, MemoryFile& memory) {
    try {
      return encode(mesh_of(decode_mesh_job(json, arrays)), memory);
    } catch (const std::bad_alloc&) {
      throw work_error("meshing needs more memory than it may have: try a smaller --refine");
    }
  };
  return serve(service);
}
