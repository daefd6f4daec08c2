/// Vectors as users and files read them.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "common/math/vec.h"

namespace palpate {

/// "1,0.5,2": as few digits as give the same numbers back.
[[nodiscard]] std::string exact_text(const Vec3& v);
[[nodiscard]] std::string exact_text(std::initializer_list<double> numbers);

/// The vector that begins at numbers[first]. @pre first + 3 <= numbers.size().
[[nodiscard]] inline Vec3 vec_at(std::span<const double> numbers, std::size_t first) noexcept {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

}  // namespace palpate
