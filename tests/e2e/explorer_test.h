/// A fixture that runs a built explorer as a user does, in a folder of its own.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/e2e/program.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {

using Json = nlohmann::json;

/// The user's folder for what can be made again; empty: there is none.
inline std::string users_cache() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");  // NOLINT(concurrency-mt-unsafe): one thread
  if (cache != nullptr && *cache != '\0') return cache;
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): one thread
  return home != nullptr && *home != '\0' ? std::string(home) + "/.cache" : std::string();
}

class ExplorerTest : public ::testing::Test {
 protected:
  explicit ExplorerTest(std::string explorer) : explorer_(std::move(explorer)) {
    // What is cached for the next opening is a test's own; shaders that the driver has compiled are everybody's.
    static const std::string everybodys = users_cache();
    if (!everybodys.empty()) ::setenv("MESA_SHADER_CACHE_DIR", everybodys.c_str(), 0);
    ::setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1);
  }

  ProgramResult run(const std::vector<std::string>& arguments) {
    std::vector<std::string> command{bin(explorer_).string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    // Without a display: what opens a window in front of a user must not do so in front of a test.
    return Program(command, folder_.path(), {"DISPLAY=", "WAYLAND_DISPLAY="}).finish();
  }

  /// The one JSON object on stdout; anything else there fails to parse.
  Json json(std::vector<std::string> arguments, int exit_code = 0) {
    arguments.emplace_back("--json");
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    Json object = Json::parse(result.out, nullptr, false);
    EXPECT_TRUE(object.is_object()) << result.out;
    return object;
  }

  /// Names of what lies in the folder, sorted.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Whether something with this ending is kept for the next opening.
  bool is_kept(const std::string& ending) const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(cache_.path()))
      if (entry.path().extension() == ending) return true;
    return false;
  }

  TempFolder folder_, cache_;

 private:
  std::string explorer_;
};

}  // namespace palpate::test
