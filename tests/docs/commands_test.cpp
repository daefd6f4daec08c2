// README.md and the guides: every command that they print runs as printed, page by page in an empty folder, in
// which the sample data lies. Commands that open a window or a device are named as left out.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/docs/command_blocks.h"
#include "tests/support/project_folders.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::string content_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::string> pages() {
  std::vector<std::string> found{"README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "docs/guide")) {
    if (entry.path().extension() == ".md") found.push_back("docs/guide/" + entry.path().filename().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Links every file of the sample data into `folder`, by its own name. False where there is no data.
bool link_data(const TempFolder& folder) {
  const std::filesystem::path one = shared_data("flow/carotid/carotid.vtk");
  if (one.empty()) return false;
  const std::filesystem::path root = one.parent_path().parent_path().parent_path();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    std::error_code ignored;  // the first of two files of one name
    std::filesystem::create_symlink(entry.path(), folder.path(entry.path().filename().string()), ignored);
  }
  return true;
}

/// Why a command is left out, or nothing.
std::string left_out(const PrintedCommand& command, bool has_data) {
  if (command.needs == "window" || command.needs == "device") return "needs a " + command.needs;
  if (command.needs == "data" && !has_data) return "needs the sample data";
  return {};
}

class PrintedCommands : public testing::TestWithParam<std::string> {};

TEST_P(PrintedCommands, RunAsPrinted) {
  const TempFolder folder;
  const bool has_data = link_data(folder);
  const std::filesystem::path bin = build_folder() / "bin";
  const std::filesystem::path log = folder.path("output.log");
  int ran = 0;
  for (const PrintedCommand& command : printed_commands(content_of(source_folder() / GetParam()))) {
    if (const std::string why = left_out(command, has_data); !why.empty()) {
      std::cout << GetParam() << ":" << command.line << " left out, " << why << ": " << command.text << "\n";
      continue;
    }
    // `./run flow` is flow, built.
    std::string text = command.text;
    if (text.rfind("./run ", 0) == 0) text = text.substr(6);
    // One command at a time, with settings and cached files of its own, at most two minutes.
    const std::string line =
        "cd '" + folder.path().string() + "' && PATH='" + bin.string() +
        "':\"$PATH\" HOME=. XDG_CONFIG_HOME=. XDG_CACHE_HOME=. XDG_STATE_HOME=. DISPLAY= timeout 120 sh -c '" +
        text + "' >'" + log.string() + "' 2>&1";
    ASSERT_EQ(text.find('\''), std::string::npos)
        << GetParam() << ":" << command.line << " quotes: use double ones";
    const int status = std::system(line.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << GetParam() << ":" << command.line << ": " << command.text << "\n"
        << content_of(log);
    ++ran;
  }
  if (ran == 0) GTEST_SKIP() << GetParam() << " prints no command that runs here";
}

INSTANTIATE_TEST_SUITE_P(Pages, PrintedCommands, testing::ValuesIn(pages()), [](const auto& page) {
  std::string name = std::filesystem::path(page.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

}  // namespace
}  // namespace palpate::test
