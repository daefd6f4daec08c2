#include "common/field/value_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "common/base/check.h"
#include "common/base/parallel.h"
#include "common/field/grid/sparse/sparse_statistics.h"

namespace palpate {

double ValueHistogram::value_of(std::size_t bin) const noexcept {
  const double t = (static_cast<double>(bin) + 0.5) / static_cast<double>(counts.size());
  return (1.0 - t) * lower + t * upper;
}

HistogramBins::HistogramBins(double lower, double upper, std::size_t bins) noexcept
    : lower_(lower),
      upper_(upper),
      half_width_(0.5 * upper - 0.5 * lower),
      bins_(static_cast<double>(bins)),
      last_(bins_ - 1.0) {
  PALPATE_CHECK(bins >= 1 && std::isfinite(lower) && std::isfinite(upper) && lower <= upper);
}

ValueHistogram count_values(std::size_t count, const std::function<double(std::size_t)>& value_at,
                            double lower, double upper, std::size_t bins, int threads) {
  // Counts of pieces that do not depend on the threads are added up in the end: whole numbers, any order.
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  const std::size_t pieces = (count + kPiece - 1) / kPiece;
  std::vector<std::vector<std::uint64_t>> found(pieces);
  const HistogramBins places(lower, upper, bins);
  parallel_for(pieces, threads, [&](std::size_t first, std::size_t end) {
    for (std::size_t p = first; p < end; ++p) {
      found[p].assign(bins, 0);
      for (std::size_t i = p * kPiece; i < std::min(count, (p + 1) * kPiece); ++i) {
        if (const auto bin = places.of(value_at(i))) ++found[p][*bin];
      }
    }
  });
  ValueHistogram histogram{.lower = lower, .upper = upper, .counts = std::vector<std::uint64_t>(bins, 0)};
  for (const auto& piece : found) {
    for (std::size_t bin = 0; bin < bins; ++bin) histogram.counts[bin] += piece[bin];
  }
  for (const std::uint64_t n : histogram.counts) histogram.total += n;
  return histogram;
}

ValueHistogram bulk_histogram(const std::function<ValueHistogram(double lower, double upper)>& count,
                              double lower, double upper) {
  constexpr double kFew = 0.0005, kNarrow = 1.0 / 256.0;
  constexpr int kMostTimes =
      16;  // each takes eight binary exponents off: from the largest single precision to 1
  const ValueHistogram whole = count(lower, upper);
  ValueHistogram bulk = whole;
  for (int time = 0; time < kMostTimes && bulk.lower < bulk.upper; ++time) {
    // Bins are taken off the ends, the emptier end first, as long as only a few values go.
    std::size_t first = 0, last = bulk.counts.size();
    const std::uint64_t few =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kFew * static_cast<double>(whole.total)));
    std::uint64_t gone = whole.total - bulk.total;
    while (last - first > 1) {
      const std::uint64_t below = bulk.counts[first], above = bulk.counts[last - 1];
      if (gone + std::min(below, above) > few) break;
      gone += std::min(below, above);
      if (below <= above) {
        ++first;
      } else {
        --last;
      }
    }
    const auto bins = static_cast<double>(bulk.counts.size());
    if (!(static_cast<double>(last - first) < kNarrow * bins)) return bulk;
    const double half_width = (0.5 * bulk.upper - 0.5 * bulk.lower) / bins;
    const double from = bulk.lower + 2.0 * half_width * static_cast<double>(first);
    const double to =
        last == bulk.counts.size() ? bulk.upper : bulk.lower + 2.0 * half_width * static_cast<double>(last);
    if (!(bulk.lower < from || to < bulk.upper) || !(from < to)) return whole;
    bulk = count(from, to);
  }
  return whole;  // all but a few are the same
}

