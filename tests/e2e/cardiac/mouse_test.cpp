// Hearts by the mouse alone: from the start page to a fibre that is followed, kept and saved, and back from the session
// to the same picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <stb_image.h>
#include <zlib.h>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cardiac_verbs.h"
#include "common/cli/command_line.h"
#include "common/cli/window_touch.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/field/analytic/ventricle.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/load/write/write_carp.h"
#include "common/math/vec_text.h"
#include "common/render/camera.h"
#include "common/window/panels/panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/project_folders.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

std::string unpacked(const fs::path& file) {
  std::string text;
  gzFile in = gzopen(file.c_str(), "rb");
  std::array<char, 1 << 16> buffer{};
  for (int n = 0; (n = gzread(in, buffer.data(), buffer.size())) > 0;) text.append(buffer.data(), as_size(n));
  gzclose(in);
  return text;
}

class CardiacMouse : public ExplorerTest {
 protected:
  CardiacMouse() : ExplorerTest("cardiac") {}
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    before_ = fs::current_path();
    fs::current_path(folder_.path());  // where the dialog begins
    if (const char* home = std::getenv("HOME")) home_ = home;
    setenv("HOME", folder_.path().c_str(), 1);  // where a session is proposed
  }
  void TearDown() override {
    if (before_.empty()) return;
    fs::current_path(before_);
    setenv("HOME", home_.c_str(), 1);
  }

  /// Runs the script so far, which begins anew. Without a file it begins with the start page.
  /// @param page the picture of docs/guide that PALPATE_WRITE_PAGES makes of it; empty: none.
  WindowResult open(std::vector<std::string> arguments, const std::string& page = {}) {
    arguments.insert(arguments.begin(), "open");
    arguments.insert(arguments.end(), {"--threads", "1"});
    const ParsedCommand parsed = parse_command_line(explorer_, arguments);
    const QuietVerb verb(explorer_);
    const Document& options = parsed.options;
    WindowOptions window{.program = "cardiac",
                         .width = kWidth,
                         .height = height_,
                         .angles = camera_angles(options.view.camera),
                         .focal_point = focal_point_of(options.view),
                         .kind = FieldKind::kFibre,
                         .start_page = options.input.files.empty() && options.input.example.empty(),
                         .session = options.common.session,
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(FieldKind::kFibre), options, verb.context),
                         .panels = cardiac_panels(),
                         .threads = 1,
                         // The servo has the time between two frames that a user would give it.
                         .stop_requested =
                             [] {
                               std::this_thread::sleep_for(std::chrono::milliseconds(8));
                               return false;
                             },
                         .script = std::exchange(script_, {}),
                         .frames = std::exchange(next_, kFirst) + 30,
                         .patience = 60.0,
                         .hidden = true};
    apply_appearance(options, window.view);
    window.screenshot = folder_.path("window.png");
    CardiacModel model(options, "cardiac");
    WindowResult result = run_window(model, window);
    EXPECT_EQ(result.missing, std::vector<std::string>()) << "controls that no panel had";
    if (!page.empty() && std::getenv("PALPATE_WRITE_PAGES") != nullptr)
      fs::copy_file(window.screenshot, source_folder() / "docs" / "guide" / page,
                    fs::copy_options::overwrite_existing);
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      fs::copy_file(window.screenshot,
                    fs::path(folder) / (std::string("cardiac_mouse_") + std::to_string(opened_++) + ".png"),
                    fs::copy_options::overwrite_existing);
    return result;
  }

  void at(InputEvent event, const std::string& control = {}) {
    script_.push_back({.frame = next_ += 3, .event = std::move(event), .control = control});
  }
  void press(const std::string& control) {
    at({.kind = InputKind::kMove}, control);
    at({.kind = InputKind::kPress});
    at({.kind = InputKind::kRelease});
    next_ += 6;
  }
  /// From the start page, or from what is open.
  void choose_file(const std::string& name) {
    press("Open…");
    press(name);
    press("Open");
    next_ += 30;
  }
  [[nodiscard]] PictureArea area() const {
    constexpr float kLetterHeight = 14.0F;
    return layout(kWidth, height_, kLetterHeight).picture;
  }
  /// Takes the probe at a place of the picture, from its upper left corner to the lower right one.
  void grab_at(double across, double down) {
    press("mode");
    press("fibre");
    press("Grab");
    at({.kind = InputKind::kMove,
        .x = area().left + across * area().width,
        .y = area().top + down * area().height});
    at({.kind = InputKind::kPress});
    next_ += 20;
  }

  /// The fibre through a place on a layer, by `trace`.
  std::vector<Vec3> traced(const std::vector<std::string>& heart, const Vec3& seed, double depth,
                           double length) {
    std::vector<std::string> words{"trace"};
    words.insert(words.end(), heart.begin(), heart.end());
    words.insert(words.end(),
                 {"--layer", exact_number(depth), "--seeds", "point:" + exact_text(seed), "--max-length",
                  exact_number(length), "--direction", "forward", "--force", "--out", "fibre.csv"});
    (void)json(words);
    return places("fibre.csv", 3);
  }
  /// Three columns of a table.
  std::vector<Vec3> places(const std::string& file, std::size_t first) const {
    std::vector<Vec3> found;
    std::istringstream rows(read_file(folder_.path(file)));
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
      std::istringstream fields(row);
      std::vector<double> numbers;
      for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::atof(field.c_str()));
      if (numbers.size() > first + 2)
        found.emplace_back(numbers[first], numbers[first + 1], numbers[first + 2]);
    }
    return found;
  }
  [[nodiscard]] Image picture(const std::string& name) const {
    Image image;
    unsigned char* pixels = stbi_load(folder_.path(name).c_str(), &image.width, &image.height, nullptr, 4);
    EXPECT_NE(pixels, nullptr) << name;
    if (pixels != nullptr) image.rgba.assign(pixels, pixels + 4L * image.width * image.height);
    stbi_image_free(pixels);
    return image;
  }
  static double apart(const Vec3& x, const std::vector<Vec3>& line) {
    double nearest = HUGE_VAL;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec3 along = line[i] - line[i - 1];
      const double square = glm::dot(along, along);
      const double part =
          square > 0.0 ? std::clamp(glm::dot(x - line[i - 1], along) / square, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, glm::distance(x, line[i - 1] + part * along));
    }
    return nearest;
  }

  /// The whole way with one heart. @param heart as it is named on the command line. @param length of the fibre, and
  /// @param off how far what is felt may lie from it, in the data's unit.
  void follow_keep_and_save(const std::string& file, double across, double down, double length, double off,
                            const std::string& page = {}) {
    const std::vector<std::string> heart{file};
    choose_file(file);
    grab_at(across, down);
    const WindowResult start = open({});
    ASSERT_EQ(start.document.input.files.size(), 1U);
    EXPECT_EQ(start.document.input.files.front().filename(), file);
    ASSERT_TRUE(start.probe.held) << start.log;
    ASSERT_EQ(start.probe.state, HoldState::kHeld) << start.log;
    const double depth = std::atof(start.document.heart.layer.c_str());
    const std::vector<Vec3> fibre = traced(heart, start.probe.proxy, depth, length);
    ASSERT_GT(fibre.size(), 10U);

    choose_file(file);
    grab_at(across, down);
    constexpr int kSteps = 24;
    for (std::size_t n = 1; n <= kSteps; ++n) {
      const Vec3 shown = project(start.view.camera, fibre[(fibre.size() - 1) * n / kSteps],
                                 static_cast<int>(area().width), static_cast<int>(area().height));
      at({.kind = InputKind::kMove, .x = area().left + shown.x, .y = area().top + shown.y});
      next_ += 5;
    }
    next_ += 10;
    at({.kind = InputKind::kRelease});
    press("Keep line");
    press("Save lines");
    press("Let go");
    press("Clear path");
    press("Save session");
    press("Save");
    press("Save picture");
    const WindowResult kept = open({});
    EXPECT_NE(kept.log.find("kept line 1"), std::string::npos) << kept.log;
    ASSERT_TRUE(kept.view.probe && kept.view.probe->drawn_lines) << kept.log;
    EXPECT_EQ(kept.view.probe->drawn_lines->size(), 1U);
    EXPECT_NE(read_file(folder_.path("followed.vtp")).find("\"force\""), std::string::npos) << kept.log;
    const std::vector<LinePoint>& line = kept.view.probe->drawn_lines->front().line->points;
    ASSERT_GT(line.size(), 10U);
    EXPECT_GT(line.back().arc, 0.8 * length);
    double farthest = 0.0;
    for (const LinePoint& point : line) farthest = std::max(farthest, apart(point.position, fibre));
    EXPECT_LT(farthest, off);
    RecordProperty("farthest from the fibre", std::to_string(farthest));

    std::string session, first;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".palpate.toml")) session = name;
      if (name.starts_with("cardiac-") && name.ends_with(".png")) first = name;
    }
    ASSERT_FALSE(session.empty()) << kept.log;
    ASSERT_FALSE(first.empty()) << kept.log;
    fs::rename(folder_.path(first), folder_.path("first.png"));
    choose_file(session);
    press("Save picture");
    const WindowResult again = open({});
    EXPECT_EQ(again.document.heart.layer, kept.document.heart.layer);
    ASSERT_TRUE(again.view.probe && again.view.probe->drawn_lines) << again.log;
    const Image a = picture("first.png"), b = picture(first);
    ASSERT_EQ(a.rgba.size(), b.rgba.size());
    int worst = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) worst = std::max(worst, std::abs(a.rgba[i] - b.rgba[i]));
    EXPECT_LE(worst, 1) << "of 255, a session later";
    if (page.empty() || std::getenv("PALPATE_WRITE_PAGES") == nullptr) return;
    height_ = 720;
    choose_file(session);
    (void)open({}, page);
  }

  static constexpr int kWidth = 1000, kFirst = 30;
  int height_ = 900;

 private:
  const Explorer explorer_{.name = "cardiac", .kind = FieldKind::kFibre, .verbs = {open_heart_verb({})}};
  std::vector<ScriptedEvent> script_;
  int next_ = kFirst, opened_ = 0;
  fs::path before_;
  std::string home_;
};

