/// The layer of a heart's wall that a document means.
#pragma once

#include <optional>

#include "common/base/text.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Where none is named, for what shows one.
inline constexpr double kViewLayer = 0.5;

/// `--layer`; none where it is not given.
/// @throws Error (usage).
[[nodiscard]] inline std::optional<double> layer_of(const HeartOptions& options) {
  if (options.layer.empty()) return std::nullopt;
  return parse_numbers(options.layer, 1, "--layer takes a depth from 0 (inner) to 1 (outer)").front();
}

}  // namespace palpate
