/// `--mesher` where a heart is opened: its wall filled with tetrahedra before anything else sees it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"
#include "common/scene/remesher.h"
#include "common/scene/wall/wall_mesh.h"

namespace palpate {

/// @param usual where `--mesher` is not given. @throws Error (usage).
[[nodiscard]] WallMeshOptions wall_mesh_options(const Document& options, WallFilling usual);

/// Empty where the file's cells are taken as they are, which is the default. @throws Error (usage).
[[nodiscard]] Remesher remesher_of(const Document& options);

/// The input's only block, with the arrays of `names`. @throws Error, (bad input) where there are several.
[[nodiscard]] DataSet read_wall(Input& input, const std::vector<std::string>& names, Progress* progress);

/// Its fibres for a mesh, which has directions at its points; nothing where there are none. @throws Error.
[[nodiscard]] std::optional<HeartChoice> choice_for_mesh(const Input& input);

/// cached_or_made_mesh() of an open input; a built-in one has no file to keep anything beside. @throws as that.
[[nodiscard]] WallMesh mesh_of(const Input& input, const DataSet& block,
                               const std::optional<HeartChoice>& choice, const WallMeshOptions& options,
                               Progress* progress);

}  // namespace palpate
