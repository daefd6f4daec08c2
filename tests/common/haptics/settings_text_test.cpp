// Settings as text: every bit comes back, and what no chain could use is refused in a few words.

#include "common/haptics/settings_text.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace palpate {
namespace {

const ChainSettings kOdd{.stiffness = 1000.0 / 3.0,
                         .streamline = {.release_distance = 0.1 + 0.2, .speed_force = -0.1},
                         .ticks = {.interval = 1.7976931348623157e308, .stiffness = 1.0 / 7.0},
                         .drag = {.threshold = 5e-324}};

std::string problem_of(const std::string& text) {
  ChainSettings settings;
  return read_settings(text, settings).value_or("");
}

/// `settings_text(kOdd)` with the value of `name` replaced.
std::string with(const std::string& name, const std::string& value) {
  std::string text = settings_text(kOdd) + ' ';
  const std::size_t at = (' ' + text).find(' ' + name + '=') + name.size() + 1;
  return text.replace(at, text.find(' ', at) - at, value).substr(0, text.size() - 1);
}

TEST(SettingsText, ReadsBackToTheLastBit) {
  ChainSettings settings;
  EXPECT_EQ(read_settings(settings_text(kOdd), settings), std::nullopt);
  EXPECT_EQ(settings, kOdd);
}

TEST(SettingsText, NamesEveryValueOnce) {
  std::set<std::string> names;
  std::size_t count = 0;
  ChainSettings::each(kOdd, [&](const char* name, const auto&) {
    names.insert(name);
    ++count;
  });
  EXPECT_EQ(names.size(), count);
}

TEST(SettingsText, RefusesWhatMakesNoSense) {
  EXPECT_EQ(problem_of(""), "it lacks stiffness=");
  EXPECT_EQ(problem_of("stiffness=200"), "it lacks damping=");
  EXPECT_EQ(problem_of(settings_text(kOdd) + " stiffness=1"),
            "'stiffness=1' is not known here, or stands there twice");
  EXPECT_EQ(problem_of(settings_text(kOdd) + " mass=1"), "'mass=1' is not known here, or stands there twice");
  for (const char* bad : {"", "x", "1,5", "0x1", "1e999"}) {
    EXPECT_EQ(problem_of(with("stiffness", bad)), "'stiffness=" + std::string(bad) + "' cannot be read");
  }
  for (const char* bad : {"nan", "inf", "-1"}) {
    EXPECT_EQ(problem_of(with("drag.threshold", bad)), "its values make no chain");
  }
}

// The bounds of each value, by what no spring, hand or clock could have.
TEST(ChainSettings, KnowsWhatNoChainCanUse) {
  EXPECT_TRUE(ChainSettings{}.valid());
  EXPECT_TRUE(kOdd.valid());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, HUGE_VAL, nan}) {
    EXPECT_FALSE((ChainSettings{.stiffness = bad}.valid()));
    EXPECT_FALSE((ChainSettings{.streamline = {.release_distance = bad}}.valid()));
    EXPECT_FALSE((ChainSettings{.ticks = {.interval = bad}}.valid()));
    EXPECT_FALSE((ChainSettings{.ticks = {.stiffness = bad}}.valid()));
    EXPECT_FALSE((ChainSettings{.drag = {.threshold = bad}}.valid()));
  }
  EXPECT_FALSE((ChainSettings{.streamline = {.release_distance = 0.0}}.valid()));
  EXPECT_FALSE((ChainSettings{.streamline = {.speed_force = nan}}.valid()));
  EXPECT_FALSE((ChainSettings{.ticks = {.stiffness = 1.5}}.valid()));
}

}  // namespace
}  // namespace palpate
