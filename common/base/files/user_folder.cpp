#include "common/base/files/user_folder.h"

#include <cstdlib>

namespace palpate {

std::optional<std::filesystem::path> user_folder(const char* variable, const char* below_home) {
  const char* const given = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): read only
  if (given != nullptr && std::filesystem::path(given).is_absolute()) return std::filesystem::path(given);
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): read only
  if (home == nullptr || !std::filesystem::path(home).is_absolute()) return std::nullopt;
  return std::filesystem::path(home) / below_home;
}

}  // namespace palpate
