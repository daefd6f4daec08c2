// workbench.toml: what calibrations write comes back, and nothing else of the file is touched.

#include "common/kinematics/workbench_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/kinematics/workbench_writer.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

class WorkbenchFileTest : public testing::Test {
 protected:
  void write(const std::string& text) { folder_.write("workbench.toml", text); }
  [[nodiscard]] std::string text() const { return read_file(path_); }
  [[nodiscard]] std::string refusal(const std::string& content) {
    write(content);
    try {
      (void)read_workbench(path_);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "";
  }
  TempFolder folder_;
  std::filesystem::path path_ = folder_.path("workbench.toml");
};

TEST_F(WorkbenchFileTest, EverySectionComesBackToTheBit) {
  TrackerCorrection tracker;
  tracker.position = {.degree = 1,
                      .center = {0.1, 0.2, 1.0 / 3.0},
                      .scale = 0.7,
                      .coefficients = {{1e-3, -2e-17, 0.1}, {1, 2, 3}, {0.3, 0.2, 0.1}, {4, 5, 6}}};
  tracker.orientation = tracker.position;
  tracker.table = {
      {-1, 0, 1}, {0.5, 0.25, 0.125}, {2, 3, 2}, std::vector<PoseError>(12, {{0.1, 0.2, 0.3}, {}})};
  const DhhChain arm = nominal_phantom_3();
  const Rigid motion{rotation_by({0.1, 0.2, 0.3}), {1, 2, 3}};
  write_section(path_, "tracker", section_text(tracker), false);
  write_section(path_, "arm", section_text(arm), false);
  write_section(path_, "apparatus", section_text(ApparatusGeometry{motion, {{1, 2, 3}, Vec3{NAN}}}), false);
  write_section(path_, "coregistration", section_text(CoregistrationGeometry{motion, {0.1, 0, 0}}), false);
  write_section(path_, "stylus", stylus_section_text({0.0, 0.0, -0.14}), false);
  write_section(path_, "eyes", section_text(EyesGeometry{Vec3{-0.03, 0, 0}, std::nullopt}), false);

  const WorkbenchGeometry back = read_workbench(path_);
  ASSERT_TRUE(back.tracker && back.arm && back.apparatus && back.coregistration && back.stylus && back.eyes);
  EXPECT_EQ(back.tracker->position.coefficients, tracker.position.coefficients);
  EXPECT_EQ(back.tracker->position.center, tracker.position.center);
  EXPECT_EQ(back.tracker->table.values[7].position, tracker.table.values[7].position);
  EXPECT_EQ(back.tracker->table.count, tracker.table.count);
  ASSERT_EQ(back.arm->rows.size(), arm.rows.size());
  EXPECT_EQ(back.arm->joint_count, arm.joint_count);
  for (std::size_t row = 0; row < arm.rows.size(); ++row) {
    EXPECT_EQ(back.arm->rows[row].values, arm.rows[row].values);
    EXPECT_EQ(back.arm->rows[row].free, arm.rows[row].free);
    EXPECT_EQ(back.arm->rows[row].joint, arm.rows[row].joint);
  }
  EXPECT_LT(glm::distance(back.coregistration->tracker_from_arm * Vec3{1, 1, 1}, motion * Vec3{1, 1, 1}),
            1e-15);
  EXPECT_EQ(back.stylus->z, -0.14);
  EXPECT_TRUE(back.eyes->left && !back.eyes->right);
  EXPECT_TRUE(std::isnan(back.apparatus->markers[1].x));
}

TEST_F(WorkbenchFileTest, ReplacingASectionLeavesAllOtherLines) {
  const std::string
      head =
          "# the lab's workbench\nname = 'B 12'   # our room\n\n[screen]\nlower_left = [0, 0, 0]\n"
          "lower_right = [1, 0, 0]\nupper_left = [0, 1, 0]\n\n",
      tail =
          "\n# ours, not Palpate's\n[lab.notes]\ntext = \"\"\"\n[stylus] is in the drawer\n\"\"\"\n"
          "[[lab.people]]\nname = 'A'\n";
  write(head + "[stylus]\ntip = [0, 0, 0]\n" + tail);
  EXPECT_THROW(write_section(path_, "stylus", stylus_section_text({1, 2, 3}), false), Error);
  write_section(path_, "stylus", stylus_section_text({1, 2, 3}), true);
  EXPECT_EQ(text(), head + stylus_section_text({1, 2, 3}) + tail);
  write_section(path_, "eyes", section_text(EyesGeometry{Vec3{0.0}, Vec3{1.0}}), false);
  EXPECT_TRUE(text().starts_with(head + stylus_section_text({1, 2, 3}) + tail));
  EXPECT_EQ(read_workbench(path_).stylus->y, 2.0);
}

TEST_F(WorkbenchFileTest, WritesNothingRatherThanLoseSomething) {
  // A section in two pieces and one that is none cannot be replaced by text; the file must stay as it is
  // then.
  for (const std::string content : {"stylus = {tip = [0, 0, 0]}\n", "stylus.tip = [0, 0, 0]\nname = 'B'\n",
                                    "[stylus]\ntip = [0, 0, 0]\n[other]\na = 1\n[stylus.more]\nb = 2\n"}) {
    write(content);
    EXPECT_THROW(write_section(path_, "stylus", stylus_section_text({1, 2, 3}), true), Error) << content;
    EXPECT_EQ(text(), content);
  }
}

TEST_F(WorkbenchFileTest, SaysHowHandsWork) {
  write("[stylus]\ntip = [0, 0, 0]\n");
  EXPECT_FALSE(read_workbench(path_).interaction.immersive) << "the default is a desktop";
  write("[interaction]\ntechnique = 'desktop'\n");
  EXPECT_FALSE(read_workbench(path_).interaction.immersive);
  write(
      "[interaction]\ntechnique = \"immersive\"\nmiddle = [0.1, 0.2, 0.3]\nrotation = [0.6, 0.8, 0, 0]\ngain "
      "= "
      "2\n");
  const InteractionGeometry hands = read_workbench(path_).interaction;
  EXPECT_TRUE(hands.immersive);
  EXPECT_EQ(hands.middle, Vec3(0.1, 0.2, 0.3));
  EXPECT_NEAR(hands.rotation.x, 0.8, 1e-16);
  EXPECT_EQ(hands.gain, 2.0);
  const auto names = [this](const std::string& content, const char* line, const char* word) {
    const std::string text = refusal(content);
    EXPECT_NE(text.find(line), std::string::npos) << text;
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  names("[interaction]\ntechnique = 'gloves'\n", "line 2", "gloves");
  names("\n[interaction]\ntechnique = 'immersive'\n", "line 2", "middle");
  names("[interaction]\ngain = 0\n", "line 2", "above zero");
  names("[interaction]\nspeed = 1\n", "line 2", "gain");
  names("[interaction]\nrotation = [2, 0, 0, 0]\n", "line 2", "length 2");
}

TEST_F(WorkbenchFileTest, NamesTheDeadManSwitch) {
  const auto read = [this](const std::string& lines) {
    write("[interaction]\n" + lines);
    return read_workbench(path_).interaction;
  };
  EXPECT_FALSE(read("").enabling_button.has_value());
  EXPECT_EQ(read("enabling_button = 3\n").enabling_button, 3);
  EXPECT_EQ(read("enabling_button = \"none\"\n").enabling_button, InteractionGeometry::kNoButton);
  EXPECT_EQ(read("enabling_device = \"pedal\"\n").enabling_device, "pedal");
  for (const char* wrong :
       {"enabling_button = 32", "enabling_button = -1", "enabling_button = \"two\"", "enabling_button = 1.5",
        "enabling_device = 3", "enabling_device = \"pedal\"\nenabling_button = \"none\""}) {
    EXPECT_THROW((void)read(wrong), Error) << wrong;
  }
}

TEST_F(WorkbenchFileTest, SaysWhichStationOfATrackerIsWhere) {
  write("[interaction]\n");
  EXPECT_EQ(read_workbench(path_).interaction.stylus_station, 1);
  EXPECT_EQ(read_workbench(path_).interaction.hand_station, InteractionGeometry::kNoStation);
  write("[interaction]\nstylus_station = 3\nhand_station = 1\nhead_station = 16\n");
  const InteractionGeometry read = read_workbench(path_).interaction;
  EXPECT_EQ(read.stylus_station, 3);
  EXPECT_EQ(read.hand_station, 1);
  EXPECT_EQ(read.head_station, 16);
  const std::string twice = refusal("[interaction]\n\nhead_station = 1\n");
  EXPECT_NE(twice.find("line 3"), std::string::npos) << twice;
  EXPECT_NE(twice.find("stylus_station"), std::string::npos) << twice;
  for (const char* wrong : {"hand_station = 0", "hand_station = 17", "hand_station = 1.5"}) {
    EXPECT_NE(refusal("[interaction]\n" + std::string(wrong) + "\n").find("1 to 16"), std::string::npos);
  }
}

TEST_F(WorkbenchFileTest, KnowsOneScreenOrSeveral) {
  write("[screen]\nlower_left = [0, 0, 0]\nlower_right = [1, 0, 0]\nupper_left = [0, 0.5, 0]\n");
  ASSERT_EQ(read_workbench(path_).screens.size(), 1U);
  EXPECT_EQ(width(read_workbench(path_).screens[0].corners), 1.0);
  write(
      "[[screen]]\nname = 'table'\nlower_left = [0, 0, 0]\nlower_right = [1, 0, 0]\nupper_left = [0, 0, 1]\n"
      "[[screen]]\nname = 'desk'\npixels = [1920, 1080]\nlower_left = [0, 0, 1]\nlower_right = [1, 0, 1]\n"
      "upper_left = [0, 1, 1]\n");
  const auto screens = read_workbench(path_).screens;
  ASSERT_EQ(screens.size(), 2U);
  EXPECT_EQ(screens[1].name, "desk");
  EXPECT_EQ(screens[1].pixels[1], 1080);
  const auto names = [this](const std::string& content, const char* line, const char* word) {
    const std::string text = refusal(content);
    EXPECT_NE(text.find(line), std::string::npos) << text;
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  names("[screen]\nlower_left = [0, 0, 0]\nlower_right = [1, 0, 0]\nupper_left = [0.5, 0.5, 0]\n", "line 2",
        "rectangle");
  names("[screen]\nlower_left = [0, 0, 0]\nlower_right = [1, 0, 0]\n", "line 1", "upper_left");
  names(
      "[screen]\nlower_left = [0, 0, 0]\nlower_right = [1, 0, 0]\nupper_left = [0, 1, 0]\npixels = [1.5, "
      "2]\n",
      "line 5", "whole");
  names("a = 1\nscreen = 3\n", "line 2", "[screen]");
}

// What users are given to start from is read, every key of it.
TEST_F(WorkbenchFileTest, ReadsTheOneOfTheDocuments) {
  const WorkbenchGeometry workbench = read_workbench(source_folder() / "docs/workbench.toml");
  ASSERT_EQ(workbench.screens.size(), 1U);
  EXPECT_EQ(workbench.screens[0].stereo, StereoMode::kRows);
  EXPECT_EQ(workbench.head.glide, 0.75);
  EXPECT_TRUE(workbench.interaction.immersive);
  EXPECT_EQ(workbench.interaction.surface, Vec4(0.0, 0.0, 1.0, 0.0));
  EXPECT_EQ(workbench.interaction.enabling_device, "pedal");
  EXPECT_EQ(workbench.device_options.size(), 1U);
  // The keys of the header that says what there is are in it.
  std::ifstream header(source_folder() / "common/kinematics/workbench_file.h");
  std::stringstream all;
  all << header.rdbuf();
  std::ifstream document(source_folder() / "docs/workbench.toml");
  std::stringstream words;
  words << document.rdbuf();
  bool by_hand = false;
  int keys = 0;
  for (std::string line; std::getline(all, line);) {
    if (line.starts_with("///   [screen]")) by_hand = true;
    if (line.starts_with("///   [device.NAME]")) break;
    const std::size_t equals = line.find(" = ");
    if (!by_hand || !line.starts_with("///   ") || line[6] < 'a' || equals == std::string::npos) continue;
    const std::string key = line.substr(6, equals - 6);
    EXPECT_NE(words.str().find("\n" + key + " = "), std::string::npos) << key;
    ++keys;
  }
  EXPECT_GT(keys, 20);
}

TEST_F(WorkbenchFileTest, SaysWhatFollowsTheHeadAndHowScreensShowIt) {
  const std::string screen =
      "[screen]\nlower_left = [0, 0, 1]\nlower_right = [1, 0, 1]\nupper_left = [0, 1, 1]\n";
  write(screen +
        "pixels = [800, 800]\nposition = [-1920, 40]\nstereo = 'rows'\n[head]\nsource = 'hands'\n"
        "resting_eye = [0.5, 0.6, 2]\nsensor_latency = 0.004\ndisplay_latency = 0.008\nlatency = 0.05\n"
        "predict = false\nvelocity_window = 0.1\nfreeze = 0.5\nglide = 0\n"
        "[interaction]\ntechnique = 'immersive'\nmiddle = [0, 0, 0]\ntip_offset = [0, 0.05, 0]\n"
        "surface = 'screen'\n");
  const WorkbenchGeometry workbench = read_workbench(path_);
  EXPECT_EQ(workbench.screens[0].position[0], -1920);
  EXPECT_EQ(workbench.screens[0].stereo, StereoMode::kRows);
  EXPECT_EQ(workbench.head.source, "hands");
  EXPECT_EQ(workbench.head.resting_eye, Vec3(0.5, 0.6, 2.0));
  EXPECT_EQ(workbench.head.sensor_latency, 0.004);
  EXPECT_EQ(workbench.head.display_latency, 0.008);
  EXPECT_EQ(workbench.head.latency, 0.05);
  EXPECT_FALSE(workbench.head.predict);
  EXPECT_EQ(workbench.head.velocity_window, 0.1);
  EXPECT_EQ(workbench.head.freeze, 0.5);
  EXPECT_EQ(workbench.head.glide, 0.0);
  EXPECT_EQ(workbench.interaction.tip_offset, Vec3(0.0, 0.05, 0.0));
  EXPECT_EQ(workbench.interaction.surface, Vec4(0.0, 0.0, 1.0, 1.0));
  write("[interaction]\nsurface = [0, 2, 0, 1]\n");
  EXPECT_EQ(read_workbench(path_).interaction.surface, Vec4(0.0, 1.0, 0.0, 0.5));
  // At a desk the screen is where the view is.
  write("[interaction]\nsurface = 'screen'\n");
  EXPECT_EQ(read_workbench(path_).interaction.surface, Vec4(0.0, 0.0, 1.0, 0.0));

  const auto names = [this](const std::string& content, const char* line, const char* word) {
    const std::string text = refusal(content);
    EXPECT_NE(text.find(line), std::string::npos) << text;
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  names(screen + "position = [0.5, 0]\n", "line 5", "whole");
  names(screen + "stereo = 'crossed'\n", "line 5", "quad-buffer");
  names(screen + "name = 'all'\n", "line 5", "all");
  names(
      "[[screen]]\nname = 'a'\nlower_left = [0, 0, 1]\nlower_right = [1, 0, 1]\nupper_left = [0, 1, 1]\n"
      "[[screen]]\nname = 'a'\nlower_left = [0, 0, 1]\nlower_right = [1, 0, 1]\nupper_left = [0, 1, 1]\n",
      "line 6", "second screen");
  names("[head]\nsource = 3\n", "line 2", "hands");
  names("[head]\nlatency = -1\n", "line 2", "seconds");
  names("[head]\nsensor_latency = 60\n", "line 2", "from 0 to 10");
  names("[head]\nvelocity_window = 0\n", "line 2", "above 0");
  names("[head]\npredict = 'yes'\n", "line 2", "true or false");
  names("[head]\nresting_eye = [1, 2]\n", "line 2", "3 finite numbers");
  names("[head]\nspeed = 1\n", "line 2", "velocity_window");
  names("[interaction]\nsurface = 'table'\n", "line 2", "screen");
  names("[interaction]\npick = 'cone'\n", "line 2", "aperture");
  names("[interaction]\naperture = 0\n", "line 2", "above zero");
  write("[interaction]\npick = 'aperture'\naperture = 0.02\n");
  EXPECT_TRUE(read_workbench(path_).interaction.through_aperture);
  EXPECT_EQ(read_workbench(path_).interaction.aperture, 0.02);
  names("[interaction]\ntechnique = 'immersive'\nmiddle = [0, 0, 0]\nsurface = 'screen'\n", "line 4",
        "[screen]");
  names("[interaction]\nsurface = [0, 0, 0, 1]\n", "line 2", "normal");
  names("[interaction]\ntip_offset = 3\n", "line 2", "3 finite numbers");
}

TEST_F(WorkbenchFileTest, KnowsDevicesByTheirNames) {
  write(
      "# ours\n[device.falcon]\ngain = 3620\nthigh = 0.0603\nfirmware = 'f.bin'\n\n# next\n[stylus]\n"
      "tip = [0, 0, 1]\n");
  const std::string before = text();
  TunedDevice falcon{.device = "falcon", .stiffness = 700.0, .rate = 1000.0, .places = {{{0.1, 0, -1}, 1e3}}};
  const TunedDevice arm{.device = "simulated:ideal", .stiffness = 1.0 / 3.0, .rate = 500.0, .places = {}};
  write_section(path_, "tuned.falcon", section_text(falcon), false);
  write_section(path_, "tuned.simulated:ideal", section_text(arm), false);
  EXPECT_THROW(write_section(path_, "tuned.falcon", section_text(falcon), false), Error);
  falcon.stiffness = 650.0;
  write_section(path_, "tuned.falcon", section_text(falcon), true);
  EXPECT_TRUE(has_section(path_, "tuned.falcon"));
  EXPECT_FALSE(has_section(path_, "tuned.omega"));
  EXPECT_TRUE(text().starts_with(before));

  const WorkbenchGeometry back = read_workbench(path_);
  ASSERT_EQ(back.tuned.size(), 2U);
  ASSERT_NE(find_tuned(back.tuned, "falcon"), nullptr);
  EXPECT_EQ(find_tuned(back.tuned, "falcon")->stiffness, 650.0);
  EXPECT_EQ(find_tuned(back.tuned, "falcon")->places[0].stiffness, 1e3);
  EXPECT_EQ(find_tuned(back.tuned, "simulated:ideal")->stiffness, 1.0 / 3.0);
  EXPECT_EQ(find_tuned(back.tuned, "simulated:ideal")->rate, 500.0);
  EXPECT_EQ(find_tuned(back.tuned, "omega"), nullptr);

  // What the command line says comes first, and is all that other devices get.
  using Options = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(with_device_options(back.device_options, "falcon", {{"gain", "4000"}}),
            (Options{{"firmware", "f.bin"}, {"thigh", "0.0603"}, {"gain", "4000"}}));
  EXPECT_EQ(with_device_options(back.device_options, "omega", {{"gain", "4000"}}),
            (Options{{"gain", "4000"}}));

  // Two of a driver, each by what it is asked for with; what is said of the driver is of both.
  write(
      "[device.dhd]\ncap = 4\naxes = 'yzx'\n\n[device.\"dhd:12\"]\ncap = 6\n\n[tuned.dhd]\nstiffness = "
      "900\n\n"
      "[tuned.\"dhd:12\"]\nstiffness = 700\n\n[interaction]\narm_rotation = [0.6, 0, 0.8, 0]\n"
      "arm_middle = [1, 2, 3]\n");
  const WorkbenchGeometry two = read_workbench(path_);
  EXPECT_EQ(with_device_options(two.device_options, "dhd:12", {{"serial", "12"}}),
            (Options{{"cap", "6"}, {"axes", "yzx"}, {"serial", "12"}}));
  EXPECT_EQ(with_device_options(two.device_options, "dhd:13", {{"serial", "13"}}),
            (Options{{"axes", "yzx"}, {"cap", "4"}, {"serial", "13"}}));
  EXPECT_EQ(find_tuned(two.tuned, "dhd:12")->stiffness, 700.0);
  EXPECT_EQ(find_tuned(two.tuned, "dhd:13")->stiffness, 900.0);
  EXPECT_EQ(find_tuned(back.tuned, "simulated:falcon"), nullptr);
  EXPECT_EQ(two.interaction.arm_rotation, (Quat{0.6, 0.0, 0.8, 0.0}));
  EXPECT_EQ(two.interaction.arm_middle, Vec3(1.0, 2.0, 3.0));
}

TEST_F(WorkbenchFileTest, RefusesDevicesThatMakeNoSense) {
  const auto names = [this](const std::string& content, const char* line, const char* word) {
    const std::string said = refusal(content);
    EXPECT_NE(said.find(line), std::string::npos) << said;
    EXPECT_NE(said.find(word), std::string::npos) << said;
  };
  names("[device]\ngain = 3\n", "line 2", "[device.NAME]");
  names("device = 3\n", "line 1", "[device.NAME]");
  names("[device.falcon]\ngain = [1, 2]\n", "line 2", "option of the driver");
  names("[tuned.falcon]\nrate = 1000\n", "line 1", "stiffness");
  names("[tuned.falcon]\nstiffness = -3\n", "line 2", "above zero");
  names("[tuned.falcon]\nstiffness = 3\nplaces = [[1, 2, 3]]\n", "line 3", "4 numbers");
  names("[tuned.falcon]\nstiff = 3\n", "line 2", "stiffness");
}

TEST_F(WorkbenchFileTest, NamesTheLineOfWhatIsWrong) {
  EXPECT_NE(refusal("[stylus]\ntip = [1, 2\n").find("line"), std::string::npos);
  const std::string unknown = refusal("a = 1\n[stylus]\ntop = [1, 2, 3]\n");
  EXPECT_NE(unknown.find("line 3"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("tip"), std::string::npos) << unknown;
  EXPECT_NE(refusal("\n[eyes]\nleft = [1, 2, inf]\n").find("line 3"), std::string::npos);
  EXPECT_NE(
      refusal("[tracker]\ndegree = 2\ncenter = [0,0,0]\nscale = 1\nposition = [[1,2,3]]\norientation = []\n")
          .find("line 5"),
      std::string::npos);
  EXPECT_NE(refusal("[arm]\nrows = [[1,2,3,4,5,1]]\nfree = ['delta']\n").find("delta"), std::string::npos);
  EXPECT_NE(refusal("[coregistration]\nrotation = [2,0,0,0]\ntranslation = [0,0,0]\nsensor = [0,0,0]\n")
                .find("length 2"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
