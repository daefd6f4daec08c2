/// What frames of each quality take: the time of the error-against-time model that a frame budget chooses by.
/// Plain arithmetic, no clock.
///
/// Symbols. c, f, v, r, d the shares of a FrameQuality: samples around lenses and inside, pixels around lenses
/// and all, segments of lines; t time of a frame. Rays cost by their samples, lines by their segments, the rest of a frame by its pixels, or
/// nothing depends on any:
///
///   t(q) = p_0 + r^2 (p_1 + p_2 c v^2 + p_3 f) + p_4 d,   p_j >= 0                                 (1)
///
/// Scenes change, and t with them; how the times of two qualities that followed one another compare changes
/// little. So p is fitted to the last kChanges changes from a quality a to b, later ones with more weight:
///
///   p_j = s o_j u_j,   min over u >= kLeast of  sum_i w_i (t_i(b) / t_b - t_i(a) / t_a)^2 + (t_n(u) / t_n -
///   1)^2
///                                               + kTie sum_j (u_j - 1)^2 (2)
///
/// with o the usual p, n the last frames, and s such that t(q_n) = t_n: what no change has told stays as it
/// usually is.
#pragma once

#include <array>
#include <cstddef>

#include "common/render/budget/frame_quality.h"

namespace palpate {

class QualityTimes {
 public:
  static constexpr std::size_t kChanges = 16;

  QualityTimes() = default;
  /// Of a picture of lines alone, of a volume, or of one with lenses.
  QualityTimes(bool volume, bool lenses) noexcept;

  /// A frame of `quality` took so long [ms]. @pre finite and above 0.
  void add(const FrameQuality& quality, double milliseconds) noexcept;
  /// Whether frames were added.
  [[nodiscard]] bool known() const noexcept { return last_.milliseconds > 0.0; }
  /// (1) [ms]; before frames were added in a unit of its own.
  [[nodiscard]] double of(const FrameQuality& quality) const noexcept;

 private:
  using Parts = std::array<double, 5>;
  /// Frames of one quality, one after the other.
  struct Frames {
    FrameQuality quality;
    double milliseconds = 0.0;  ///< mean, later ones with more weight
  };
  struct Change {
    Frames from, to;
  };
  [[nodiscard]] static Parts parts_of(const FrameQuality& quality) noexcept;
  void fit() noexcept;

  Parts usual_{0.05, 0.35, 0.0, 0.0, 0.6};  ///< o
  Parts p_ = usual_;
  Frames last_, before_;
  std::array<Change, kChanges> changes_{};  ///< a ring; the newest one holds last_
  std::size_t change_count_ = 0;            ///< so far
};

}  // namespace palpate
