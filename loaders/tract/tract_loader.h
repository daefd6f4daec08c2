/// Tractograms: .tck, .trk and .trx. Positions come out in RAS+ millimetres.
#pragma once

#include <memory>

#include "common/load/serve.h"

namespace palpate {

/// The Loader of the helper program palpate-load-tract. Its one block has the grid "lines": a cell a line,
/// point arrays and cell arrays of one component.
[[nodiscard]] std::unique_ptr<Loader> make_tract_loader();

}  // namespace palpate
