// Every row of every table, for all kinds of fields: a value by option makes a document; the session of that
// makes the same document again.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/text.h"
#include "common/cli/command_line.h"
#include "common/scene/session_of.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr int kTries = 3;

/// A group that has the row: a verb of that one alone takes no two settings of a name.
Group group_of(const Setting& row) {
  for (int g = 0; g <= static_cast<int>(Group::kStudy); ++g) {
    if (row.groups.has(static_cast<Group>(g))) return static_cast<Group>(g);
  }
  return Group::kCommon;
}

double random_number(const Range& range, std::mt19937& random) {
  constexpr double kSpan = 100.0;
  const double lower = std::isfinite(range.lower) ? range.lower : -kSpan;
  const double upper = std::isfinite(range.upper) ? range.upper : lower + kSpan;
  return std::uniform_real_distribution<double>(lower + 1e-3 * (upper - lower), upper)(random);
}

/// A whole number of type T within `range`. A range without ends reaches 100 above T's least value.
template <typename T>
std::string whole_number(const Range& range, std::mt19937& random) {
  constexpr long long kSpan = 100;
  const long long lower =
      std::isfinite(range.lower) ? static_cast<long long>(std::ceil(range.lower)) + (range.above ? 1 : 0) : 0;
  const long long upper =
      std::isfinite(range.upper) ? static_cast<long long>(std::floor(range.upper)) : lower + kSpan;
  return std::to_string(static_cast<T>(std::uniform_int_distribution<long long>(lower, upper)(random)));
}

/// Text of a value that is not its default. Words, switches and numbers are values that the row allows. A row of free text
/// gets one with what sessions must quote: a row takes any text, its grammar (of a camera, seeds, a lens) is read by
/// who uses it, long after the document, and has tests there.
std::string random_text(const Setting& row, std::mt19937& random) {
  if (!row.words.empty()) {
    std::vector<std::string_view> words = row.word_list();
    std::erase(words, default_text(row));
    return std::string(words[random() % words.size()]);
  }
  return std::visit(
      [&](auto at) -> std::string {
        using T = std::remove_cvref_t<decltype(at(std::declval<Document&>()))>;
        if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::optional<bool>>)
          return default_text(row) == "on" ? "off" : "on";
        if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>)
          return exact_number(random_number(row.range, random));
        if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
          std::string number = default_text(row);
          while (number == default_text(row)) number = whole_number<T>(row.range, random);
          return number;
        }
        std::string text = "-\"w\" \\" + std::to_string(random() % 1000);
        if (row.several()) text += ";x" + std::to_string(random() % 1000);
        return text;
      },
      row.place);
}

/// As the command line has it.
std::vector<std::string> typed(const Setting& row, const std::string& text) {
  switch (row.spelling) {
    case Spelling::kFlag:
      return {row.option()};
    case Spelling::kWords:
      return {"--" + text};
    case Spelling::kPositional:
      return {row.words.empty() ? "a.vtk" : text};
    default:
      break;
  }
  std::vector<std::string> words;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = row.several() ? std::min(text.find(';', start), text.size()) : text.size();
    words.push_back(row.option() + "=" + text.substr(start, end - start));
    start = end + 1;
  }
  return words;
}

class SettingsRoundTrip : public ::testing::TestWithParam<FieldKind> {
 protected:
  ParsedCommand parse(Group group, std::vector<std::string> arguments) const {
    Explorer explorer{.name = "program", .summary = "to test", .kind = GetParam()};
    explorer.verbs.push_back({.name = "act",
                              .summary = "s",
                              // An experiment has no input: its folder stands alone.
                              .groups = group == Group::kStudy ? Groups{group} : Groups{Group::kInput, group},
                              .examples = {},
                              .run = [](const Document&, const VerbContext&) { return ExitCode::kDone; }});
    arguments.insert(arguments.begin(), "act");
    return parse_command_line(explorer, arguments);
  }
  TempFolder folder_;
};

TEST_P(SettingsRoundTrip, GivesEveryRowBack) {
  std::mt19937 random{27};
  std::size_t walked = 0, saved = 0, others = 0;
  for (const Setting& row : settings()) {
    if (!row.kinds.has(GetParam())) {
      ++others;
      continue;
    }
    for (int i = 0; i < kTries; ++i) {
      SCOPED_TRACE("--" + std::string(row.name));
      const Group group = group_of(row);
      const bool input = row.name == "example" || row.name == "file" || row.name == "session";
      const std::string text = random_text(row, random);
      std::vector<std::string> arguments = typed(row, text);
      if (!input && group != Group::kStudy && GetParam() != FieldKind::kNone)
        arguments.insert(arguments.end(), {"--example", "abc"});
      if (row.name == "table") arguments.insert(arguments.begin(), "arm");  // stands behind what it is of
      if (row.name == "dir") arguments.insert(arguments.begin(), "make");   // likewise
      if (row.name == "session") break;                                     // is the way itself
      const Document made = parse(group, arguments).options;
      ASSERT_FALSE(is_default(row, made)) << text;
      if (row.spelling == Spelling::kOption) {
        EXPECT_EQ(value_text(row, made), text);
      }
      if (!row.saved || GetParam() == FieldKind::kNone) continue;  // devices have no sessions

      Session session{.program = "program"};
      session.options = saved_settings(made);
      save_session(folder_.path("s.toml"), session);
      Document back = parse(group, {"--session", folder_.path("s.toml").string()}).options;
      EXPECT_TRUE(same_value(row, made, back)) << text << " comes back as " << value_text(row, back);
      back.common.session.clear();
      EXPECT_TRUE(made == back) << text;
    }
    ++walked;
    saved += row.saved && GetParam() != FieldKind::kNone ? 1 : 0;
  }
  std::cout << "rows covered: " << walked << " of " << settings().size() << ", by sessions " << saved << "; "
            << others << " are of other programs\n";
  EXPECT_EQ(walked + others, settings().size());
}

// So that the walks over all kinds of fields together leave no row out.
TEST(SettingsOfKinds, LeaveNoRowOut) {
  std::size_t covered = 0;
  for (const Setting& row : settings()) {
    const bool walked = std::ranges::any_of(kFieldKinds, [&](FieldKind kind) { return row.kinds.has(kind); });
    EXPECT_TRUE(walked) << row.name << " is of no program";
    covered += walked ? 1 : 0;
  }
  std::cout << "rows covered by all programs together: " << covered << " of " << settings().size() << "\n";
}

INSTANTIATE_TEST_SUITE_P(Kinds, SettingsRoundTrip, ::testing::ValuesIn(kFieldKinds),
                         [](const auto& info) { return std::string(name_of(info.param)); });

// A verb takes no two settings of one name.
TEST(SettingsOfGroups, HaveNamesOfTheirOwn) {
  for (const FieldKind kind : kFieldKinds) {
    for (int g = 0; g <= static_cast<int>(Group::kMenu); ++g) {
      std::set<std::string_view> names;
      for (const Setting& row : settings()) {
        if (!row.belongs(kind, {static_cast<Group>(g)})) continue;
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " twice in group " << g;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
