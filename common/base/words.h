/// Words that options take, looked up.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "common/base/error.h"

namespace palpate {

/// The index of `word`. @param what the words name: "colour". @throws Error (usage) that lists the known
/// ones.
template <std::size_t N>
[[nodiscard]] std::size_t find_word(const std::array<std::string_view, N>& words, std::string_view word,
                                    const char* what) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string known;
  for (const std::string_view one : words) {
    if (!known.empty()) known += ", ";
    known += one;
  }
  throw usage_error("unknown " + std::string(what) + " '" + std::string(word) + "'; known are " + known);
}

}  // namespace palpate
