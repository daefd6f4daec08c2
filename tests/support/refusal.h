/// What a file is refused with.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"

namespace palpate::test {

/// The line with which the file is refused as bad input; empty, and a failure of the test, where it opens.
[[nodiscard]] inline std::string refusal(const std::filesystem::path& file) {
  try {
    (void)Source::open({{file}, {}});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    return error.what();
  }
  ADD_FAILURE() << file << " was accepted";
  return {};
}

}  // namespace palpate::test
