#include "tests/e2e/explorer_test.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

namespace palpate::test {
namespace {

/// The user's folder for what can be made again; empty: there is none.
std::string users_cache() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");  // NOLINT(concurrency-mt-unsafe): one thread
  if (cache != nullptr && *cache != '\0') return cache;
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): one thread
  return home != nullptr && *home != '\0' ? std::string(home) + "/.cache" : std::string();
}

}  // namespace

ExplorerTest::ExplorerTest(std::string explorer) : explorer_(std::move(explorer)) {
  // What is cached for the next opening is a test's own; shaders that the driver has compiled are everybody's.
  static const std::string everybodys = users_cache();
  if (!everybodys.empty()) ::setenv("MESA_SHADER_CACHE_DIR", everybodys.c_str(), 0);
  ::setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1);
}

ProgramResult ExplorerTest::run(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{bin(explorer_).string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  // Without a display: what opens a window in front of a user must not do so in front of a test.
  return Program(command, folder_.path(), {"DISPLAY=", "WAYLAND_DISPLAY="}).finish();
}

Json ExplorerTest::json(std::vector<std::string> arguments, int exit_code) {
  arguments.emplace_back("--json");
  const ProgramResult result = run(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  Json object = parse_json(result.out);
  EXPECT_TRUE(object.is_object()) << result.out;
  return object;
}

std::vector<std::string> ExplorerTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

bool ExplorerTest::is_kept(const std::string& ending) const {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(cache_.path()))
    if (entry.path().extension() == ending) return true;
  return false;
}

}  // namespace palpate::test
