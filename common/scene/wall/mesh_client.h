/// Starting the mesher's helper program, and what comes back from it.
#pragma once

#include <string>

#include "common/base/progress.h"
#include "common/scene/wall/mesh_job.h"

namespace palpate {

/// Runs palpate-mesh once, in the memory that the job justifies.
/// @param file for messages.
/// @throws Error (work failed) where the mesher refuses, crashes, takes too long or gives no tetrahedron;
/// (usage) where it is not installed; Cancelled.
[[nodiscard]] FinishedMesh run_mesher(const MeshJob& job, const std::string& file, Progress* progress);

}  // namespace palpate
