#include "common/window/user_settings.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

class UserSettingsTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("palpate_user_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    files_ = {folder_ / "config" / "flow.toml", folder_ / "state" / "flow-recent.toml"};
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  std::filesystem::path folder_;
  UserFiles files_;
  std::vector<std::string> notes_;
};

TEST_F(UserSettingsTest, NothingThereMeansTheDefaultsAndNoNote) {
  EXPECT_EQ(load_user_settings(files_, notes_), UserSettings{});
  EXPECT_TRUE(notes_.empty());
}

TEST_F(UserSettingsTest, ComeBackAsTheyWereSaved) {
  UserSettings settings{.width = 801, .height = 602};
  settings.appearance = {{"axes", "off"}, {"background", "0.25,0.5,1"}};  // by name
  remember(settings.recent, {{"/data/a b.vtk"}, {}});
  remember(settings.recent, {{"/data/grid \"1\".bin"}, "/data/q.bin"});
  save_user_settings(files_, settings, {});
  EXPECT_EQ(load_user_settings(files_, notes_), settings);
  EXPECT_TRUE(notes_.empty());
}

TEST_F(UserSettingsTest, WhatDidNotChangeIsNotWritten) {
  UserSettings settings;
  save_user_settings(files_, settings, settings);
  EXPECT_FALSE(std::filesystem::exists(folder_));
  remember(settings.recent, {{"/data/a.vtk"}, {}});
  save_user_settings(files_, settings, {});
  EXPECT_FALSE(std::filesystem::exists(files_.settings));
  EXPECT_TRUE(std::filesystem::exists(files_.recent));
}

TEST_F(UserSettingsTest, BrokenFileIsNamedAndWrongValuesAreLeftOut) {
  write(files_.settings, "[window]\nwidth = \n");
  write(files_.recent, "input = [ 3, { files = [] }, { files = ['/data/a.vtk', 4] } ]\n");
  const UserSettings settings = load_user_settings(files_, notes_);
  EXPECT_EQ(settings.width, UserSettings{}.width);
  ASSERT_EQ(settings.recent.size(), 1U);
  EXPECT_EQ(settings.recent[0].files, std::vector<std::filesystem::path>{"/data/a.vtk"});
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find(files_.settings.string() + ": line 2"), std::string::npos) << notes_[0];

  write(files_.settings, "[window]\nwidth = -5\nheight = 'tall'\n[appearance]\naxes = 7\nhalos = 'off'\n");
  const UserSettings odd = load_user_settings(files_, notes_);
  EXPECT_EQ(odd.width, UserSettings{}.width);
  EXPECT_EQ(odd.height, UserSettings{}.height);
  EXPECT_EQ(odd.appearance, (Preferences{{"halos", "off"}}));
}

Document of_flow() {
  Document document;
  document.input.kind = FieldKind::kVector;
  return document;
}

TEST(Preferences, ComeAfterOptionsAndSessions) {
  const Preferences preferences{{"axes", "off"},      {"background", "light"}, {"halos", "off"},
                                {"outline", "maybe"}, {"line-width", "7"},     {"unheard-of", "on"}};
  Document document = of_flow();
  document.given = {"axes"};
  take_preferences(preferences, document);
  EXPECT_TRUE(document.view.axes) << "was asked for";
  EXPECT_EQ(document.view.background, "light");
  EXPECT_EQ(document.view.halos, false);
  EXPECT_TRUE(document.view.outline) << "is no word for it";
  EXPECT_FALSE(document.view.line_width) << "belongs to the data";

  Document of_session = of_flow();
  of_session.common.session = "s.toml";
  take_preferences(preferences, of_session);
  EXPECT_TRUE(of_session.view.axes && of_session.view.background == "dark") << "as the session leaves it";

  Document of_volume = of_flow();
  of_volume.input.kind = FieldKind::kScalar;
  take_preferences({{"halos", "off"}, {"background", "teal"}, {"projection", "orthographic"}}, of_volume);
  EXPECT_FALSE(of_volume.view.halos) << "a volume has none";
  EXPECT_EQ(of_volume.view.background, "dark") << "that is no colour";
  EXPECT_EQ(of_volume.volume.projection, "orthographic");
}

TEST(Preferences, AreWhatTheUserChangedInAWindow) {
  Document before = of_flow();
  before.view.background = "light";  // of a session, say
  Document after = before;
  after.view.axes = false;
  after.view.halos = false;
  after.view.line_width = 9.0;
  Preferences preferences{{"outline", "off"}, {"axes", "on"}};
  note_preferences(before, after, preferences);
  EXPECT_EQ(preferences, (Preferences{{"outline", "off"}, {"axes", "off"}, {"halos", "off"}}));
  note_preferences(after, before, preferences);
  EXPECT_EQ(preferences, (Preferences{{"outline", "off"}})) << "as without a file";
}

TEST_F(UserSettingsTest, FolderThatCannotBeMadeIsAnError) {
  write(folder_ / "config", "a file where the folder should be");
  UserSettings settings;
  settings.width = 640;
  EXPECT_THROW(save_user_settings(files_, settings, {}), Error);
}

TEST(RecentInputs, NewestFirstEachOnceAndNotTooMany) {
  std::vector<InputFiles> recent;
  for (std::size_t i = 0; i < UserSettings::kMostRecent + 3; ++i) {
    remember(recent, {{"/data/" + std::to_string(i)}, {}});
  }
  EXPECT_EQ(recent.size(), UserSettings::kMostRecent);
  remember(recent, {{"/data/7"}, {}});
  remember(recent, {});  // an example
  EXPECT_EQ(recent.size(), UserSettings::kMostRecent);
  EXPECT_EQ(recent.front().files.front(), "/data/7");
  EXPECT_EQ(std::count(recent.begin(), recent.end(), recent.front()), 1);
}

TEST(UserFilesTest, FollowTheXdgVariablesWhereTheyAreAbsolute) {
  setenv("HOME", "/home/u", 1);
  setenv("XDG_CONFIG_HOME", "/conf", 1);
  setenv("XDG_STATE_HOME", "relative", 1);
  const auto files = user_files("flow");
  ASSERT_TRUE(files);
  EXPECT_EQ(files->settings, "/conf/palpate/flow.toml");
  EXPECT_EQ(files->recent, "/home/u/.local/state/palpate/flow-recent.toml");
  unsetenv("HOME");
  EXPECT_FALSE(user_files("flow"));
}

}  // namespace
}  // namespace palpate
