#include "common/trace/line_errors.h"

#include <algorithm>
#include <utility>

#include "common/base/quantile.h"
#include "common/base/text.h"

namespace palpate {

LineErrors line_errors(std::span<const Line> lines, double diagonal, std::optional<double> tolerance) {
  LineErrors errors;
  if (tolerance) errors.within = 0;
  std::vector<double> held;
  for (const Line& line : lines) {
    if (line.points.empty()) continue;
    double error = 0.0;
    for (const LinePoint& point : line.points) error = std::max(error, point.error);
    errors.max = std::max(errors.max, error);
    if (tolerance && error <= *tolerance * std::max(line.points.back().arc, diagonal)) ++*errors.within;
    if (error < kUnheldError * diagonal) {
      held.push_back(error);
    } else {
      errors.unheld_seeds.push_back(line.seed);
    }
  }
  summarise(std::move(held), errors);
  return errors;
}

void summarise(std::vector<double> held, LineErrors& errors) {
  errors.held = held.size();
  if (held.empty()) return;
  errors.median = quantile(held, 0.5);
  errors.p95 = quantile(held, 0.95);
  errors.worst = held.back();
}

std::string errors_text(const LineErrors& errors) {
  std::string text = "error";
  if (errors.held > 0) {
    text += " median " + short_number(errors.median) + ", 95 % " + short_number(errors.p95) + ", worst " +
            short_number(errors.worst);
  }
  if (const std::size_t unheld = errors.unheld_seeds.size(); unheld > 0)
    text += (errors.held > 0 ? ", " : ": ") + counted(unheld, "line") + " not held";
  return text;
}

}  // namespace palpate
