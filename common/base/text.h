/// Numbers as users read them.
#pragma once

#include <cstdint>
#include <string>

namespace palpate {

/// Six significant digits: "0.00123", "1.5e-07".
[[nodiscard]] std::string short_number(double value);
/// As few digits as give the same number back.
[[nodiscard]] std::string exact_number(double value);
/// "2.7 MB"
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);
/// "1 line", "3 lines"
[[nodiscard]] std::string counted(std::uint64_t count, const std::string& noun);

}  // namespace palpate
