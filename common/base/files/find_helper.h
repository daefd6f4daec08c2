/// Where programs find what belongs to them: helper programs and driver modules.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace palpate {

enum class HelperKind : std::uint8_t { kProgram, kModule };

/// Where the helper `name` is: lib/palpate beside the folder of the running program, where it is installed,
/// or beside the running program, which may be a helper itself. Code of a shared library looks beside the library.
/// PALPATE_HELPERS, if set, names the folder instead (packagers, tests). Empty where it is not.
[[nodiscard]] std::filesystem::path find_helper(std::string_view name,
                                                HelperKind kind = HelperKind::kProgram);

}  // namespace palpate
