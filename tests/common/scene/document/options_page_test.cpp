// docs/reference/options.md is what the tables of settings give. To write it again after a change of them:
//   PALPATE_WRITE_PAGES=1 ctest --preset release -R document/options_page_test

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/scene/document/setting.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr std::array<std::pair<FieldKind, const char*>, 5> kPrograms{{{FieldKind::kVector, "flow"},
                                                                      {FieldKind::kFibre, "cardiac"},
                                                                      {FieldKind::kTensor, "dtmri"},
                                                                      {FieldKind::kScalar, "grid"},
                                                                      {FieldKind::kNone, "workbench"}}};

/// In a cell of a table.
std::string cell(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string programs_of(const Setting& row) {
  if (row.kinds == kAllPrograms) return "all";
  if (row.kinds == kAllFields) return "all but workbench";
  std::string text;
  for (const auto& [kind, program] : kPrograms) {
    if (row.kinds.has(kind)) text += (text.empty() ? "" : ", ") + std::string(program);
  }
  return text;
}

std::string option_of(const Setting& row) {
  if (row.spelling == Spelling::kPositional) return "`" + std::string(row.value) + "`";
  if (row.spelling == Spelling::kWords) {
    std::string text;
    for (const std::string_view word : row.word_list()) {
      if (word != default_text(row)) text += (text.empty() ? "`--" : ", `--") + std::string(word) + "`";
    }
    return text;
  }
  std::string text = "`" + row.option() + "`";
  if (!row.alias.empty()) text += ", `" + std::string(row.alias) + "`";
  return text;
}

std::string page() {
  std::string text =
      "# Settings\n\n"
      "Every setting is an option of the command line, `--name VALUE`, and where sessions keep it a key of "
      "their table `[scene]`, `name = \"VALUE\"`. `PROGRAM VERB --help` lists those that a verb takes. This "
      "page is made from the tables that the programs read (`common/scene/document`).\n";
  std::vector<std::string_view> headings;
  for (const Setting& row : settings()) {
    if (std::ranges::find(headings, row.heading) == headings.end()) headings.push_back(row.heading);
  }
  for (const std::string_view heading : headings) {
    text += "\n## " + std::string(heading) +
            "\n\n| option | value | default | range | programs | session | meaning |\n"
            "|---|---|---|---|---|---|---|\n";
    for (const Setting& row : settings()) {
      if (row.heading != heading) continue;
      std::string range = row.range.text();
      if (!row.unit.empty()) range += (range.empty() ? "" : ", ") + std::string(row.unit);
      const std::string usual = row.otherwise.empty() ? default_text(row) : std::string(row.otherwise);
      text += "| " + option_of(row) + " | " + cell(row.value_name()) + " | " + cell(usual) + " | " + range +
              " | " + programs_of(row) + " | " + (row.saved ? "saved" : "") + " | " + cell(row.help) + " |\n";
    }
  }
  return text;
}

TEST(OptionsPage, IsWhatTheTablesGive) {
  const auto file = source_folder() / "docs" / "reference" / "options.md";
  if (std::getenv("PALPATE_WRITE_PAGES") != nullptr) std::ofstream(file) << page();
  EXPECT_EQ(read_file(file), page()) << "write it again: PALPATE_WRITE_PAGES=1 ctest -R options_page_test";
}

}  // namespace
}  // namespace palpate::test
