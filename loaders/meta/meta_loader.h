/// MetaImage volumes (.mha, .mhd), the fourth axis as time. Positions come out in RAS+ millimetres
/// where the header says how the patient lies; ITK, which writes most of these files, means LPS.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-meta.
[[nodiscard]] std::unique_ptr<Loader> make_meta_loader();

}  // namespace palpate
