#include "common/window/controls/seed_choice.h"

#include <charconv>
#include <optional>
#include <vector>

namespace palpate {
namespace {

// "8,8,8" as whole positive numbers, or nothing.
std::optional<std::vector<int>> whole_numbers(std::string_view text) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    int number = 0;
    const auto [after, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 1) return std::nullopt;
    numbers.push_back(number);
    if (after == end) return numbers;
    if (*after != ',') return std::nullopt;
    at = after + 1;
  }
}

}  // namespace

SeedChoice seed_choice(std::string_view seeds) {
  SeedChoice choice;
  choice.text = seeds;
  const auto colon = seeds.find(':');
  const std::string_view kind = seeds.substr(0, colon);
  const auto numbers =
      colon == std::string_view::npos ? std::nullopt : whole_numbers(seeds.substr(colon + 1));
  if (kind == "grid" && numbers && numbers->size() == 3) {
    choice.grid = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  } else if ((kind == "random" || kind == "speed") && numbers && numbers->size() == 1) {
    choice.kind = kind == "random" ? SeedChoice::Kind::kRandom : SeedChoice::Kind::kSpeed;
    choice.count = numbers->front();
  } else {
    choice.kind = SeedChoice::Kind::kText;
  }
  return choice;
}

std::string seeds_text(const SeedChoice& choice) {
  switch (choice.kind) {
    case SeedChoice::Kind::kGrid:
      return "grid:" + std::to_string(choice.grid[0]) + "," + std::to_string(choice.grid[1]) + "," +
             std::to_string(choice.grid[2]);
    case SeedChoice::Kind::kRandom:
      return "random:" + std::to_string(choice.count);
    case SeedChoice::Kind::kSpeed:
      return "speed:" + std::to_string(choice.count);
    case SeedChoice::Kind::kText:
      break;
  }
  return choice.text;
}

}  // namespace palpate
