/// Vectors as users and files read them.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "common/base/text.h"
#include "common/math/vec.h"

namespace palpate {

/// The vector that begins at numbers[first]. @pre first + 3 <= numbers.size().
[[nodiscard]] inline Vec3 vec_at(std::span<const double> numbers, std::size_t first) noexcept {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// "1,0.5,2": as few digits as give the same numbers back.
[[nodiscard]] inline std::string exact_text(std::initializer_list<double> numbers) {
  std::string text;
  for (const double value : numbers) (text += text.empty() ? "" : ",") += exact_number(value);
  return text;
}
[[nodiscard]] inline std::string exact_text(const Vec3& v) { return exact_text({v.x, v.y, v.z}); }
/// "1 0.5 2": the same with blanks, as a row of a file.
[[nodiscard]] inline std::string exact_row(const Vec3& v) {
  return exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z);
}

/// "(1, 0.5, 2)": six digits, and no "-0" for what was turned around.
[[nodiscard]] inline std::string position_text(const Vec3& x) {
  return "(" + short_number(x.x + 0.0) + ", " + short_number(x.y + 0.0) + ", " + short_number(x.z + 0.0) +
         ")";
}

}  // namespace palpate
