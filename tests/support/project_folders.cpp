#include "tests/support/project_folders.h"

namespace palpate::test {

std::filesystem::path source_folder() { return PALPATE_SOURCE_DIR; }

std::filesystem::path build_folder() { return PALPATE_BUILD_DIR; }

}  // namespace palpate::test
