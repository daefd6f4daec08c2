/// A sequence of random numbers that a few whole numbers decide: the same on every machine, in any order of use.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/math/counter_random.h"

namespace palpate {

class RandomStream {
 public:
  /// @param names what it is for, as numbers: other ones give an independent sequence.
  explicit RandomStream(std::initializer_list<std::uint64_t> names) noexcept {
    for (const std::uint64_t name : names) state_ = mixed(state_ ^ mixed(name + 0x9e3779b97f4a7c15U));
  }

  /// In [0, 1).
  double uniform() noexcept { return uniform_at(state_ + next_++); }
  double uniform(double lower, double upper) noexcept { return lower + (upper - lower) * uniform(); }
  /// Of the standard normal distribution (Box and Muller 1958).
  double normal() noexcept {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  /// From 0 to count - 1. @pre count > 0.
  std::size_t below(std::size_t count) noexcept {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }
  /// 0 to count - 1 in a random order (Fisher and Yates).
  std::vector<int> order(int count) {
    std::vector<int> out(as_size(count));
    for (int i = 0; i < count; ++i) out[as_size(i)] = i;
    for (std::size_t i = out.size(); i > 1; --i) std::swap(out[i - 1], out[below(i)]);
    return out;
  }

 private:
  static constexpr std::uint64_t mixed(std::uint64_t z) noexcept {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  std::uint64_t state_ = 0;
  std::uint64_t next_ = 0;
};

}  // namespace palpate
