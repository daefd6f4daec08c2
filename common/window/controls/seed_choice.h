/// Seeds as the panel offers them: a kind and its numbers, to and from the grammar of --seeds.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace palpate {

struct SeedChoice {
  enum class Kind { kGrid, kRandom, kSpeed, kText };
  Kind kind = Kind::kGrid;
  std::array<int, 3> grid{8, 8, 8};
  int count = 200;   ///< kRandom, kSpeed
  std::string text;  ///< kText: any other seeds, as typed

  bool operator==(const SeedChoice&) const = default;
};

[[nodiscard]] SeedChoice seed_choice(std::string_view seeds);
[[nodiscard]] std::string seeds_text(const SeedChoice& choice);

}  // namespace palpate
