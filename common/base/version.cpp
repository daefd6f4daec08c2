#include "common/base/version.h"

namespace palpate {

std::string version() { return PALPATE_VERSION; }

std::string version_text(const std::string& program) { return program + " (Palpate) " + version(); }

std::string build_text() {
#if defined(__clang__)
  const std::string compiler = "Clang " __clang_version__;
#elif defined(__GNUC__)
  const std::string compiler = "GCC " __VERSION__;
#else
  const std::string compiler = "unknown compiler";
#endif
  return compiler + ", " PALPATE_BUILD_TYPE;
}

}  // namespace palpate
