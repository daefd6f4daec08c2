/// Numbers in the text of options and tables.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace palpate {

/// Without blanks and line ends around it.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// The number that `text` is, blanks and a plus sign allowed; NaN and infinity are numbers too.
[[nodiscard]] std::optional<double> number(std::string_view text) noexcept;

/// The parts between separators, empty ones included.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace palpate
