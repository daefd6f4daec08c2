#include "common/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace palpate::detail {

void check_failed(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "palpate: broken promise: %s (%s:%d)\n", condition, file, line);
  std::abort();
}

}  // namespace palpate::detail
