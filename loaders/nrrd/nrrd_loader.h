/// NRRD images through Teem: attached and detached, every encoding that Teem was built with, any byte order.
/// Positions and vectors come out in RAS+ millimetres where the header names a medical space.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-nrrd.
[[nodiscard]] std::unique_ptr<Loader> make_nrrd_loader();

}  // namespace palpate
