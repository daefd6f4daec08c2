/// Whether local rendering (volume/cached_volume.h) is worth it, by the times of pictures while view and volume
/// stand still. Plain arithmetic, no clock.
///
/// Symbols. f time of the picture that was drawn in full and kept; l of those that follow; l_0 the least of
/// the first kFirst of these.
///   l_0 >= f                                   it is slower: off, until view or volume are others
///   l > (l_0 + f) / 2, kPatience in a row      what is opaque has come far from where it was: kept anew
#pragma once

#include <algorithm>

namespace palpate {

class LocalRedraw {
 public:
  static constexpr int kFirst = 3, kPatience = 3;

  /// View or volume are others than before.
  void begin() noexcept { *this = {}; }
  /// Whether the next picture is to use what is kept, or to be kept.
  [[nodiscard]] bool on() const noexcept { return on_; }
  /// A picture took so long [ms], while on(). @param kept it was drawn in full and kept.
  /// @return whether the next one is to be kept anew.
  [[nodiscard]] bool drawn(double milliseconds, bool kept) noexcept {
    if (kept) {
      full_ = first_ = milliseconds;
      since_ = slow_ = 0;
      return false;
    }
    ++since_;
    if (since_ <= kFirst) {
      first_ = since_ == 1 ? milliseconds : std::min(first_, milliseconds);
      if (since_ == kFirst && first_ >= full_) on_ = false;
      return false;
    }
    slow_ = milliseconds > 0.5 * (first_ + full_) ? slow_ + 1 : 0;
    return slow_ == kPatience;
  }

 private:
  bool on_ = true;
  double full_ = 0.0, first_ = 0.0;  ///< f, l_0 [ms]
  int since_ = 0;                    ///< pictures since it was kept
  int slow_ = 0;                     ///< in a row
};

}  // namespace palpate
