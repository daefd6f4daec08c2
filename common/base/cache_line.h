/// Keeps what different threads write on different cache lines.
#pragma once

#include <cstddef>

namespace palpate {

/// [bytes] Two lines of 64: processors fetch lines in pairs. A constant, so that layouts do not depend on
/// compiler options as std::hardware_destructive_interference_size does.
inline constexpr std::size_t kCacheLine = 128;

}  // namespace palpate
