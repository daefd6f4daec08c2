#include "common/geometry/line.h"

#include <array>

#include "common/base/index.h"

namespace palpate {

std::string_view name_of(End end) noexcept {
  static constexpr std::array<std::string_view, kEndCount> kNames{
      "left_domain", "stagnation", "max_length",      "max_time",     "max_steps",
      "loop",        "bad_data",   "stopped_by_rule", "below_cutoff", "sharp_turn"};
  return kNames[as_size(end)];
}

}  // namespace palpate
