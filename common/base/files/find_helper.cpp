#include "common/base/files/find_helper.h"

#include <cstdlib>
#include <system_error>
#include <vector>

#include <dlfcn.h>
#include <unistd.h>

namespace palpate {
namespace {

/// The folder of the shared library that this code is in; empty where it is in a program.
std::filesystem::path library_folder() {
  Dl_info found{};
  if (::dladdr(reinterpret_cast<const void*>(&find_helper), &found) == 0 || found.dli_fname == nullptr)
    return {};
  // A program is found by the name that it was started with, which says nothing of where it lies.
  const std::filesystem::path object = found.dli_fname;
  if (!object.is_absolute()) return {};
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(object, error);
  return error || file.filename().string().find(".so") == std::string::npos ? std::filesystem::path()
                                                                            : file.parent_path();
}

}  // namespace

std::filesystem::path find_helper(std::string_view name, HelperKind kind) {
  std::vector<std::filesystem::path> folders;
  if (const char* chosen = std::getenv("PALPATE_HELPERS")) {  // NOLINT(concurrency-mt-unsafe): read only
    folders.emplace_back(chosen);
  } else {
    std::error_code error;
    const std::filesystem::path bin = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    // A helper that starts another one lies beside it.
    folders = {bin / "../lib/palpate", bin / "../" PALPATE_INSTALL_LIBDIR "/palpate", bin};
    // In a host such as Python it is the library that they belong to: lib or lib/<triplet>.
    if (const std::filesystem::path lib = library_folder(); !lib.empty())
      folders = {lib / "palpate", lib / "../palpate"};
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
