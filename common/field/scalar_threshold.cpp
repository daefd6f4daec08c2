#include "common/field/scalar_threshold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

namespace palpate {
namespace {

constexpr std::size_t kBins = 1024;
using Bins = std::array<double, kBins>;

/// How many values lie in each bin of the range, which is taken as 1.
Bins histogram(const ScalarField& field) {
  Bins bins{};
  const double scale = field.value_scale();
  const double lowest = field.lowest() * scale, range = field.local_range();
  const auto count = [&](double local) {
    if (!std::isfinite(local)) return;
    const double at = (local - lowest) / range * static_cast<double>(kBins);
    bins[std::min(static_cast<std::size_t>(std::max(at, 0.0)), kBins - 1)] += 1.0;
  };
  if (const AnalyticScalar* formula = field.analytic()) {
    constexpr int kSteps = 64;
    const Box box = formula->bounds();
    for (int k = 0; k <= kSteps; ++k) {
      for (int j = 0; j <= kSteps; ++j) {
        for (int i = 0; i <= kSteps; ++i) {
          count(formula->value(box.lower + box.size() * (Vec3(i, j, k) / double{kSteps})));
        }
      }
    }
    return bins;
  }
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) count(static_cast<double>(value) * scale);
      },
      field.values().values);
  return bins;
}

}  // namespace

double otsu_threshold(const ScalarField& field) {
  if (field.lowest() > field.highest()) return 0.0;
  if (!(field.local_range() > 0.0)) return field.lowest();
  const Bins bins = histogram(field);
  double total = 0.0, sum = 0.0;
  for (std::size_t b = 0; b < kBins; ++b) {
    total += bins[b];
    sum += bins[b] * static_cast<double>(b);
  }
  double below = 0.0, sum_below = 0.0, best = -1.0;
  std::size_t first = 0, last = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    below += bins[b];
    sum_below += bins[b] * static_cast<double>(b);
    const double above = total - below;
    if (below == 0.0 || above == 0.0) continue;
    const double apart = sum_below / below - (sum - sum_below) / above;
    const double between = below * above * apart * apart;
    if (between > best) first = b + 1;
    if (between >= best) last = b + 1;
    best = std::max(best, between);
  }
  const double part = 0.5 * static_cast<double>(first + last) / static_cast<double>(kBins);
  return field.lowest() + part * (field.highest() - field.lowest());
}

}  // namespace palpate
