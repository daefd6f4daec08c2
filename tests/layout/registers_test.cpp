// What registers itself by lying in a folder is there: nothing else would notice that it is missing.

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Registers, EveryConstraintIsUnderTheContract) {
  std::string subjects;
  for (const auto& entry : fs::directory_iterator(source_folder() / "tests/common/haptics/contract"))
    if (entry.path().filename().string().ends_with("_subjects.cpp")) subjects += text_of(entry.path());
  const std::regex constraint(R"(class (\w+) final : public (Shape)?Constraint\b)");
  int found = 0;
  for (const auto& entry : fs::directory_iterator(source_folder() / "common/haptics/constraint")) {
    const std::string text = text_of(entry.path());
    for (auto it = std::sregex_iterator(text.begin(), text.end(), constraint); it != std::sregex_iterator();
         ++it) {
      ++found;
      const std::string name = (*it)[1];
      EXPECT_TRUE(std::regex_search(subjects, std::regex("\\b" + name + "\\b")))
          << name << " (" << entry.path().filename() << ") has no subject; see constraint_contract.h";
    }
  }
  EXPECT_GT(found, 10) << "the pattern finds no class any more";
}

// `common/load/format.h` in a page must be there; names of things to be added have NAME, xyz or the like in them.
TEST(PagesForDevelopers, NameOnlyFilesThatAreThere) {
  const std::regex path(R"(`((?:common|apps|lab|loaders|shaders|tests|docs|scripts|cmake)/[\w./-]+)`)");
  const std::regex made_up(R"(NAME|xyz|wall_mode)");
  int found = 0;
  for (const auto& entry : fs::directory_iterator(source_folder() / "docs/developing")) {
    const std::string text = text_of(entry.path());
    for (auto it = std::sregex_iterator(text.begin(), text.end(), path); it != std::sregex_iterator(); ++it) {
      const std::string name = (*it)[1];
      if (std::regex_search(name, made_up)) continue;
      ++found;
      EXPECT_TRUE(fs::exists(source_folder() / name)) << entry.path().filename() << " names " << name;
    }
  }
  EXPECT_GT(found, 30) << "the pattern finds no path any more";
}

bool snake_case(const std::string& name) {
  static const std::regex form("[a-z0-9_]+([.][a-z0-9_]+)*");
  return std::regex_match(name, form);
}

TEST(Names, OfFilesAndFoldersAreSnakeCase) {
  EXPECT_FALSE(snake_case("CellLocator.h")) << "the search itself";
  EXPECT_FALSE(snake_case("cell-locator.h"));
  EXPECT_TRUE(snake_case("cell_locator.h"));
  int found = 0;
  for (const char* top :
       {"apps", "cmake", "common", "docs", "lab", "library", "loaders", "scripts", "shaders", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(source_folder() / top)) {
      const std::string name = entry.path().filename().string();
      if (name == "README.md" || name == "CMakeLists.txt") continue;
      if (entry.path().extension() == ".pyc") continue;  // Python's own, beside a module that was tried
      ++found;
      EXPECT_TRUE(snake_case(name)) << fs::relative(entry.path(), source_folder());
    }
  }
  EXPECT_GT(found, 500) << "the tree was not found";
}

}  // namespace
}  // namespace palpate::test
