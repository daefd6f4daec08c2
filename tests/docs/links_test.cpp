// Links of the pages: what they name is there, and the heading that they point into.

#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

/// A page without what stands in fences and between backticks.
std::string prose_of(const std::string& page) {
  std::istringstream lines(page);
  std::string line, prose;
  bool fenced = false;
  while (std::getline(lines, line)) {
    if (line.find("```") != std::string::npos) {
      fenced = !fenced;
    } else if (!fenced) {
      static const std::regex kCode("`[^`]*`");
      prose += std::regex_replace(line, kCode, "") + "\n";
    }
  }
  return prose;
}

/// The names under which links find the headings of a page: small letters, dashes for blanks, no other signs.
std::set<std::string> headings_of(const std::string& page) {
  std::istringstream lines(page);
  std::string line;
  std::set<std::string> names;
  bool fenced = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("```")) fenced = !fenced;
    const std::size_t text = line.find_first_not_of('#');
    if (fenced || text == 0 || text == std::string::npos || line[text] != ' ') continue;
    std::string name;
    for (const char c : line.substr(text + 1)) {
      const auto sign = static_cast<unsigned char>(c);
      if (std::isalnum(sign) != 0 || c == '-' || c == '_') name += static_cast<char>(std::tolower(sign));
      if (c == ' ') name += '-';
    }
    names.insert(name);
  }
  return names;
}

/// "page:link" of all links of `page` that lead nowhere, outside the project left aside.
std::vector<std::string> dead_links(const fs::path& page) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> dead;
  const std::string prose = prose_of(read_file(page));
  for (auto it = std::sregex_iterator(prose.begin(), prose.end(), kLink); it != std::sregex_iterator();
       ++it) {
    const std::string link = (*it)[1];
    if (link.find("://") != std::string::npos || link.starts_with("mailto:")) continue;
    const std::size_t mark = link.find('#');
    const std::string file = link.substr(0, mark);
    const fs::path target = file.empty() ? page : page.parent_path() / file;
    bool there = fs::exists(target);
    if (there && mark != std::string::npos)
      there = headings_of(read_file(target)).contains(link.substr(mark + 1));
    if (!there) dead.push_back(page.filename().string() + ": " + link);
  }
  return dead;
}

TEST(Links, OfThePagesLeadSomewhere) {
  std::vector<fs::path> pages;
  for (const char* name : {"README.md", "CHANGELOG.md", "CONTRIBUTING.md"})
    pages.push_back(source_folder() / name);
  for (const char* folder : {"docs", "common", "loaders", "lab", "apps", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(source_folder() / folder)) {
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
    }
  }
  EXPECT_GT(pages.size(), 20U);
  for (const fs::path& page : pages) EXPECT_EQ(dead_links(page), std::vector<std::string>{}) << page;
}

TEST(Links, ThatAreDeadAreFound) {
  const TempFolder folder;
  folder.write("other.md", "# A page, of `two` words\n## More\n");
  const fs::path page = folder.write(
      "page.md",
      "# Top\n[a](other.md) [b](other.md#a-page-of-two-words) [c](#top) [d](https://nowhere.invalid/x)\n"
      "```\n[e](none.md)\n```\n`[f](none.md)` [g](none.md) ![h](none.png)\n[i](other.md#less) [j](#bottom)\n");
  EXPECT_EQ(dead_links(page), (std::vector<std::string>{"page.md: none.md", "page.md: none.png",
                                                        "page.md: other.md#less", "page.md: #bottom"}));
}

}  // namespace
}  // namespace palpate::test
