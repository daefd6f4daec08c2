#include "common/base/files/shared_library.h"

#include <dlfcn.h>

#include "common/base/error.h"

namespace palpate {
namespace {

std::string last_dl_error() {
  const char* const said = ::dlerror();  // NOLINT(concurrency-mt-unsafe): one thread makes links
  return said != nullptr ? said : "it cannot be opened";
}

}  // namespace

SharedLibrary::SharedLibrary(const std::string& asked, std::span<const char* const> names,
                             const std::string& remedy)
    : remedy_(remedy) {
  const auto try_to_open = [this](const std::string& file) {
    library_ = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library_ != nullptr) file_ = file;
    return library_ != nullptr;
  };
  if (!asked.empty()) {
    if (!try_to_open(asked)) throw work_error(last_dl_error() + "; " + remedy);
    return;
  }
  std::string tried;
  for (const char* name : names) {
    if (try_to_open(name)) return;
    (tried += tried.empty() ? "" : ", ") += name;
  }
  throw work_error("none of " + tried + " was found; " + remedy);
}

void* SharedLibrary::find(const char* name) const { return ::dlsym(library_, name); }

void SharedLibrary::refuse(const char* name) const {
  throw work_error(file_ + " has no function " + name + ": it is another library, or of another version; " +
                   remedy_);
}

}  // namespace palpate
