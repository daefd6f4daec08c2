// Settings that make a picture make the same one from a session, in each program: what is drawn depends on the
// document alone.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <stb_image.h>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

class Sessions : public ExplorerTest {
 protected:
  explicit Sessions(const std::string& program) : ExplorerTest(program), program_(program) {}

  /// Bytes of a picture that is made of `example`, with more words of the command line.
  std::vector<unsigned char> picture(const std::string& name, const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"render", "--size", "96x72", "--out", name};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const ProgramResult made = run(arguments);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    int width = 0, height = 0;
    unsigned char* const data = stbi_load(folder_.path(name).c_str(), &width, &height, nullptr, 3);
    if (data == nullptr) return {};
    std::vector<unsigned char> bytes(data, data + 3 * width * height);
    stbi_image_free(data);
    return bytes;
  }

  /// The session of a program, of some format.
  std::string session(const std::string& example, const Settings& settings, int format = 1) {
    std::string text = "format = " + std::to_string(format) + "\nprogram = \"" + program_ +
                       "\"\n[scene]\nexample = '" + example + "'\n";
    for (const auto& [name, value] : settings) text += name + " = '" + value + "'\n";
    return folder_.write("s.toml", text).string();
  }

  void expect_same_picture(const std::string& example, const Settings& settings) {
    std::vector<std::string> options{"--example", example};
    for (const auto& [name, value] : settings) options.push_back("--" + name + "=" + value);
    const auto by_options = picture("options.png", options);
    const auto by_session = picture("session.png", {"--session", session(example, settings)});
    const auto as_file = picture("file.png", {session(example, settings)});
    const auto without = picture("plain.png", {"--example", example});
    ASSERT_FALSE(by_options.empty());
    ASSERT_EQ(by_options.size(), by_session.size());
    EXPECT_EQ(as_file, by_session) << "a session opens like a file";
    int worst = 0, change = 0;
    for (std::size_t i = 0; i < by_options.size(); ++i) {
      worst = std::max(worst, std::abs(by_options[i] - by_session[i]));
      change = std::max(change, std::abs(by_options[i] - without[i]));
    }
    EXPECT_LE(worst, 1) << "[1/255]";
    EXPECT_GT(change, 100) << "or it would not matter what a session says";
  }

 private:
  std::string program_;
};

class FlowSessions : public Sessions {
 protected:
  FlowSessions() : Sessions("flow") {}
};

TEST_F(FlowSessions, DrawWhatTheirOptionsDraw) {
  expect_same_picture("abc", {{"seeds", "random:20"},    {"seed", "3"},
                              {"color", "time"},         {"color-map", "heat"},
                              {"range", "0.125,3"},      {"log-colors", "on"},
                              {"background", "1,1,1"},   {"outline", "off"},
                              {"axes", "off"},           {"line-width", "9"},
                              {"line-opacity", "0.7"},   {"halos", "off"},
                              {"depth-cue", "off"},      {"camera", "20,30,5,1.3"},
                              {"focal", "3,3,3"},        {"projection", "orthographic"},
                              {"volume", "speed"},       {"resample", "12"},
                              {"samples", "2"},          {"shading", "off"},
                              {"lens", "sphere:3,3,3,1"}});
}

// A picture in which nothing but the lines is left.
TEST_F(FlowSessions, LeaveOutWhatIsNotToBeShown) {
  expect_same_picture("abc", {{"seeds", "random:5"},
                              {"volume", "speed"},
                              {"resample", "8"},
                              {"show-volume", "off"},
                              {"background", "light"},
                              {"outline", "off"},
                              {"axes", "off"},
                              {"color-bar", "off"}});
}

TEST_F(FlowSessions, OfANewerVersionOpenWithAWordOnEachThingThatIsNotKnown) {
  const std::string newer = session("abc", {{"sheen", "0.5"}, {"background", "light"}}, 7);
  const ProgramResult told = run({"render", "--session", newer, "--size", "32x24", "--out", "a.png"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_NE(told.err.find("newer version"), std::string::npos) << told.err;
  EXPECT_NE(told.err.find("'sheen' is left out"), std::string::npos) << told.err;
  const ProgramResult refused =
      run({"render", "--session", session("abc", {{"sheen", "0.5"}}), "--out", "b.png"});
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
}

class GridSessions : public Sessions {
 protected:
  GridSessions() : Sessions("grid") {}
};

TEST_F(GridSessions, DrawWhatTheirOptionsDraw) {
  expect_same_picture("shells", {{"background", "0.9,0.95,1"},
                                 {"outline", "off"},
                                 {"axes", "off"},
                                 {"color-bar", "off"},
                                 {"camera", "20,30,5,1.3"},
                                 {"transfer-function", "mr"},
                                 {"lens", "sphere:0.5,0,0,0.3"},
                                 {"clip", "0,0,1,0.3"},
                                 {"plane-image", "on"},
                                 {"window", "0.5"},
                                 {"level", "0.4"},
                                 {"contours", "0.5"},
                                 {"samples", "2"},
                                 {"far-sampling", "2"},
                                 {"shading", "off"},
                                 {"context-level", "1"},
                                 {"projection", "orthographic"}});
}

class DtmriSessions : public Sessions {
 protected:
  DtmriSessions() : Sessions("dtmri") {}
};

TEST_F(DtmriSessions, DrawWhatTheirOptionsDraw) {
  expect_same_picture("helix", {{"background", "light"},
                                {"outline", "off"},
                                {"axes", "off"},
                                {"color", "fa"},
                                {"glyphs", "superquadric"},
                                {"glyph-fa", "0.3"},
                                {"glyph-spacing", "60"},
                                {"voxels", "linear"},
                                {"crosshair", "off"},
                                {"volume", "direction"},
                                {"samples", "1"},
                                {"camera", "20,30,5,1.3"}});
}

class CardiacSessions : public Sessions {
 protected:
  CardiacSessions() : Sessions("cardiac") {}
};

TEST_F(CardiacSessions, DrawWhatTheirOptionsDraw) {
  expect_same_picture("ventricle", {{"layer", "0.25"},
                                    {"seeds", "random:40"},
                                    {"angle", "transverse"},
                                    {"color-map", "heat"},
                                    {"range", "-40,40"},
                                    {"line-width", "8"},
                                    {"line-opacity", "0.7"},
                                    {"halos", "on"},
                                    {"depth-cue", "off"},
                                    {"background", "light"},
                                    {"axes", "off"},
                                    {"outline", "off"},
                                    {"contour-spacing", "10"},
                                    {"cut", "0,1,0,0"},
                                    {"camera", "20,30,5,1.3"}});
}

}  // namespace
}  // namespace palpate::test
