/// Grids of OpenVDB (Museth 2013): numbers and vectors of three, on the box of their active voxels.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-vdb. Points are the voxels' centres, at the place that the
/// grid's transform gives them; outside its active voxels a grid has its background, or the values of its
/// inactive tiles (inside a level set). Grids that lie on the lattice of the first one are read together.
[[nodiscard]] std::unique_ptr<Loader> make_vdb_loader();

}  // namespace palpate
