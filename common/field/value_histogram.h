/// How often values occur, and what that says of a volume: where its background ends, and its brightest part.
///
/// Symbols.  n_i count of bin i of N, over [lower, upper]; s_i value at the middle of bin i.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/field/scalar_field.h"

namespace palpate {

struct ValueHistogram {
  double lower = 0.0;
  double upper = 0.0;
  /// n_i, bins of equal width; a value on a border counts for the upper bin.
  std::vector<std::uint64_t> counts;
  std::uint64_t total = 0;  ///< of finite values

  /// s_i. @pre bin < counts.size().
  [[nodiscard]] double value_of(std::size_t bin) const noexcept;
};

/// The bins of a histogram. @pre bins >= 1, lower <= upper, both finite.
class HistogramBins {
 public:
  HistogramBins(double lower, double upper, std::size_t bins) noexcept;
  /// The one that a value counts for; none where it is not finite or lies outside.
  [[nodiscard]] std::optional<std::size_t> of(double value) const noexcept {
    if (!(value >= lower_ && value <= upper_)) return std::nullopt;
    const double t = half_width_ > 0.0 ? (0.5 * value - 0.5 * lower_) / half_width_ : 0.0;
    return static_cast<std::size_t>(t * bins_ < last_ ? t * bins_ : last_);
  }

 private:
  double lower_, upper_;
  double half_width_;  ///< halved before the difference is taken, which could overflow
  double bins_, last_;
};

/// Counts value_at(0) to value_at(count - 1) in `bins` bins over [lower, upper]; values that are not finite
/// or lie outside are left out. The result does not depend on the number of threads (0: as many as there are
/// cores). @pre bins >= 1, lower <= upper, both finite; value_at may be called from any thread.
[[nodiscard]] ValueHistogram count_values(std::size_t count,
                                          const std::function<double(std::size_t)>& value_at, double lower,
                                          double upper, std::size_t bins, int threads);

/// A histogram that a few values far from all others do not flatten: where all but one value in two thousand at most
/// (one of fewer) lie in less than a 256th of the range, what lies there is counted anew, again and again. Where these are all of one value, the
/// whole range stays: what is rare may be what is looked for.
/// @param count bins over [lower, upper] (count_values()); at least 512 of them. @pre lower <= upper, finite.
[[nodiscard]] ValueHistogram bulk_histogram(
    const std::function<ValueHistogram(double lower, double upper)>& count, double lower, double upper);

/// Otsu's threshold (Otsu 1979): the border between bins by which the mean values of both classes differ
/// most,
///
///   w_0 w_1 (mu_0 - mu_1)^2   is largest, w the classes' weights and mu their means,
///
/// the middle of all borders that are as good: where a background ends that most of a volume consists of.
/// `lower` where all values lie in one bin.
[[nodiscard]] double otsu_threshold(const ValueHistogram& histogram) noexcept;

/// The mean of the values below `value`, each taken as that of its bin; `lower` where there are none.
[[nodiscard]] double mean_below(const ValueHistogram& histogram, double value) noexcept;

/// The lowest bin's value at or below which at least `part` in [0, 1] of the values from `from` on lie;
/// `upper` where there are none.
[[nodiscard]] double value_below_which(const ValueHistogram& histogram, double part, double from) noexcept;

/// The part in [0, 1] of all values that are lower than `value`, those of its own bin taken as evenly spread:
/// its place in the histogram. 0 where there are none, or the value is NaN.
[[nodiscard]] double part_below(const ValueHistogram& histogram, double value) noexcept;

/// Which values a grey picture shows: black at `level` - `width` / 2, white at `level` + `width` / 2.
struct ValueWindow {
  double width = 1.0;  ///< > 0
  double level = 0.5;

  bool operator==(const ValueWindow&) const = default;
};

/// From `histogram.lower` to the value that only the brightest two hundredth pass, so that a few bright
/// voxels do not leave the rest in the dark; one wide about the value where all are the same.
[[nodiscard]] ValueWindow default_window(const ValueHistogram& histogram) noexcept;

// The value that parts a scalar field best into two: what is shown and felt of a volume before anybody has
// chosen an isovalue.

/// How many of the values at the points lie in each of 1024 bins over their range, local values; a formula is
/// asked on a lattice. @pre field.lowest() <= field.highest().
[[nodiscard]] ValueHistogram value_histogram(const ScalarField& field);

/// Otsu's threshold of bulk_histogram(), data units. The lowest value where there is no
/// range; 0 where no value is finite.
[[nodiscard]] double otsu_threshold(const ScalarField& field);

}  // namespace palpate
