/// Where the sources and the built programs lie.
#pragma once

#include <filesystem>

namespace palpate::test {

/// Root of the checkout.
[[nodiscard]] std::filesystem::path source_folder();

/// Build folder of this preset: programs in bin, helper programs in lib/palpate.
[[nodiscard]] std::filesystem::path build_folder();

}  // namespace palpate::test
