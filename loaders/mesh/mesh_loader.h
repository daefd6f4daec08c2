/// Loader of meshes in files that are read without a library: Gmsh, SU2, Tecplot's text, AVS UCD.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

[[nodiscard]] std::unique_ptr<Loader> make_mesh_loader();

}  // namespace palpate
