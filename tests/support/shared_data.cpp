#include "tests/support/shared_data.h"

#include <cstdlib>

namespace palpate::test {

std::filesystem::path shared_data(const std::string& relative) {
  const char* chosen = std::getenv("PALPATE_DATA");  // NOLINT(concurrency-mt-unsafe): tests set no variables
  const std::filesystem::path path = std::filesystem::path(chosen ? chosen : PALPATE_SHARED_DATA) / relative;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace palpate::test
