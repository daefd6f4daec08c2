/// Heart models: EX files, openCARP, TetGen and Chaste.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-cardiac.
[[nodiscard]] std::unique_ptr<Loader> make_cardiac_loader();

}  // namespace palpate
