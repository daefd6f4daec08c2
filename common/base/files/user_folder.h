/// Folders of the user who runs the program, as the XDG Base Directory Specification 0.8 has them.
#pragma once

#include <filesystem>
#include <optional>

namespace palpate {

/// The folder that an XDG variable names, which has to be absolute to count, else `below_home` in the user's home;
/// nothing where there is none.
[[nodiscard]] std::optional<std::filesystem::path> user_folder(const char* variable, const char* below_home);

}  // namespace palpate
