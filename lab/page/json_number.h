/// Numbers in JSON, which has no infinity.
#pragma once

#include <cmath>

#include "common/base/json.h"

namespace palpate {

/// The number; null where it is none or has no end: it was not reached.
[[nodiscard]] inline Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace palpate
