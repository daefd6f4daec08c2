/// Real sample data that lies beside the checkout, where it exists.
#pragma once

#include <filesystem>
#include <string>

namespace palpate::test {

/// Path of a sample file ("flow/carotid/carotid.vtk"), or empty where there is none. PALPATE_DATA, if set,
/// names the folder to look in. Use with PALPATE_NEED_DATA, which skips visibly.
[[nodiscard]] std::filesystem::path shared_data(const std::string& relative);

}  // namespace palpate::test

/// Defines the path `variable`, or skips the test saying what was missing.
#define PALPATE_NEED_DATA(variable, relative)                                    \
  const std::filesystem::path variable = ::palpate::test::shared_data(relative); \
  if (variable.empty()) GTEST_SKIP() << "sample data missing: " << (relative)
