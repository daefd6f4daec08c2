#include "common/scene/wall/mesh_client.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/files/find_helper.h"
#include "common/base/ledger.h"
#include "common/base/memory.h"
#include "common/load/helper/helper_process.h"
#include "common/load/helper/protocol.h"

namespace palpate {
namespace {

/// Address space: libraries and their arenas, and for each point what the job (twice: mapped and unpacked),
/// the triangulation and the answer take. CGAL's needs some 600 bytes a point; TetGen adds points of its own.
constexpr std::uint64_t kBaseMemory = std::uint64_t{1} << 30;
constexpr std::uint64_t kMemoryPerPoint = 4096;
constexpr std::uint64_t kMemoryPerTetgenPoint = 65536;
/// On a loaded machine; a million points take some ten seconds of processor time.
constexpr double kBaseSeconds = 60.0;
constexpr double kSecondsPerPoint = 1e-3;

const char* other_mesher(Mesher mesher) { return mesher == Mesher::kTetgen ? "delaunay" : "tetgen"; }

}  // namespace

FinishedMesh run_mesher(const MeshJob& job, const std::string& file, Progress* progress) {
  const std::filesystem::path program = find_helper(kMesherProgram);
  if (program.empty())
    throw usage_error(file + ": the mesher " + kMesherProgram +
                      " is not installed; it is built where libcgal-dev and libtet1.5-dev are");
  const auto points = static_cast<std::uint64_t>(job.wall.points.size());
  const std::uint64_t wanted =
      kBaseMemory + points * (job.mesher == Mesher::kTetgen ? kMemoryPerTetgenPoint : kMemoryPerPoint);
  const LoadLimits limits{std::min(wanted, usable_memory()),
                          kBaseSeconds + kSecondsPerPoint * static_cast<double>(points)};
  const Work work(std::string("helper ") + kMesherProgram, "fills the wall with tetrahedra");
  HelperProcess process(program, limits);
  MemoryFile memory;
  const std::string json = encode(job, memory);
  const auto reply = process.ask(memory, json, progress, "meshing");
  const std::string advice =
      std::string("; try --mesher ") + other_mesher(job.mesher) + " or another --refine";
  if (!reply) throw work_error(file + ": the mesher " + process.failure().what + advice);
  try {
    FinishedMesh mesh = decode_finished_mesh(reply->json, reply->memory->bytes(), job.wall.points.size());
    if (mesh.tets.empty()) throw work_error("the mesh has no tetrahedron");
    return mesh;
  } catch (const ProtocolError& error) {
    throw work_error(file + ": the mesher gave an answer that makes no sense: " + error.what());
  } catch (const Error& error) {
    throw Error(error.code(),
                file + ": " + error.what() + (error.code() == ExitCode::kWorkFailed ? advice : ""));
  }
}

}  // namespace palpate
