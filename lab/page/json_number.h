/// Numbers in JSON, which has no infinity.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

namespace palpate {

/// The number; null where it is none or has no end: it was not reached.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace palpate
