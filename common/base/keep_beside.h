/// Where the program may leave what the user has not asked for, such as a session or a cache.
#pragma once

#include <filesystem>

namespace palpate {

/// Whether the folder of `path` can be written and is meant to be: root may write to what nobody should, so
/// that it takes more than access().
[[nodiscard]] bool may_keep_beside(const std::filesystem::path& path);

}  // namespace palpate