TEST_F(CardiacMouse, FollowsAFibreOfTheDogsHeart) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  for (const char* name : {"heart.exnode.gz", "heart.exelem.gz"})
    fs::copy_file(nodes.parent_path() / name, folder_.path(name));
  follow_keep_and_save("heart.exnode.gz", 0.45, 0.5, 30.0, 0.5, "cardiac_dog.png");
}

TEST_F(CardiacMouse, FollowsAFibreOfTheDogsHeartInOneFile) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  std::ofstream(folder_.path("dog.exfile"))
      << unpacked(nodes) << unpacked(nodes.parent_path() / "heart.exelem.gz");
  follow_keep_and_save("dog.exfile", 0.45, 0.5, 30.0, 0.5);
}

TEST_F(CardiacMouse, FollowsAFibreOfAWaveInOpenCarpsFiles) {
  (void)json({"convert", "--example", "wave", "--out", "wave.pts"});
  follow_keep_and_save("wave.pts", 0.45, 0.5, 15.0, 0.5, "cardiac_wave.png");
}

/// The ventricle in a bath, whose elements are of region 0 and have no fibre.
void write_in_bath(const fs::path& file) {
  const Ventricle heart, with_bath{.lambda_outer = 0.9};
  constexpr VentricleCells kCells{.wall = 8, .along = 20, .around = 48};  // six of the wall, two of the bath
  const DataSet mesh = ventricle_mesh(with_bath, kCells);
  const auto& cells = std::get<UnstructuredTopology>(mesh.topology);
  std::vector<Vec3> fibres;
  std::vector<int> regions;
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    Vec3 middle{0.0};
    const std::int64_t first = cells.offsets[c], end = cells.offsets[c + 1];
    for (std::int64_t i = first; i < end; ++i)
      for (int axis = 0; axis < 3; ++axis)
        middle[axis] += cells.positions.at(as_size(cells.connectivity[as_size(i)]), axis) /
                        static_cast<double>(end - first);
    const Prolate at = heart.coordinates(middle);
    const bool bath = at.lambda > heart.lambda_outer;
    regions.push_back(bath ? 0 : 1);
    fibres.push_back(bath ? Vec3{0.0} : heart.fibre(at));
  }
  CarpOutput out(file, false, true);
  out.write_mesh(cells, 1000.0, regions);
  out.write_directions(fibres, {});
  out.finish();
}

TEST_F(CardiacMouse, FollowsAFibreOfAHeartInABath) {
  write_in_bath(folder_.path("bath.pts"));
  follow_keep_and_save("bath.pts", 0.45, 0.5, 15.0, 1.0, "cardiac_bath.png");
}

}  // namespace
}  // namespace palpate::test
