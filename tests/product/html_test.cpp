// The pages as HTML: every link leads to a page or picture that is there, and into a heading that it has.

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/e2e/program.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

std::multiset<std::string> found_in(const std::string& text, const std::regex& pattern) {
  std::multiset<std::string> all;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), pattern); it != std::sregex_iterator(); ++it)
    all.insert((*it)[1]);
  return all;
}

TEST(HtmlPages, HaveNoDeadLink) {
  if (Program({"/bin/sh", "-c", "command -v cmark-gfm"}).finish().exit_code != 0)
    GTEST_SKIP() << "cmark-gfm is not installed";
  const TempFolder folder;
  const ProgramResult made =
      Program({"/bin/sh", (source_folder() / "scripts/docs_html.sh").string(), folder.path("html").string()})
          .finish();
  ASSERT_EQ(made.exit_code, 0) << made.err;
  std::map<fs::path, std::string> pages;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path("html"))) {
    if (entry.path().extension() == ".html") pages[entry.path().lexically_normal()] = read_file(entry.path());
  }
  EXPECT_GT(pages.size(), 20U);
  static const std::regex kLink("(?:href|src)=\"([^\"]*)\""), kName("id=\"([^\"]*)\"");
  for (const auto& [page, text] : pages) {
    for (const std::string& name : found_in(text, kName))
      EXPECT_EQ(found_in(text, kName).count(name), 1U) << page << " has two headings #" << name;
    for (const std::string& link : found_in(text, kLink)) {
      if (link.find("://") != std::string::npos) continue;
      const std::size_t mark = link.find('#');
      const fs::path target =
          mark == 0 ? page : (page.parent_path() / link.substr(0, mark)).lexically_normal();
      EXPECT_TRUE(fs::is_regular_file(target)) << page << " links to " << link;
      if (mark == std::string::npos) continue;
      EXPECT_TRUE(pages.contains(target) && found_in(pages.at(target), kName).contains(link.substr(mark + 1)))
          << page << " links to " << link;
    }
  }
}

}  // namespace
}  // namespace palpate::test
