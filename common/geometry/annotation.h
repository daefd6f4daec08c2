/// Annotations of a data set: places, lengths, angles and areas that somebody has marked in it.
///
///   point:x,y,z          length:x,y,z,x,y,z       angle:x,y,z,x,y,z,x,y,z (at the second)
///   curve:x,y,z,…        area:x,y,z,…             and "=words" behind it: a label
///
/// Data coordinates. The area is that of the polygon through its points; where these lie on no plane, of its
/// projection that has the largest, A = |sum_i x_i x x_(i+1)| / 2.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/index.h"
#include "common/math/vec.h"

namespace palpate {

enum class AnnotationKind : std::uint8_t { kPoint, kLength, kAngle, kCurve, kArea };
inline constexpr int kAnnotationKindCount = 5;
[[nodiscard]] constexpr std::string_view name_of(AnnotationKind kind) noexcept {  ///< "length"
  constexpr std::array<std::string_view, kAnnotationKindCount> kNames{"point", "length", "angle", "curve",
                                                                      "area"};
  return kNames[as_size(kind)];
}

/// The fewest points, and the most; 0: as many as there are.
struct PointsNeeded {
  std::size_t least = 1, most = 1;
};
[[nodiscard]] PointsNeeded points_needed(AnnotationKind kind) noexcept;

struct Annotation {
  AnnotationKind kind = AnnotationKind::kPoint;
  std::vector<Vec3> points;
  std::string label;

  bool operator==(const Annotation&) const = default;
};

/// Length and length of a curve [data units], angle [degrees], area [data units squared]; 0 of a point. NaN
/// of an angle with a side of no length.
[[nodiscard]] double measure_of(const Annotation& annotation) noexcept;
/// What measure_of() says, with its unit: "12.3 mm", "45 degrees"; empty of a point.
/// @param unit of lengths; empty: not known, "units".
[[nodiscard]] std::string measure_text(const Annotation& annotation, const std::string& unit);
/// The points as they are drawn: an area's first one again at the end.
[[nodiscard]] std::vector<Vec3> outline_of(const Annotation& annotation);

[[nodiscard]] std::string text_of(const Annotation& annotation);
/// @return what is wrong, in a few words; nothing where `annotation` has been read.
[[nodiscard]] std::optional<std::string> read_text(std::string_view text, Annotation& annotation);

}  // namespace palpate
