/// Tractograms: .tck, .trk and .trx. Positions come out in RAS+ millimetres.
#pragma once

#include <memory>

#include "common/load/helper/serve.h"

namespace palpate {

/// What may be wrong with a file that contradicts itself.
inline constexpr const char* kDamagedTracts = "the file may be damaged or cut off";

/// The Loader of the helper program palpate-load-tract. Its one block has the grid "lines": a cell a line,
/// point arrays and cell arrays of one component.
[[nodiscard]] std::unique_ptr<Loader> make_tract_loader();

}  // namespace palpate
