// What --help lists stands in the manual page and in the completions of each program; the front command starts it.

#include <algorithm>
#include <cctype>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

std::string replaced(std::string text, const std::string& part, const std::string& instead) {
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += instead.size())
    text.replace(at, part.size(), instead);
  return text;
}

bool has_word(const std::string& text, const std::string& word) {
  const auto inner = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !inner(text[at - 1])) && (end == text.size() || !inner(text[end]))) return true;
  }
  return false;
}

/// The first words of the lines of a help under "Verbs:".
std::vector<std::string> verbs_of(const std::string& help) {
  std::vector<std::string> verbs;
  std::istringstream lines(help.substr(help.find("\nVerbs:") + 1));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    if (line[2] != ' ') verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return verbs;
}

/// "-o" and "--out" of the lines "  -o,--out FILE …".
std::vector<std::string> options_of(const std::string& help) {
  static const std::regex kOption(R"(\n  (-\w)?,?(--[\w-]+)?)");
  std::vector<std::string> options;
  for (auto it = std::sregex_iterator(help.begin(), help.end(), kOption); it != std::sregex_iterator();
       ++it) {
    for (const int part : {1, 2}) {
      if ((*it)[part].matched) options.push_back((*it)[part]);
    }
  }
  return options;
}

class ProgramPages : public testing::TestWithParam<std::string> {
 protected:
  ProgramResult run(std::vector<std::string> arguments, const std::string& program = GetParam()) {
    arguments.insert(arguments.begin(), bin(program).string());
    return Program(arguments, folder_.path(), {"DISPLAY=", "WAYLAND_DISPLAY="}).finish();
  }
  std::string out(const std::vector<std::string>& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }
  TempFolder folder_;
};

TEST_P(ProgramPages, HaveAllThatTheHelpLists) {
  const std::string manual = replaced(replaced(out({"--manual"}), "\\fB", " "), "\\-", "-");
  const std::string bash = out({"--completion", "bash"}), zsh = out({"--completion=zsh"}),
                    fish = out({"--completion", "fish"});
  const std::string help = out({"--help"});
  const std::vector<std::string> verbs = verbs_of(help);
  ASSERT_GT(verbs.size(), 5U) << help;
  std::string all = help;
  for (const std::string& verb : verbs) {
    for (const std::string* page : {&manual, &bash, &zsh, &fish}) EXPECT_TRUE(has_word(*page, verb)) << verb;
    all += out({verb, "--help"});
  }
  const std::vector<std::string> options = options_of(all);
  ASSERT_GT(options.size(), 50U);
  for (const std::string& option : options) {
    EXPECT_TRUE(has_word(manual, option)) << option;
    EXPECT_TRUE(has_word(bash, option) || option == "-h") << option;
    EXPECT_TRUE(has_word(zsh, option) || option == "-h") << option;
    const bool is_long = option.starts_with("--");
    EXPECT_NE(fish.find((is_long ? " -l " + option.substr(2) : " -s " + option.substr(1)) + " "),
              std::string::npos)
        << option;
  }
}

TEST_P(ProgramPages, AreReadByManWithoutAWarning) {
  folder_.write("page.1", out({"--manual"}));
  const ProgramResult result =
      Program({"/bin/sh", "-c",
               "command -v groff >/dev/null || exit 77; groff -man -Tutf8 -Kutf8 -ww "
               "page.1 >/dev/null"},
              folder_.path())
          .finish();
  if (result.exit_code == 77) GTEST_SKIP() << "groff is not installed";
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
}

TEST_P(ProgramPages, AreAskedForWithoutAVerb) {
  EXPECT_EQ(run({"--completion", "csh"}).exit_code, 2);
  EXPECT_EQ(run({"--completion"}).exit_code, 2);
}

TEST_P(ProgramPages, FrontCommandStartsTheProgram) {
  const ProgramResult direct = run({"--version"}), front = run({GetParam(), "--version"}, "palpate");
  EXPECT_EQ(front.exit_code, 0);
  EXPECT_EQ(front.out, direct.out);
  const ProgramResult failed = run({GetParam(), "info", "nothing.here", "--quiet"}, "palpate");
  EXPECT_EQ(failed.exit_code, run({"info", "nothing.here", "--quiet"}).exit_code)
      << "its exit code is passed on";
}

INSTANTIATE_TEST_SUITE_P(All, ProgramPages, testing::Values("cardiac", "dtmri", "flow", "grid", "workbench"),
                         [](const auto& program) { return program.param; });

class FrontCommand : public ExplorerTest {
 protected:
  FrontCommand() : ExplorerTest("palpate") {}
};

TEST_F(FrontCommand, ListsItsPrograms) {
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* program : {"cardiac", "dtmri", "flow", "grid", "workbench"})
    EXPECT_NE(help.out.find("\n  " + std::string(program) + " "), std::string::npos) << program;
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(run({}).out, "");
  const ProgramResult unknown = run({"flwo"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("programs are cardiac, dtmri, flow, grid, workbench"), std::string::npos);
  EXPECT_NE(run({"--version"}).out.find("palpate (Palpate) "), std::string::npos);
}

TEST_F(FrontCommand, FindsInstalledProgramsBesideItAndThroughLinks) {
  namespace fs = std::filesystem;
  const fs::path installed = folder_.path("opt with blank/bin"), links = folder_.path("usr");
  fs::create_directories(installed);
  fs::create_directories(links);
  fs::copy_file(bin("palpate"), installed / "palpate");
  folder_.write("opt with blank/bin/palpate-flow", "#!/bin/sh\nprintf '<%s>' \"$@\"\nexit 7\n");
  fs::permissions(installed / "palpate-flow", fs::perms::owner_all);
  fs::create_symlink(installed / "palpate", links / "palpate");
  const ProgramResult result =
      Program({(links / "palpate").string(), "flow", "a b", "", "--x=*"}, folder_.path()).finish();
  EXPECT_EQ(result.out, "<a b><><--x=*>") << result.err;
  EXPECT_EQ(result.exit_code, 7);
  folder_.write("a b.palpate.toml", "format = 1\nprogram = 'flow'\n");
  const ProgramResult session =
      Program({(links / "palpate").string(), "a b.palpate.toml", "--json"}, folder_.path()).finish();
  EXPECT_EQ(session.out, "<open><--session><a b.palpate.toml><--json>") << session.err;
  folder_.write("other.palpate.toml", "program = 'rm'\n");
  for (const char* name : {"other.palpate.toml", "none.palpate.toml"}) {
    const ProgramResult refused = Program({(links / "palpate").string(), name}, folder_.path()).finish();
    EXPECT_EQ(refused.exit_code, 3) << name;
    EXPECT_NE(refused.err.find(name), std::string::npos);
  }
  const ProgramResult missing = Program({(links / "palpate").string(), "grid"}, folder_.path()).finish();
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("install the package palpate-grid"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace palpate::test
