/// Durations counted in fixed bins: 8 to an octave, so that a percentile is known to 12.5 %, from 1 ns to a
/// minute.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/base/index.h"

namespace palpate {

class TimeHistogram {
 public:
  /// Negative durations count as zero. @rt Safe.
  void add(std::int64_t nanoseconds) noexcept {
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(nanoseconds, 0));
    ++bins_[bin_of(ns)];
    ++count_;
    longest_ = std::max(longest_, ns);
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::uint64_t max_ns() const noexcept { return longest_; }  ///< exact

  /// The end of the bin below which, or in which, the part `p` in [0, 1] of the durations lies [ns], at most
  /// max_ns(); 0 while there are none.
  [[nodiscard]] std::uint64_t percentile_ns(double p) const noexcept {
    const double wanted = p * static_cast<double>(count_);
    std::uint64_t passed = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      passed += bins_[bin];
      if (passed > 0 && static_cast<double>(passed) >= wanted) {
        return bin + 1 < kBins ? std::min(last_of(bin), longest_) : longest_;
      }
    }
    return longest_;
  }

 private:
  static constexpr int kBits = 3;                  // 2^3 bins to an octave
  static constexpr std::size_t kBins = 34U << 3U;  // the last one takes all above 2^36 ns

  /// [0, 8) ns have a bin each; then the bit width chooses the octave and the next three bits the bin.
  static constexpr std::size_t bin_of(std::uint64_t ns) noexcept {
    if (ns < (1U << kBits)) return ns;
    const int octave = std::bit_width(ns) - kBits;
    const std::size_t bin = (as_size(octave) << kBits) + ((ns >> (octave - 1)) & ((1U << kBits) - 1));
    return std::min(bin, kBins - 1);
  }
  static constexpr std::uint64_t last_of(std::size_t bin) noexcept {
    if (bin < (1U << kBits)) return bin;
    const auto octave = static_cast<int>(bin >> kBits);
    const std::uint64_t mantissa = (1U << kBits) + (bin & ((1U << kBits) - 1));
    return ((mantissa + 1) << (octave - 1)) - 1;
  }

  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  std::uint64_t longest_ = 0;
};

}  // namespace palpate
