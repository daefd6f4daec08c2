/// NIfTI images through niftilib: versions 1 and 2, in one file or two, packed by gzip or not, in any byte
/// order. Positions come out in RAS+ millimetres.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-nifti.
[[nodiscard]] std::unique_ptr<Loader> make_nifti_loader();

}  // namespace palpate
