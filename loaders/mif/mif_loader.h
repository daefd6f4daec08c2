/// MRtrix's images: .mif, .mif.gz, and .mih beside its data. Positions come out in RAS+ millimetres.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-mif.
[[nodiscard]] std::unique_ptr<Loader> make_mif_loader();

}  // namespace palpate
