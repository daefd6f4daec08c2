#include "common/base/find_helper.h"

#include <cstdlib>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace palpate {

std::filesystem::path find_helper(std::string_view name, HelperKind kind) {
  std::vector<std::filesystem::path> folders;
  if (const char* chosen = std::getenv("PALPATE_HELPERS")) {  // NOLINT(concurrency-mt-unsafe): read only
    folders.emplace_back(chosen);
  } else {
    std::error_code error;
    const std::filesystem::path bin = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    // A helper that starts another one lies beside it.
    folders = {bin / "../lib/palpate", bin / "../" PALPATE_INSTALL_LIBDIR "/palpate", bin};
  }
  for (const auto& folder : folders) {
    std::filesystem::path path = folder / name;
    // Modules are installed without the right to be run.
    if (::access(path.c_str(), kind == HelperKind::kModule ? R_OK : X_OK) == 0)
      return path.lexically_normal();
  }
  return {};
}

}  // namespace palpate
