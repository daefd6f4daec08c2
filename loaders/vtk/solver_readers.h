/// The readers of solver formats: each is a Loader for one format.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

[[nodiscard]] std::unique_ptr<Loader> make_plot3d_reader();
[[nodiscard]] std::unique_ptr<Loader> make_exodus_reader();
[[nodiscard]] std::unique_ptr<Loader> make_ensight_reader();
[[nodiscard]] std::unique_ptr<Loader> make_openfoam_reader();

/// The Loader of the helper program palpate-load-solver: one of the above, by format.
[[nodiscard]] std::unique_ptr<Loader> make_solver_loader();

}  // namespace palpate
