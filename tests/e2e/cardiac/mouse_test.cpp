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
#include <vector>

#include <zlib.h>

#include "common/field/analytic/ventricle.h"
#include "common/load/write/write_carp.h"
#include "common/math/vec_text.h"
#include "common/render/camera.h"
#include "tests/e2e/cardiac/heart_mouse.h"
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

class FollowedByMouse : public CardiacMouse {
 protected:
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
      next_frames(5);
    }
    next_frames(10);
    at({.kind = InputKind::kRelease});
    press("Keep line");
    press("Save lines");
    press("Let go");
    press("Clear path");
    save_session_and_picture();
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

    WindowResult again;
    const std::string session = reopened(kept, again);
    EXPECT_EQ(again.document.heart.layer, kept.document.heart.layer);
    ASSERT_TRUE(again.view.probe && again.view.probe->drawn_lines) << again.log;
    if (page.empty() || std::getenv("PALPATE_WRITE_PAGES") == nullptr) return;
    height_ = 720;
    choose_file(session);
    (void)open({}, page);
  }
};

TEST_F(FollowedByMouse, FollowsAFibreOfTheDogsHeart) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  for (const char* name : {"heart.exnode.gz", "heart.exelem.gz"})
    fs::copy_file(nodes.parent_path() / name, folder_.path(name));
  follow_keep_and_save("heart.exnode.gz", 0.45, 0.5, 30.0, 0.5, "cardiac_dog.png");
}

TEST_F(FollowedByMouse, FollowsAFibreOfTheDogsHeartInOneFile) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  std::ofstream(folder_.path("dog.exfile"))
      << unpacked(nodes) << unpacked(nodes.parent_path() / "heart.exelem.gz");
  follow_keep_and_save("dog.exfile", 0.45, 0.5, 30.0, 0.5);
}

TEST_F(FollowedByMouse, FollowsAFibreOfAWaveInOpenCarpsFiles) {
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
    const Vec3 middle = middle_of(cells, c);
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

TEST_F(FollowedByMouse, FollowsAFibreOfAHeartInABath) {
  write_in_bath(folder_.path("bath.pts"));
  follow_keep_and_save("bath.pts", 0.45, 0.5, 15.0, 1.0, "cardiac_bath.png");
}

}  // namespace
}  // namespace palpate::test
