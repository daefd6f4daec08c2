/// Units of length as headers of images spell them.
#pragma once

#include <optional>
#include <string_view>

namespace palpate {

/// Millimetres in a unit ("um", "millimeters", "cm"), whatever the case of its letters; nothing of an unknown word.
[[nodiscard]] std::optional<double> millimetres_in(std::string_view unit);

}  // namespace palpate
