/// How much memory the machine has.
#pragma once

#include <cstdint>

namespace palpate {

/// Physical memory in bytes; the largest number where the system does not say.
[[nodiscard]] std::uint64_t machine_memory() noexcept;

/// What one piece of work may take of it: three quarters, so that the machine goes on answering.
[[nodiscard]] inline std::uint64_t usable_memory() noexcept { return machine_memory() / 4 * 3; }

}  // namespace palpate
