/// Which tracts a picture shows while there is no time for all of them. Pure arithmetic.
///
/// Opaque tracts are added to what is there, piece by piece, until all are there. Of transparent ones a part
/// s shows as much of what lies behind as all do, if its opacity is higher:
///   a' = min(1, a / s)                                                                      (1)
/// Where n lines lie over a place on the average, by chance and not in step, light passes all of them with
/// the odds exp(-n a), and a part of them with exp(-n s a'): the same, as long as a <= s. With fewer tracts
/// than that the part is fainter than all would be, as it is with opaque ones. Parts grow fourfold, each
/// drawn anew with its own opacity and shown when it is whole; the last one has all tracts, and the opacity
/// asked for.
#pragma once

#include <cstddef>

namespace palpate {

/// (1). @pre opacity in (0, 1], share in (0, 1].
[[nodiscard]] double opacity_of_part(double opacity, double share) noexcept;

/// How many tracts a picture shows.
struct TractShare {
  std::size_t drawn = 0, all = 0;  ///< lines
  double milliseconds = 0.0;       ///< that it took to draw those that were added
};

class TractProgress {
 public:
  /// A picture without tracts.
  /// @param expected pieces there will be time for in the first picture, one at least.
  void begin(std::size_t pieces, double opacity, std::size_t expected) noexcept;
  /// To be asked before each picture: whether its tracts go on to one without any. True once for each part.
  [[nodiscard]] bool begins_anew() noexcept;
  /// Pieces to be drawn now, [next, goal), and how.
  [[nodiscard]] std::size_t next() const noexcept { return next_; }
  [[nodiscard]] std::size_t goal() const noexcept { return goal_; }
  [[nodiscard]] double opacity() const noexcept;
  /// Pieces before `next` are drawn.
  void drawn(std::size_t next) noexcept;
  /// Whether what is drawn by now replaces what is shown.
  [[nodiscard]] bool worth_showing() const noexcept { return first_part_ || next_ == goal_; }
  /// Pieces in what is shown, if it was replaced whenever that was worth it.
  [[nodiscard]] std::size_t shown() const noexcept { return shown_; }
  [[nodiscard]] bool complete() const noexcept { return shown_ == pieces_; }

 private:
  std::size_t pieces_ = 0, next_ = 0, goal_ = 0, shown_ = 0;
  double opacity_ = 1.0;
  bool begun_ = true, first_part_ = true;
};

/// How long a picture in motion may spend on tracts: what the budget leaves beside all else.
class TractTime {
 public:
  /// @param budget [ms] > 0, of a whole picture.
  explicit TractTime(double budget) noexcept : budget_(budget) {}
  /// @return [ms], a fifth of the budget at least. At rest, where nothing has to keep up, most of it.
  [[nodiscard]] double milliseconds(bool moving) const noexcept;
  /// A picture in motion took so long in all, and on tracts.
  void drawn(double picture, double tracts) noexcept;

 private:
  double budget_;
  double rest_ = 0.0;  ///< all but tracts [ms], the mean of the last pictures, newer ones counting more
};

}  // namespace palpate
