// Manual page and completions of a program: every setting stands on them, and bash, zsh and fish can use them.

#include "common/cli/pages/pages.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/cli/pages/option_view.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

ExitCode do_nothing(const Document&, const VerbContext&) { return ExitCode::kDone; }

/// A program with a verb for each group of settings.
Explorer explorer_of_all(FieldKind kind) {
  Explorer explorer{.name = "sample", .summary = "to test", .kind = kind};
  for (int g = 0; g <= static_cast<int>(Group::kStudy); ++g) {
    explorer.verbs.push_back({.name = "verb" + std::string(1, static_cast<char>('a' + g / 26)) +
                                      std::string(1, static_cast<char>('a' + g % 26)),
                              .summary = "s",
                              .groups = {static_cast<Group>(g)},
                              .examples = {},
                              .run = do_nothing});
  }
  return explorer;
}

Explorer small_explorer() {
  Explorer explorer{.name = "flow", .summary = "to test"};
  explorer.examples = {{"flow carotid.vtk --field 'a b'", "a file that isn't there"}};
  explorer.verbs = {
      {.name = "info", .summary = "s", .groups = {Group::kInput}, .examples = {}, .run = do_nothing},
      {.name = "trace",
       .summary = "it's a: [test]",
       .details = "first\n.TH is no request here\n'nor' this",
       .groups = {Group::kInput, Group::kLines, Group::kOut, Group::kTouch},
       .examples = {},
       .run = do_nothing},
      {.name = "study", .summary = "s", .groups = {Group::kStudy}, .examples = {}, .run = do_nothing},
      {.name = "open",
       .summary = "s",
       .groups = {Group::kInput, Group::kLines, Group::kView},
       .examples = {},
       .run = do_nothing}};
  return explorer;
}

/// Whether `word` stands in `text` with neither a letter nor a dash around it.
bool has_word(const std::string& text, const std::string& word) {
  const auto inner = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !inner(text[at - 1])) && (end == text.size() || !inner(text[end]))) return true;
  }
  return false;
}

std::string without(std::string text, const std::string& part, const std::string& instead) {
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += instead.size())
    text.replace(at, part.size(), instead);
  return text;
}

