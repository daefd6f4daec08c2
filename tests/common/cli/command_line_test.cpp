#include "common/cli/command_line.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

Explorer sample_explorer() {
  Explorer explorer{.name = "flow", .summary = "to test"};
  const auto nothing = [](const Document&, const VerbContext&) { return ExitCode::kDone; };
  explorer.verbs.push_back(
      {.name = "info", .summary = "s", .groups = {Group::kInput}, .examples = {}, .run = nothing});
  explorer.verbs.push_back({.name = "trace",
                            .summary = "s",
                            .groups = {Group::kInput, Group::kLines, Group::kOut},
                            .examples = {},
                            .run = nothing});
  explorer.verbs.push_back({.name = "open",
                            .summary = "s",
                            .groups = {Group::kInput, Group::kLines, Group::kView},
                            .examples = {},
                            .run = nothing});
  return explorer;
}

const Explorer& explorer() {
  static const Explorer kExplorer = sample_explorer();
  return kExplorer;
}

ParsedCommand parse(const std::vector<std::string>& arguments) {
  return parse_command_line(explorer(), arguments);
}

std::string refusal(const std::vector<std::string>& arguments) {
  try {
    (void)parse(arguments);
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.code())) + " " + error.what();
  }
  return "accepted";
}

TEST(CommandLine, OpensAFileWhereNoVerbIsNamed) {
  const ParsedCommand parsed = parse({"a.vtk", "b.vtk"});
  EXPECT_EQ(parsed.verb->name, "open");
  EXPECT_EQ(parsed.options.input.files, (std::vector<std::filesystem::path>{"a.vtk", "b.vtk"}));
  EXPECT_EQ(parse({}).verb->name, "open");
  EXPECT_EQ(parse({"--example", "abc"}).verb->name, "open");
}

TEST(CommandLine, TakesOptionsBeforeTheVerb) {
  const ParsedCommand parsed = parse({"--json", "--threads", "3", "--field", "info", "trace", "a.vtk"});
  EXPECT_EQ(parsed.verb->name, "trace");
  EXPECT_TRUE(parsed.options.common.json);
  EXPECT_EQ(parsed.options.common.threads, 3);
  EXPECT_EQ(parsed.options.input.field, "info");  // the value of an option is no verb
  const ParsedCommand open = parse({"--example", "abc", "--color", "time", "--integrator", "rk4"});
  EXPECT_EQ(open.verb->name, "open");
  EXPECT_EQ(open.options.view.color, "time");
  EXPECT_EQ(parse({"--direction", "both", "trace", "a.vtk"}).verb->name, "trace");
}

TEST(CommandLine, ReadsValuesThatBeginWithAMinus) {
  const ParsedCommand parsed = parse(
      {"open", "a.vtk", "--camera", "-30,-20,0,1", "--stop-plane", "-1,0,0,5", "--stop-plane", "0,0,1,2"});
  EXPECT_EQ(parsed.options.view.camera, "-30,-20,0,1");
  EXPECT_EQ(parsed.options.tracing.stop_planes, (std::vector<std::string>{"-1,0,0,5", "0,0,1,2"}));
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(refusal({"info", "--nonsense"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--tolerance", "-1"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--tolerance", "0"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--tolerance", "nan"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--max-length", "inf"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--max-steps", "0"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--threads", "-1"}).front(), '2');
  EXPECT_EQ(refusal({"trace", "a.vtk", "--direction", "up"}).front(), '2');
  EXPECT_EQ(refusal({"info", "a.vtk", "--seeds", "grid:1,1,1"}).front(), '2');  // info makes no lines
  EXPECT_NE(refusal({"info", "--nonsense"}).find("flow info --help"), std::string::npos);
}

TEST(CommandLine, AnswersHelpAndVersionWithoutAVerb) {
  EXPECT_EQ(parse({"--help"}).verb, nullptr);
  EXPECT_NE(parse({"--version"}).text.find("flow"), std::string::npos);
  EXPECT_NE(parse({"trace", "--help"}).text.find("--seeds"), std::string::npos);
  EXPECT_EQ(parse({"info", "--help"}).text.find("--seeds"), std::string::npos);
}

/// A program without files, whose verbs take words in an order. It outlives what is parsed for it: a parsed command
/// points at its verb.
const Explorer& devices() {
  static const Explorer explorer = [] {
    Explorer made{.name = "devices", .summary = "to test", .kind = FieldKind::kNone};
    const auto nothing = [](const Document&, const VerbContext&) { return ExitCode::kDone; };
    made.verbs.push_back({.name = "fit",
                          .summary = "s",
                          .details = "What a table holds.",
                          .groups = {Group::kCalibrate},
                          .examples = {{"devices fit arm a.csv", "e"}},
                          .run = nothing});
    made.verbs.push_back(
        {.name = "report", .summary = "s", .groups = {Group::kReport}, .examples = {}, .run = nothing});
    made.default_verb = "report";
    return made;
  }();
  return explorer;
}

ParsedCommand parse_for_devices(const std::vector<std::string>& arguments) {
  return parse_command_line(devices(), arguments);
}

std::string refusal_for_devices(const std::vector<std::string>& arguments) {
  try {
    (void)parse_for_devices(arguments);
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.code())) + " " + error.what();
  }
  return "accepted";
}

