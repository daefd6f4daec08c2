/// The surfaces of a wall, written and put into words: `info --surfaces`.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/progress.h"
#include "common/cli/summaries.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// Finds them, measures the wall between them and writes them to `--surfaces`.
/// @throws Error as open_wall(), solve_laplace(), write_surface(); Cancelled.
[[nodiscard]] WallSurfacesSummary report_wall_surfaces(Input& input, const Document& options,
                                                       Progress& progress);

/// Whether `--surfaces` asks for a mesh that names them, in place of their triangles.
[[nodiscard]] bool is_tagged_mesh(const std::filesystem::path& file);

/// As lines of `info`.
[[nodiscard]] std::string surfaces_text(const WallSurfacesSummary& summary);

}  // namespace palpate
