/// Transfer functions of two measures: which colour and opacity matter has by its value and by how fast the
/// value changes there (Kniss, Kindlmann and Hansen 2002; Ikits 2006, sec. 2.1.1 and 5.7.2).
///
/// Symbols.  s value; m = |grad s| >= 0 [value / data unit]; regions i of the plane (s, m), each a box, an
/// ellipse or a triangle with colour c_i, opacity alpha_i along the reference length l and soft border b_i in
/// [0, 1]; u_i(s, m) the factor by which region i would have to be scaled about its middle for (s, m) to lie
/// on its border: less than 1 inside.
///
///   w_i = h(clamp((1 - u_i) / b_i, 0, 1)),   h(x) = x^2 (3 - 2 x)                                    (1)
///   tau l = sum_i -ln(1 - w_i alpha_i),      c = sum_i tau_i c_i / tau                               (2)
///
/// so where regions overlap there is the matter of both, in whatever order they stand. Outside all of them
/// nothing is seen. u is measured along the half axes of a box (the larger of both) and of an ellipse, and
/// for a triangle with barycentric coordinates q it is 1 - 3 min q.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// One region; its places are (value, gradient magnitude).
struct TransferRegion {
  enum class Shape : std::uint8_t { kBox, kEllipse, kTriangle };
  Shape shape = Shape::kBox;
  /// Two opposite corners of a box or of the box about an ellipse, three of a triangle.
  std::array<Vec2, 3> corners{Vec2(0.0), Vec2(1.0), Vec2(0.0)};
  Vec3f color{1.0F};     ///< sRGB, components in [0, 1]
  double opacity = 0.5;  ///< alpha, in [0, 1]
  double soft = 0.25;    ///< b, in [0, 1]: 0 is a hard border, 1 falls off from the middle on

  /// Those of `corners` that count.
  [[nodiscard]] std::size_t corner_count() const noexcept { return shape == Shape::kTriangle ? 3 : 2; }
  /// u at a place.
  [[nodiscard]] double border_place(const Vec2& place) const noexcept;
  bool operator==(const TransferRegion&) const = default;
};

inline constexpr std::size_t kMostRegions = 64;  ///< of one transfer function

/// "box", "ellipse", "triangle".
[[nodiscard]] std::string_view name_of(TransferRegion::Shape shape) noexcept;

/// A rectangle of places.
struct PlaceRange {
  Vec2 lower{HUGE_VAL};
  Vec2 upper{-HUGE_VAL};

  void include(const Vec2& place) noexcept {
    lower = glm::min(lower, place);
    upper = glm::max(upper, place);
  }
  [[nodiscard]] bool empty() const noexcept { return !(lower.x <= upper.x); }
};

class RegionTransfer {
 public:
  /// Shows nothing.
  RegionTransfer() = default;
  /// @throws Error (usage) naming the region that has a number that is not finite, a colour, opacity or soft
  /// border outside [0, 1], or no width, and for more than kMostRegions.
  explicit RegionTransfer(std::vector<TransferRegion> regions);

  [[nodiscard]] const std::vector<TransferRegion>& regions() const noexcept { return regions_; }

  struct Sample {
    Vec3f color{0.0F};
    double depth = 0.0;  ///< tau l
  };
  /// (2); NaN shows nothing.
  [[nodiscard]] Sample at(const Vec2& place) const noexcept;
  /// The box about all regions that are not clear; empty where all are.
  [[nodiscard]] PlaceRange extent() const noexcept;

  bool operator==(const RegionTransfer&) const = default;

 private:
  std::vector<TransferRegion> regions_;
};

/// The same regions with every place moved from its own between 0 and 1 to that between the ends of `range`.
/// @pre range is not empty and finite.
[[nodiscard]] RegionTransfer spread(const RegionTransfer& fractions, const PlaceRange& range);

/// To begin with: borders between kinds of matter, where values change fast, coloured by the value. Places
/// are fractions of the ranges of values and of gradient magnitudes.
[[nodiscard]] RegionTransfer boundary_regions();

// Transfer functions of value and gradient magnitude as text, one region a row:
//
//   # comments and blank lines are passed over
//   box,V,M,V,M,R,G,B,A,S               two opposite corners
//   ellipse,V,M,V,M,R,G,B,A,S           those of the box about it
//   triangle,V,M,V,M,V,M,R,G,B,A,S      three corners
//
// V value, M gradient magnitude [value / data unit], R,G,B colour (sRGB), A opacity, S soft border, the last
// five in [0, 1]. After a row `fractions`, places 0 to 1 stand for the lowest to the highest value, and for
// no gradient to the largest one of the data.

/// The ranges of values and of gradient magnitudes of the data: asked for only where places are fractions.
using DataRange = std::function<PlaceRange()>;

/// Whether the first row of `file` begins with a word of the grammar above; false where it cannot be read.
[[nodiscard]] bool is_region_file(const std::string& file);
/// @throws Error (bad input) naming the line that is no region.
[[nodiscard]] RegionTransfer read_regions(const std::string& file, const DataRange& range);
/// The text of a file that gives the same function back, bit by bit.
[[nodiscard]] std::string regions_text(const RegionTransfer& transfer);

/// The function on one line, as options and sessions have it: "regions:" and the rows, '/' between them.
[[nodiscard]] std::string region_text(const RegionTransfer& transfer);
/// What region_text() wrote, or a user; absent where `text` does not begin with "regions:".
/// @throws Error (usage) for rows that are none.
[[nodiscard]] std::optional<RegionTransfer> regions_from_text(const std::string& text,
                                                              const DataRange& range);

}  // namespace palpate
