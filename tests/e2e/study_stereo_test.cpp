// What each eye sees of a session of an experiment, where it has a half of the window.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "tests/e2e/study_session.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// A picture of a session as it was photographed.
struct Picture {
  explicit Picture(const fs::path& file) {
    int channels = 0;
    unsigned char* data = stbi_load(file.c_str(), &width, &height, &channels, 3);
    if (data == nullptr) return;
    pixels.assign(data, data + std::ptrdiff_t{3} * width * height);
    stbi_image_free(data);
  }
  [[nodiscard]] std::array<int, 3> at(int x, int y) const {
    const auto i = static_cast<std::size_t>(3 * (y * width + x));
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }

  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

bool far_apart(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  constexpr int kRounding = 24;
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > kRounding;
}

TEST(StudyWindow, GivesEachEyeAWholePictureAndAllOfTheText) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  ASSERT_TRUE(MouseAndKeys::is_there()) << "xdotool is missing: scripts/packages.sh names it";
  TempFolder temporary;
  StudyPlan plan = session_plan();
  plan.tasks = {"tracing2d", "tracing3d"};
  plan.design.tasks = 2;
  const StudyFolder folder = StudyFolder::make(temporary.path("s"), plan, {}, false);
  fs::create_directory(temporary.path("pictures"));
  const StudyTasks tasks = prepared_tasks(plan);
  SessionGuard session(start_session(folder.path(), {.tasks = tasks,
                                                     .hands = Hands(),
                                                     .pictures = temporary.path("pictures"),
                                                     .stereo = StereoMode::kSideBySide}));
  const std::optional<int> status = outcome_of(session);
  ASSERT_TRUE(status && WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 0) << "the form was filled in, in a half of the window";
  for (const std::string name : {"screen1", "screen5", "tracing2d", "tracing3d"}) {
    const Picture picture(temporary.path("pictures/study_" + name + ".png"));
    ASSERT_GT(picture.width, 0) << name;
    const int half = picture.width / 2;
    long differ = 0, red[2]{}, dark_at_edge = 0;
    const std::array<int, 3> ground = picture.at(half / 2, 2);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < half; ++x) {
        const std::array<int, 3> eyes[]{picture.at(x, y), picture.at(half + x, y)};
        if (far_apart(eyes[0], eyes[1])) ++differ;
        for (int eye = 0; eye < 2; ++eye) {
          const auto& [r, g, b] = eyes[eye];
          if (r > g + 80 && r > b + 80) ++red[eye];
          if ((x == 0 || x == half - 1) && far_apart(eyes[eye], ground)) ++dark_at_edge;
        }
      }
    }
    if (name == "tracing3d") {
      EXPECT_GT(differ, 100) << "both eyes see it from places of their own";
    } else {
      EXPECT_LT(differ, 20) << name << ": both halves hold the same, but for rounding at edges of letters";
    }
    EXPECT_EQ(dark_at_edge, 0) << name << ": nothing is cut off at the sides of a half";
    if (!name.starts_with("tracing")) continue;
    EXPECT_GT(red[0], 50) << name;
    EXPECT_NEAR(red[0], red[1], 0.2 * static_cast<double>(red[0])) << name << ": the whole path for each";
  }
}

}  // namespace
}  // namespace palpate::test
