// Slices of tensors side by side, by command line and in the window: what they show, which tracts lie over them, regions
// that trace them, and the cone of the main direction.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <stb_image.h>

#include "common/window/window.h"
#include "tests/e2e/dtmri_window.h"

namespace palpate::test {
namespace {

class DtmriPanes : public DtmriWindow {
 protected:
  Image picture_of(std::vector<std::string> arguments) {
    for (const char* word : {"--size", "402x302", "--out", "p.png", "--force"}) arguments.emplace_back(word);
    (void)json(std::move(arguments));
    Image image;
    unsigned char* const pixels =
        stbi_load(folder_.path("p.png").c_str(), &image.width, &image.height, nullptr, 4);
    if (pixels == nullptr) return image;
    image.rgba.assign(pixels, pixels + std::ptrdiff_t{4} * image.width * image.height);
    stbi_image_free(pixels);
    return image;
  }
  /// Of the axial pane, pixels that differ.
  static int differing(const Image& a, const Image& b) {
    int count = 0;
    for (int y = 20; y < 148; ++y) {
      for (int x = 2; x < 198; ++x) count += a.pixel(x, y) != b.pixel(x, y) ? 1 : 0;
    }
    return count;
  }
  /// Of the axial pane, pixels that are no grey.
  static int colored(const Image& image) {
    int count = 0;
    for (int y = 20; y < 148; ++y) {
      for (int x = 2; x < 198; ++x) {
        const auto p = image.pixel(x, y);
        count += std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 40 ? 1 : 0;
      }
    }
    return count;
  }
};

TEST_F(DtmriPanes, SlicesShowDirectionsOrAnisotropyAndTractsWithinTheirSlab) {
  const std::vector<std::string> plain{"slice", "--example", "helix"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = plain;
    all.insert(all.end(), more.begin(), more.end());
    return picture_of(all);
  };
  const Image directions = with({}), anisotropy = with({"--slice-show", "fa"});
  ASSERT_EQ(directions.width, 402);
  EXPECT_GT(colored(directions), 300);
  EXPECT_LT(colored(anisotropy), colored(directions) / 4) << "grey but for the lines of other planes";
  const std::vector<std::string> traced{"--slice-show", "fa", "--seeds", "fa:0.5"};
  const auto slab = [&](const std::string& thickness) {
    std::vector<std::string> all = traced;
    all.insert(all.end(), {"--tract-slab", thickness});
    return with(all);
  };
  const int none = differing(slab("0"), anisotropy), thin = differing(slab("4"), anisotropy),
            thick = differing(slab("1000"), anisotropy);
  EXPECT_EQ(none, 0);
  EXPECT_GT(thin, 50);
  EXPECT_GT(thick, 2 * thin);
  const ProgramResult refused = run({"slice", "--example", "helix", "--layout", "1", "--out", "x.png"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--layout 2 or 4"), std::string::npos) << refused.err;
  const ProgramResult missing =
      run({"slice", "--example", "helix", "--slice-show", "underlay", "--size", "40x30", "--out", "u.png"});
  EXPECT_NE(missing.err.find("no underlay of this image"), std::string::npos) << missing.err;
}

TEST_F(DtmriPanes, BoxesAndHalfSpacesTraceAsTheySay) {
  const auto lines = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"trace", "--example", "helix", "--seeds", "fa:0.6"};
    all.insert(all.end(), more.begin(), more.end());
    return json(all)["lines"].get<int>();
  };
  const int all = lines({}), inside = lines({"--include", "box:-1000,-1000,-1000,1000,1000,1000"});
  EXPECT_EQ(inside, all);
  EXPECT_EQ(lines({"--exclude", "beyond:0,0,1,1000"}), all);
  // Every helix of radius 20 winds through it.
  const ProgramResult none =
      run({"trace", "--example", "helix", "--seeds", "fa:0.6", "--exclude", "beyond:1,0,0,15", "--json"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("that enter an --exclude region"), std::string::npos) << none.err;
  EXPECT_GT(json({"trace", "--example", "helix", "--seeds", "box:-25,-25,-5,25,25,5"})["seeds"].get<int>(),
            10);
  EXPECT_EQ(run({"trace", "--example", "helix", "--seeds", "fa:0.6", "--max-cone", "10", "--json"}).exit_code,
            2)
      << "tensors that were not fitted have no cone";
}

TEST_F(DtmriPanes, ARegionIsAddedUndoneAndSavedByTheMouse) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  constexpr int kKeyS = 'S', kKeyZ = 'Z';
  key(kKeyS);
  key(kKeyS);
  press("Ball");
  press("Box");
  key(kKeyZ, kModifierControl);
  key(kKeyS, kModifierControl);
  (void)open({"open", "--example", "helix"});
  const std::string saved = session();
  EXPECT_NE(saved.find("layout = '4'"), std::string::npos) << saved;
  EXPECT_NE(saved.find("sphere:"), std::string::npos) << saved;
  EXPECT_EQ(saved.find("box:"), std::string::npos) << "undone";
}

}  // namespace
}  // namespace palpate::test
