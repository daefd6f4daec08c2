#include "common/scene/wall/mesh_job.h"

#include <cstring>

#include "common/load/helper/message_json.h"
#include "common/load/helper/protocol.h"

namespace palpate {
namespace {

using namespace message;

// Rows travel as they lie in memory.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(TetMesh::Tet) == 4 * sizeof(std::uint32_t));

template <typename Row>
Json append(const std::vector<Row>& rows, MemoryFile& memory) {
  return {{"offset", memory.append(std::as_bytes(std::span(rows)))}, {"count", rows.size()}};
}

template <typename Row>
std::vector<Row> rows_at(const Json& object, const char* key, std::span<const std::byte> memory) {
  const Json& array = member(object, key);
  const std::uint64_t offset = count_at(array, "offset"), count = count_at(array, "count");
  if (offset > memory.size() || count > (memory.size() - offset) / sizeof(Row))
    malformed(std::string("array '") + key + "' lies outside the message");
  std::vector<Row> rows(count);
  if (count > 0) std::memcpy(rows.data(), memory.data() + offset, count * sizeof(Row));
  return rows;
}

void check_points(const std::vector<Vec3>& points) {
  for (const Vec3& x : points)
    if (!is_finite(x)) malformed("a point that is not finite");
}

void check_tets(const std::vector<TetMesh::Tet>& tets, std::size_t points) {
  for (const TetMesh::Tet& tet : tets)
    for (const std::uint32_t p : tet)
      if (p >= points) malformed("a tetrahedron names a point that does not exist");
}

}  // namespace

std::string encode(const MeshJob& job, MemoryFile& memory) {
  return Json{{"mesher", job.mesher == Mesher::kTetgen ? "tetgen" : "delaunay"},
              {"largest_volume", job.largest_volume},
              {"points", append(job.wall.points, memory)},
              {"tets", append(job.wall.tets, memory)},
              {"cell_of_tet", append(job.wall.cell_of_tet, memory)}}
      .dump();
}

std::string encode(const FinishedMesh& mesh, MemoryFile& memory) {
  return Json{{"points", append(mesh.points, memory)},
              {"tets", append(mesh.tets, memory)},
              {"outside", mesh.outside},
              {"flat", mesh.flat},
              {"shared", mesh.shared},
              {"seconds_triangulate", mesh.seconds_triangulate},
              {"seconds_choose", mesh.seconds_choose},
              {"note", mesh.note}}
      .dump();
}

MeshJob decode_mesh_job(std::string_view text, std::span<const std::byte> memory) {
  const Json object = parse(text);
  const std::string mesher = string_at(object, "mesher");
  if (mesher != "delaunay" && mesher != "tetgen") malformed("unknown mesher");
  MeshJob job;
  job.mesher = mesher == "tetgen" ? Mesher::kTetgen : Mesher::kDelaunay;
  job.largest_volume = number_of(member(object, "largest_volume"), "largest_volume");
  job.wall.points = rows_at<Vec3>(object, "points", memory);
  job.wall.tets = rows_at<TetMesh::Tet>(object, "tets", memory);
  job.wall.cell_of_tet = rows_at<std::uint32_t>(object, "cell_of_tet", memory);
  check_points(job.wall.points);
  check_tets(job.wall.tets, job.wall.points.size());
  if (job.wall.cell_of_tet.size() != job.wall.tets.size()) malformed("not one cell a tetrahedron");
  return job;
}

FinishedMesh decode_finished_mesh(std::string_view text, std::span<const std::byte> memory,
                                  std::size_t wall_points) {
  const Json object = parse(text);
  throw_failure(object);
  FinishedMesh mesh;
  mesh.points = rows_at<Vec3>(object, "points", memory);
  mesh.tets = rows_at<TetMesh::Tet>(object, "tets", memory);
  mesh.outside = count_at(object, "outside");
  mesh.flat = count_at(object, "flat");
  mesh.shared = count_at(object, "shared");
  mesh.seconds_triangulate = number_of(member(object, "seconds_triangulate"), "seconds_triangulate");
  mesh.seconds_choose = number_of(member(object, "seconds_choose"), "seconds_choose");
  mesh.note = string_at(object, "note");
  check_points(mesh.points);
  check_tets(mesh.tets, mesh.points.empty() ? wall_points : mesh.points.size());
  return mesh;
}

}  // namespace palpate
