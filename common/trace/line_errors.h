/// What lines state of their own errors, taken together.
///
/// The error of a line is the largest estimate along it. Where it grows to the size of the domain, which it
/// does in chaotic flows however small the steps' errors are, the line says no more where its seed goes than
/// that it stays inside: such a line is not held, and counted apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/line.h"

namespace palpate {

/// A line is not held from this part of the diagonal on.
inline constexpr double kUnheldError = 0.1;

/// Data units.
struct LineErrors {
  double max = 0.0;                         ///< of all lines
  std::size_t held = 0;                     ///< lines that the next three are of
  double median = 0.0, p95 = 0.0;           ///< 95 % of the held lines state no more; 0 where there are none
  double worst = 0.0;                       ///< of the held lines
  std::optional<std::size_t> within;        ///< lines that keep the tolerance, where there is one
  std::vector<std::uint32_t> unheld_seeds;  ///< of each line that is not held
};

/// @param diagonal of the domain. @param tolerance error allowed for each diagonal begun, relative to it.
[[nodiscard]] LineErrors line_errors(std::span<const Line> lines, double diagonal,
                                     std::optional<double> tolerance = std::nullopt);

/// Number, median, 95 % and worst of the errors of held lines, into `errors`.
void summarise(std::vector<double> held, LineErrors& errors);

/// "error median 1e-07, 95 % 3e-07, worst 2e-06, 3 lines not held"
[[nodiscard]] std::string errors_text(const LineErrors& errors);

}  // namespace palpate