double otsu_threshold(const ValueHistogram& histogram) noexcept {
  const std::size_t bins = histogram.counts.size();
  double sum = 0.0;  // of bin numbers: the scale of the values does not matter
  for (std::size_t bin = 0; bin < bins; ++bin)
    sum += static_cast<double>(histogram.counts[bin]) * static_cast<double>(bin);
  const auto total = static_cast<double>(histogram.total);
  double below = 0.0;
  double sum_below = 0.0;
  double best = 0.0;
  std::size_t first_best = 0;
  std::size_t last_best = 0;
  for (std::size_t bin = 0; bin + 1 < bins; ++bin) {
    below += static_cast<double>(histogram.counts[bin]);
    sum_below += static_cast<double>(histogram.counts[bin]) * static_cast<double>(bin);
    if (below == 0.0 || below == total) continue;
    const double difference = sum_below / below - (sum - sum_below) / (total - below);
    const double between = below * (total - below) * difference * difference;
    if (between > best) {
      best = between;
      first_best = last_best = bin + 1;
    } else if (between == best && best > 0.0) {
      last_best = bin + 1;  // empty bins between two classes part them equally well
    }
  }
  if (best == 0.0) return histogram.lower;
  const double t = 0.5 * static_cast<double>(first_best + last_best) / static_cast<double>(bins);
  return (1.0 - t) * histogram.lower + t * histogram.upper;
}

double mean_below(const ValueHistogram& histogram, double value) noexcept {
  double count = 0.0;
  double mean = histogram.lower;
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    const auto n = static_cast<double>(histogram.counts[bin]);
    if (n == 0.0 || histogram.value_of(bin) >= value) continue;
    count += n;
    mean += n / count * (histogram.value_of(bin) - mean);
  }
  return mean;
}

double value_below_which(const ValueHistogram& histogram, double part, double from) noexcept {
  std::uint64_t all = 0;
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    if (histogram.value_of(bin) >= from) all += histogram.counts[bin];
  }
  if (all == 0) return histogram.upper;
  const double wanted = part * static_cast<double>(all);
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    if (histogram.value_of(bin) < from) continue;
    below += histogram.counts[bin];
    if (below > 0 && static_cast<double>(below) >= wanted) return histogram.value_of(bin);
  }
  return histogram.upper;
}

double part_below(const ValueHistogram& histogram, double value) noexcept {
  if (histogram.total == 0 || !(value > histogram.lower)) return 0.0;
  if (value > histogram.upper) return 1.0;
  const auto bins = static_cast<double>(histogram.counts.size());
  const double place = (value - histogram.lower) / (histogram.upper - histogram.lower) * bins;
  const auto whole = static_cast<std::size_t>(std::min(place, bins - 1.0));
  double below = (place - static_cast<double>(whole)) * static_cast<double>(histogram.counts[whole]);
  for (std::size_t bin = 0; bin < whole; ++bin) below += static_cast<double>(histogram.counts[bin]);
  return below / static_cast<double>(histogram.total);
}

ValueWindow default_window(const ValueHistogram& histogram) noexcept {
  constexpr double kBrightest = 0.995;
  double white = value_below_which(histogram, kBrightest, histogram.lower);
  if (!(white > histogram.lower)) white = histogram.upper;
  const double width = white > histogram.lower ? white - histogram.lower : 1.0;
  return {width, histogram.lower + 0.5 * width};
}

namespace {

/// Local values.
ValueHistogram counted_between(const ScalarField& field, double lowest, double highest) {
  constexpr std::size_t kBins = 1024;
  const double scale = field.value_scale();
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

}  // namespace

ValueHistogram value_histogram(const ScalarField& field) {
  const double scale = field.value_scale();
  return counted_between(field, field.lowest() * scale, field.highest() * scale);
}

double otsu_threshold(const ScalarField& field) {
  if (field.lowest() > field.highest()) return 0.0;
  if (!(field.local_range() > 0.0)) return field.lowest();
  const double scale = field.value_scale();
  const ValueHistogram histogram =
      bulk_histogram([&](double lower, double upper) { return counted_between(field, lower, upper); },
                     field.lowest() * scale, field.highest() * scale);
  return otsu_threshold(histogram) / scale;
}

}  // namespace palpate
