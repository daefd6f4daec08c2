// What registers itself by lying in a folder is there: nothing else would notice that it is missing.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

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

/// Words of the source with their lines: identifiers, and those of texts. Comments are left out.
struct SourceWords {
  struct Word {
    std::string text;
    int line = 1;
  };
  std::vector<Word> identifiers, texts;
};

SourceWords words_of(const std::string& source) {
  SourceWords words;
  int line = 1;
  for (std::size_t i = 0; i < source.size();) {
    const auto is_word = [&](std::size_t at) {
      return at < source.size() &&
             (std::isalnum(static_cast<unsigned char>(source[at])) || source[at] == '_');
    };
    std::size_t end = i + 1;
    if (is_word(i)) {
      while (is_word(end)) ++end;
      if (end < source.size() && source[end] == '"' && source[end - 1] == 'R') {
        const std::size_t open = source.find('(', end);
        const std::string close = ")" + source.substr(end + 1, open - end - 1) + "\"";
        end = source.find(close, open) + close.size();
      } else {
        words.identifiers.push_back({source.substr(i, end - i), line});
      }
      if (end < source.size() && source[end] == '\'') ++end;  // 1'000
    } else if (source.compare(i, 2, "//") == 0) {
      end = std::min(source.find('\n', i), source.size());
    } else if (source.compare(i, 2, "/*") == 0) {
      end = source.find("*/", i) + 2;
    } else if (source[i] == '"' || source[i] == '\'') {
      while (end < source.size() && source[end] != source[i]) end += source[end] == '\\' ? 2 : 1;
      if (source[i] == '"') words.texts.push_back({source.substr(i + 1, end - i - 1), line});
      ++end;
    }
    line += static_cast<int>(
        std::count(source.begin() + static_cast<std::ptrdiff_t>(i),
                   source.begin() + static_cast<std::ptrdiff_t>(std::min(end, source.size())), '\n'));
    i = end;
  }
  return words;
}

/// Of the words that gave way to those of the field: haptic, reported, appearance, detent, workbench, text or spec.
bool given_up(const std::string& identifier) {
  static const std::set<std::string> whole{"looks", "raw_words", "InputWords", "ChainWords", "StudyLook"};
  static const std::set<std::string> parts{"felt", "told", "teeth", "bench"};
  if (whole.contains(identifier)) return true;
  std::string part;
  for (const char c : identifier + "_") {
    const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0;
    if (c == '_' || upper) {
      if (parts.contains(part)) return true;
      part.clear();
    }
    if (c != '_') part += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return false;
}

/// The old word that a text of the tables of settings has; empty: none.
std::string given_up_in_help(const std::string& text) {
  static const std::regex form(R"(\b(?:kept|felt|told|beside|teeth|bench|LOOK|lets go|about it)\b)");
  std::smatch found;
  return std::regex_search(text, found, form) ? found.str() : "";
}

TEST(Words, GivenUpAreInNoIdentifierAndNoHelp) {
  EXPECT_TRUE(given_up("kFelt"));
  EXPECT_TRUE(given_up("told_apart"));
  EXPECT_FALSE(given_up("looked_"));
  EXPECT_EQ(given_up_in_help("tick marks felt along the line"), "felt");
  const SourceWords known = words_of("f(R\"(\"felt)\", \"a \\\"b\") + 1'000;\n// told\n/* told */ last");
  ASSERT_EQ(known.texts.size(), 1U);
  EXPECT_EQ(known.texts[0].text, "a \\\"b");
  EXPECT_EQ(known.identifiers.back().text, "last");
  EXPECT_EQ(known.identifiers.back().line, 3);
  std::size_t identifiers = 0, helps = 0;
  for (const char* top : {"apps", "common", "lab", "library", "loaders"}) {
    for (const auto& entry : fs::recursive_directory_iterator(source_folder() / top)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".h" && ending != ".cpp") continue;
      const fs::path file = fs::relative(entry.path(), source_folder());
      const SourceWords words = words_of(text_of(entry.path()));
      identifiers += words.identifiers.size();
      for (const SourceWords::Word& word : words.identifiers)
        EXPECT_FALSE(given_up(word.text)) << file << ":" << word.line << ": " << word.text;
      if (!file.string().starts_with("common/scene/document/settings_")) continue;
      helps += words.texts.size();
      for (const SourceWords::Word& text : words.texts)
        EXPECT_EQ(given_up_in_help(text.text), "") << file << ":" << text.line << ": " << text.text;
    }
  }
  EXPECT_GT(identifiers, 500000U) << "the tree was not found";
  EXPECT_GT(helps, 300U) << "the tables of settings were not found";
}

// scripts/guards_out.py takes hours: it is to find each guard where the table says.
TEST(Registers, EveryGuardStandsOnceInItsFile) {
  std::ifstream table(source_folder() / "lab/extremes/guards.tsv");
  int found = 0;
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    std::string name, file, expression;
    std::getline(fields, name, '\t');
    std::getline(fields, file, '\t');
    std::getline(fields, expression, '\t');
    for (std::size_t at = 0; (at = expression.find("\\n", at)) != std::string::npos;)
      expression.replace(at, 2, "\n");
    const std::string text = text_of(source_folder() / file);
    const std::size_t first = text.find(expression);
    EXPECT_NE(first, std::string::npos) << name << ": '" << expression << "' is not in " << file;
    EXPECT_EQ(text.find(expression, first + 1), std::string::npos) << name << ": twice in " << file;
    ++found;
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace palpate::test
