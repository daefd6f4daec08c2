// Constants that no chain can use are refused, each in one line that names its option.

#include "common/hand/touch_options.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/cli/command_line.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/proxy_chain.h"

namespace palpate::test {
namespace {

ParsedCommand parse(const std::vector<std::string>& arguments) {
  Explorer explorer{.name = "flow", .summary = "to test"};
  explorer.verbs.push_back({.name = "probe",
                            .summary = "s",
                            .groups = {Group::kInput, Group::kTouch},
                            .examples = {},
                            .run = [](const Document&, const VerbContext&) { return ExitCode::kDone; }});
  return parse_command_line(explorer, arguments);
}

/// What the user is told; empty where the settings of a chain come of it.
std::string refusal(const std::string& option, const std::string& value) {
  try {
    const ParsedCommand parsed = parse({"probe", "--example", "abc", option, value});
    EXPECT_TRUE(touch_settings(parsed.options.touch).valid()) << option << ' ' << value;
    (void)touch_limits(parsed.options.touch);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage) << option << ' ' << value;
    return error.what();
  }
  return "";
}

// A value that is named twice, however it is written, is one surface.
TEST(TouchOptions, JoinDoubledIsovalues) {
  TouchOptions touch;
  touch.isovalues = "0.5,1,5e-1,1.0,2,0.50";
  const Isovalues values = touch_settings(touch).isosurface.isovalues;
  ASSERT_EQ(values.count, 3);
  EXPECT_EQ(values.value[0], 0.5);
  EXPECT_EQ(values.value[1], 1.0);
  EXPECT_EQ(values.value[2], 2.0);
  touch.isovalues = "1,2,3,4,5,6,7,8,8,1";
  EXPECT_EQ(touch_settings(touch).isosurface.isovalues.count, 8);
  touch.isovalues = "1,2,3,4,5,6,7,8,9";
  EXPECT_THROW((void)touch_settings(touch), Error);
}

TEST(TouchOptions, RefuseWhatNoChainCanUse) {
  struct Bad {
    std::string option;
    std::vector<std::string> values;
  };
  for (const auto& [option, values] : {Bad{"--stiffness", {"-1", "nan", "inf"}},
                                       {"--damping", {"-1", "nan", "inf"}},
                                       {"--passivity", {"maybe", "2"}},
                                       {"--release", {"-1", "0", "nan", "inf"}},
                                       {"--drag", {"-1", "nan", "inf"}},
                                       {"--ticks", {"-1", "nan", "inf", "often"}},
                                       {"--tick-stiffness", {"-0.5", "1.5", "nan"}},
                                       {"--speed-force", {"nan", "inf"}},
                                       {"--field-force", {"nan", "inf"}},
                                       {"--field-damping", {"-1", "nan", "inf"}},
                                       {"--density-curve", {"1:0,0:1", "0:0,1:2", "0:nan", "steep"}},
                                       {"--reference", {"tensor"}},
                                       {"--axis-rules", {"free", "free,drag,stick"}},
                                       {"--tau", {"-1", "nan", "0:1,0:2", "1/2"}},
                                       {"--kappa", {"-0.5", "1.5", "nan", "1:0,0:1"}},
                                       {"--measure", {"colour"}},
                                       {"--friction", {"-1", "nan", "inf"}},
                                       {"--force-cap", {"-1", "0", "nan", "inf", "101", "1e300"}},
                                       {"--slew-cap", {"-1", "0", "nan", "inf", "1e300"}},
                                       {"--workspace-scale", {"-1", "nan", "inf"}}}) {
    for (const std::string& value : values) {
      const std::string line = refusal(option, value);
      EXPECT_NE(line.find(option), std::string::npos) << option << ' ' << value << ": '" << line << "'";
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
}

TEST(TouchOptions, TakeWhatAChainCanUse) {
  EXPECT_EQ(refusal("--stiffness", "0"), "");
  EXPECT_EQ(refusal("--drag", "0"), "");
  EXPECT_EQ(refusal("--ticks", "auto"), "");
  EXPECT_EQ(refusal("--tick-stiffness", "1"), "");
  EXPECT_EQ(refusal("--speed-force", "-0.5"), "");
  EXPECT_EQ(refusal("--field-force", "-0.5"), "");
  EXPECT_EQ(refusal("--field-damping", "0"), "");
  EXPECT_EQ(refusal("--axis-rules", "fixed,free,free"), "");
  EXPECT_EQ(refusal("--tau", "0:0,0.4:2,smooth"), "");
  EXPECT_EQ(refusal("--kappa", "0"), "");
  EXPECT_EQ(refusal("--density-curve", "0:0,0.4:0,0.6:1,smooth"), "");
}

TEST(TouchOptions, SayFromHowManyLinksAChainIsControlled) {
  const auto links = [](const char* word) {
    return touch_settings(parse({"probe", "--example", "abc", "--passivity", word}).options.touch)
        .passivity.from_links;
  };
  EXPECT_EQ(touch_settings(parse({"probe", "--example", "abc"}).options.touch).passivity.from_links, 2.0);
  EXPECT_EQ(links("auto"), 2.0);
  EXPECT_EQ(links("on"), 1.0);
  EXPECT_GT(links("off"), ChainStep::kMaxLinks);
}

// What a panel shows of the hand is in the document: as many members as the compiler counts.
TEST(TouchChoiceOfADocument, ComesBackWithAllThatAPanelEdits) {
  const std::vector<HapticMode> modes = modes_of(FieldKind::kVector);
  TouchChoice choice;
  auto& [mode, settings, fixtures, ticks, balls, path, surface, stroke, fade, local] = choice;
  mode = 1;
  settings.stiffness = 123.5;  // the others have tests of their modes
  fixtures = {"plane:0,0,1,0", "mode"};
  ticks = true;
  balls = path = fade = false;
  surface = false;
  stroke = StrokeUse::kReplace;
  local = SeedShape::kPlane;
  TouchOptions kept;
  keep_touch(choice, modes[1].name, kept);
  const TouchChoice back = touch_choice(kept, modes);
  EXPECT_EQ(back.mode, 1U);
  EXPECT_EQ(back.settings.stiffness, 123.5);
  EXPECT_EQ(back.fixtures, choice.fixtures);
  EXPECT_TRUE(back.ticks);
  EXPECT_FALSE(back.show_balls || back.show_path || back.fade_rest);
  EXPECT_EQ(back.show_surface, false);
  EXPECT_EQ(back.stroke, StrokeUse::kReplace);
  EXPECT_EQ(back.local, SeedShape::kPlane);
  EXPECT_FALSE(touch_choice(TouchOptions(), modes).show_surface) << "left to the kind of data";
  TouchOptions wrong;
  wrong.local_lines = "cloud";
  EXPECT_THROW((void)touch_choice(wrong, modes), Error);
}

}  // namespace
}  // namespace palpate::test
