/// What errno says, in words: std::strerror() may not be called from several threads.
#pragma once

#include <cerrno>
#include <string>
#include <system_error>

namespace palpate {

[[nodiscard]] inline std::string errno_text() { return std::generic_category().message(errno); }

}  // namespace palpate
