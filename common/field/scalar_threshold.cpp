#include "common/field/scalar_threshold.h"

#include <cstddef>
#include <variant>

#include "common/field/grid/sparse/sparse_statistics.h"

namespace palpate {

ValueHistogram value_histogram(const ScalarField& field) {
  constexpr std::size_t kBins = 1024;
  const double scale = field.value_scale();
  const double lowest = field.lowest() * scale;
  const double highest = field.highest() * scale;
  if (const AnalyticScalar* formula = field.analytic()) {
    constexpr std::size_t kSide = 65;
    const Box box = formula->bounds();
    const auto at_lattice = [&](std::size_t index) {
      const Vec3 at{index % kSide, index / kSide % kSide, index / (kSide * kSide)};
      return formula->value(box.lower + box.size() * (at / double{kSide - 1}));
    };
    return count_values(kSide * kSide * kSide, at_lattice, lowest, highest, kBins, 0);
  }
  if (const auto* sparse = std::get_if<SparseSpan>(&field.values().values)) {
    return count_values(
        *sparse->numbers, [scale](double number) { return number * scale; }, lowest, highest, kBins, 0);
  }
  return std::visit(
      [&](const auto& values) {
        const auto at_point = [&](std::size_t index) { return static_cast<double>(values[index]) * scale; };
        return count_values(values.size(), at_point, lowest, highest, kBins, 0);
      },
      field.values().values);
}

double otsu_threshold(const ScalarField& field) {
  if (field.lowest() > field.highest()) return 0.0;
  if (!(field.local_range() > 0.0)) return field.lowest();
  return otsu_threshold(value_histogram(field)) / field.value_scale();
}

}  // namespace palpate
