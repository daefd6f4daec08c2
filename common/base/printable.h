/// Text from files as a terminal may show it.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

/// Control characters as "\x1b": names in a file cannot move the cursor, or break a message into lines. Bytes
/// from 0x80 on stay as they are (UTF-8), and so do those of `kept`.
[[nodiscard]] std::string printable(std::string_view text, std::string_view kept = "");

}  // namespace palpate
