/// Series of DICOM images. Positions and gradients come out in RAS+ millimetres.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-dicom.
[[nodiscard]] std::unique_ptr<Loader> make_dicom_loader();

}  // namespace palpate