TEST(CommandLine, TakesWordsInTheirOrder) {
  const ParsedCommand parsed = parse_for_devices({"fit", "arm", "--loss", "huber", "a.csv", "--json"});
  EXPECT_EQ(parsed.options.calibration.kind, "arm");
  EXPECT_EQ(parsed.options.calibration.table, "a.csv");
  EXPECT_EQ(parsed.options.calibration.loss, "huber");
  EXPECT_EQ(parsed.options.input.kind, FieldKind::kNone);
  EXPECT_EQ(parse_for_devices({"fit", "arm"}).options.calibration.table, "");
  EXPECT_EQ(parse_for_devices({}).verb->name, "report");
  const std::string wrong = refusal_for_devices({"fit", "nose", "a.csv"});
  EXPECT_TRUE(wrong.starts_with("2 KIND nose: tracker, ")) << wrong;
  EXPECT_EQ(refusal_for_devices({"fit", "arm", "a.csv", "b.csv"}).front(), '2');
  EXPECT_EQ(refusal_for_devices({"nose"}).front(), '2') << "no file was meant where none is taken";
  EXPECT_EQ(refusal_for_devices({"fit", "arm", "--field"}).front(), '2');
  EXPECT_EQ(refusal_for_devices({"report", "--quick"}).front(), '2');
}

TEST(CommandLine, HelpsWithWordsInTheirOrder) {
  const std::string help = parse_for_devices({"fit", "--help"}).text;
  EXPECT_NE(help.find("Usage: devices fit KIND FILE [options]"), std::string::npos) << help;
  EXPECT_NE(help.find("What a table holds.\n\nExamples:\n"), std::string::npos) << help;
  const std::string all = parse_for_devices({"--help"}).text;
  EXPECT_NE(all.find("Usage: devices [VERB] [options]"), std::string::npos) << all;
  EXPECT_NE(all.find("'devices' is 'devices report'"), std::string::npos) << all;
  EXPECT_NE(parse({"info", "--help"}).text.find("info FILE... | --example NAME [options]"),
            std::string::npos);
}

class SessionOnTheCommandLine : public ::testing::Test {
 protected:
  std::string session(const std::string& scene) {
    return folder_
        .write("s.toml", "format = 1\nprogram = \"flow\"\n[[input]]\nfile = \"a b.vtk\"\n[scene]\n" + scene)
        .string();
  }
  TempFolder folder_;
};

TEST_F(SessionOnTheCommandLine, GivesFilesAndOptions) {
  const auto file = session(
      "seeds = \"grid:2,2,2\"\nfield = \"v w\"\ncamera = \"-1,2,3,4\"\nseed = \"9\"\nstop-plane = "
      "\"1,0,0,1;0,1,0,2\"\n");
  const ParsedCommand parsed = parse({"open", "--session", file});
  EXPECT_EQ(parsed.options.input.files, std::vector<std::filesystem::path>{folder_.path("a b.vtk")});
  EXPECT_EQ(parsed.options.tracing.seeds, "grid:2,2,2");
  EXPECT_EQ(parsed.options.input.field, "v w");
  EXPECT_EQ(parsed.options.view.camera, "-1,2,3,4");
  EXPECT_EQ(parsed.options.common.seed, 9U);
  EXPECT_EQ(parsed.options.tracing.stop_planes.size(), 2U);
}

TEST_F(SessionOnTheCommandLine, GivesWayToWhatIsTyped) {
  const auto file = session("seeds = \"grid:2,2,2\"\nfield = \"v\"\n");
  const ParsedCommand parsed = parse({"open", "other.vtk", "--field", "w", "--session", file});
  EXPECT_EQ(parsed.options.input.files, std::vector<std::filesystem::path>{"other.vtk"});
  EXPECT_EQ(parsed.options.input.field, "w");
  EXPECT_EQ(parsed.options.tracing.seeds, "grid:2,2,2");
}

TEST_F(SessionOnTheCommandLine, LeavesOutWhatTheVerbHasNoUseFor) {
  const auto file = session("seeds = \"grid:2,2,2\"\ncamera = \"1,2,3,4\"\n");
  EXPECT_EQ(parse({"info", "--session", file}).options.input.files.size(), 1U);
  EXPECT_EQ(parse({"trace", "--session", file}).options.tracing.seeds, "grid:2,2,2");
}

TEST_F(SessionOnTheCommandLine, NamesAnOptionThatIsNone) {
  const std::string line = refusal({"open", "--session", session("colour = \"red\"\n")});
  EXPECT_EQ(line.front(), '3');
  EXPECT_NE(line.find("'color'"), std::string::npos) << line;
  EXPECT_EQ(refusal({"open", "--session", session("tolerance = \"tight\"\n")}).front(), '2');
}

TEST_F(SessionOnTheCommandLine, OfANewerProgramIsReadAsFarAsItIsKnown) {
  const std::string file =
      folder_
          .write("n.toml",
                 "format = 99\nprogram = \"flow\"\n[scene]\nseeds = \"grid:2,2,2\"\nhue = 3\n"
                 "sheen = \"1\"\ncolor-map = \"moreland\"\nline-width = \"thin\"\n")
          .string();
  const ParsedCommand parsed = parse({"open", "a.vtk", "--session", file});
  EXPECT_EQ(parsed.options.tracing.seeds, "grid:2,2,2");
  EXPECT_TRUE(parsed.options.view.color_map.empty() && !parsed.options.view.line_width);
  const auto told = [&](const char* words) {
    return std::ranges::count_if(
        parsed.notes, [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_EQ(told("newer version"), 1);
  for (const char* name : {"'hue'", "'sheen'", "'color-map'", "'line-width'"})
    EXPECT_EQ(told(name), 1) << name;
  EXPECT_EQ(parsed.notes.size(), 5U);
  EXPECT_EQ(refusal({"open", "--session", session("color-map = \"moreland\"\n")}).front(), '2')
      << "this version should know";
}

}  // namespace
}  // namespace palpate::test
