/// A picture of a made mesh: what its report says in numbers, to be looked at.
#pragma once

#include <string>

#include "common/field/grid/tet_mesh.h"
#include "common/render/scene_view.h"

namespace palpate {

/// The mesh cut open along whole cells through its middle, towards the viewer: the faces of the farther half,
/// coloured by the smallest dihedral angle of their cell [degrees], of which a regular one has 70.5.
/// @param aspect width / height of the picture.
[[nodiscard]] SceneView mesh_view(const TetMesh& mesh, const std::string& title, double aspect);

}  // namespace palpate
