/// What a file is refused with.
#pragma once

#include <filesystem>
#include <initializer_list>
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

/// That `open` refuses bad input in a line that has all the words.
template <typename Open>
void expect_refused(const Open& open, std::initializer_list<std::string> words) {
  const std::string first = words.size() > 0 ? *words.begin() : std::string();
  try {
    (void)open();
    ADD_FAILURE() << first << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    for (const std::string& word : words)
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << ": " << error.what();
  }
}

}  // namespace palpate::test