/// What a shell prints.
std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  for (int c = 0; pipe != nullptr && (c = fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  if (pipe == nullptr || pclose(pipe) != 0) text += "(failed)";
  return text;
}

bool installed(const std::string& program) {
  return !output_of("command -v " + program + " || true").empty();
}

class Pages : public testing::TestWithParam<FieldKind> {};

TEST_P(Pages, HaveEverySetting) {
  const Explorer explorer = explorer_of_all(GetParam());
  const std::string manual = without(without(manual_page(explorer), "\\fB", " "), "\\-", "-");
  const std::string bash = bash_completion(explorer), zsh = zsh_completion(explorer),
                    fish = fish_completion(explorer);
  std::size_t walked = 0;
  for (const Verb& verb : explorer.verbs) {
    for (const OptionView& option : options_of(explorer, verb)) {
      for (const std::string& spelling : option.spellings) {
        EXPECT_TRUE(has_word(manual, spelling)) << spelling;
        if (option.operand()) continue;
        EXPECT_TRUE(has_word(bash, spelling)) << spelling;
        EXPECT_TRUE(has_word(zsh, spelling)) << spelling;
        const bool is_long = spelling.starts_with("--");
        EXPECT_TRUE(fish.find((is_long ? " -l " + spelling.substr(2) : " -s " + spelling.substr(1)) + " ") !=
                    std::string::npos)
            << spelling;
        ++walked;
      }
    }
  }
  EXPECT_GT(walked, explorer.verbs.size());
}

INSTANTIATE_TEST_SUITE_P(Kinds, Pages,
                         testing::Values(FieldKind::kVector, FieldKind::kScalar, FieldKind::kTensor,
                                         FieldKind::kFibre, FieldKind::kNone));

TEST(ManualPage, HasNoRequestFromATextInIt) {
  const std::string page = manual_page(small_explorer());
  EXPECT_EQ(page.find("\n.TH is no request"), std::string::npos);
  EXPECT_NE(page.find("\n\\&.TH is no request"), std::string::npos);
  EXPECT_EQ(page.find("\n'nor'"), std::string::npos);
  // What is copied from it keeps its quotes and has the name under which the program is installed.
  EXPECT_NE(page.find("palpate\\-flow carotid.vtk \\-\\-field \\(aqa b\\(aq"), std::string::npos);
}

class Completion : public testing::Test {
 protected:
  Completion() {
    folder_.write("bash", bash_completion(small_explorer()));
    folder_.write("zsh", zsh_completion(small_explorer()));
    folder_.write("fish", fish_completion(small_explorer()));
    folder_.write("a.vtk", "");
    folder_.write("b c.vtk", "");
    folder_.write("down/d.vtk", "");
  }

  /// What bash proposes for the last of `words`, given as bash cuts them, in their order.
  std::vector<std::string> proposed(const std::string& words) const {
    const std::string text =
        output_of("cd '" + folder_.path().string() + "' && bash -c 'source ./bash; COMP_WORDS=(" + words +
                  "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _palpate_flow; "
                  "printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
    std::vector<std::string> lines;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
      if (end > at) lines.push_back(text.substr(at, end - at));
    }
    std::ranges::sort(lines);
    return lines;
  }

  TempFolder folder_;
};

using Words = std::vector<std::string>;

TEST_F(Completion, OfBashProposesVerbsOptionsValuesAndFiles) {
  if (!installed("bash")) GTEST_SKIP() << "there is no bash";
  EXPECT_EQ(proposed("flow tr"), Words{"trace"});
  EXPECT_EQ(proposed("flow \"\""),
            (Words{"a.vtk", "b c.vtk", "bash", "down", "fish", "info", "open", "study", "trace", "zsh"}));
  EXPECT_EQ(proposed("flow --man"), Words{"--manual"});
  EXPECT_EQ(proposed("flow --completion \"\""), (Words{"bash", "fish", "zsh"}));
  EXPECT_EQ(proposed("flow trace --man"), Words{}) << "no verb takes it";
  EXPECT_EQ(proposed("flow trace --dir"), Words{"--direction"});
  EXPECT_EQ(proposed("flow trace --direction \"\""), (Words{"backward", "both", "forward"}));
  EXPECT_EQ(proposed("flow trace --direction = b"), (Words{"backward", "both"}));
  EXPECT_EQ(proposed("flow trace --direction ="), (Words{"backward", "both", "forward"}));
  EXPECT_EQ(proposed("flow --direction f"), Words{"forward"}) << "of the verb that none stands for";
  EXPECT_EQ(proposed("flow trace --mode str"), Words{"streamline"});
  EXPECT_EQ(proposed("flow trace --time la"), Words{"last"}) << "a word beside free text";
  EXPECT_EQ(proposed("flow trace --max-length \"\""), Words{}) << "a number";
  EXPECT_EQ(proposed("flow trace --out a"), Words{"a.vtk"});
  EXPECT_EQ(proposed("flow trace -o a"), Words{"a.vtk"});
  EXPECT_EQ(proposed("flow trace --json a"), Words{"a.vtk"}) << "a flag takes no value";
  EXPECT_EQ(proposed("flow trace --max-length 5 b"), (Words{"b c.vtk", "bash"}));
  EXPECT_EQ(proposed("flow trace --seeds grid : 8,8,8 --dir"), Words{"--direction"});
  EXPECT_EQ(proposed("flow trace --example ab"), Words{"abc"});
  EXPECT_EQ(proposed("flow --json trace --dir"), Words{"--direction"}) << "options before the verb";
  EXPECT_EQ(proposed("flow study s"), (Words{"sheet", "simulate"}));
  EXPECT_EQ(proposed("flow study make d"), Words{"down"}) << "a folder";
}

TEST_F(Completion, OfFishProposesTheSame) {
  if (!installed("fish")) GTEST_SKIP() << "fish is not installed";
  const auto fish = [&](const std::string& line) {
    return output_of("cd '" + folder_.path().string() +
                     "' && HOME=. XDG_CONFIG_HOME=. fish -c \"source ./fish; complete -C '" + line +
                     "'\" | cut -f1 | sort | tr '\\n' ' '");
  };
  EXPECT_EQ(fish("flow tr"), "trace ");
  EXPECT_EQ(fish("palpate-flow trace --direction f"), "forward ");
  EXPECT_EQ(fish("flow trace --dir"), "--direction ");
  EXPECT_EQ(fish("flow trace a"), "a.vtk ");
  EXPECT_EQ(fish("flow study si"), "simulate ");
}

TEST_F(Completion, OfZshIsUnderstood) {
  if (!installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  EXPECT_EQ(output_of("zsh -n '" + folder_.path("zsh").string() + "' 2>&1"), "");
}

TEST(CompletionOption, NamesTheShellsThatItKnows) {
  try {
    (void)completion(small_explorer(), "csh");
    FAIL() << "csh is taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("bash, zsh, fish"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::test
