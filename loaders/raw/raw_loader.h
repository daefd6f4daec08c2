/// Voxels without a header, as the request's RawLayout says.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-raw.
[[nodiscard]] std::unique_ptr<Loader> make_raw_loader();

}  // namespace palpate
