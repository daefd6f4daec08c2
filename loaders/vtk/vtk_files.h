/// VTK's own formats: legacy .vtk, .vti .vtr .vts .vtu, indices of blocks (.vtm) and of time steps (.pvd,
/// .vtu.series), and several files at once.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-vtk.
[[nodiscard]] std::unique_ptr<Loader> make_vtk_loader();

}  // namespace palpate
