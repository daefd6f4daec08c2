/// Bundles of tracts in dtmri's window: the folder in which they are saved, and what a run has left of them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "common/render/camera.h"
#include "tests/e2e/dtmri_window.h"

namespace palpate::test {

class BundlesWindow : public DtmriWindow {
 protected:
  void SetUp() override {
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());  // files are saved where the program runs
  }
  void TearDown() override { std::filesystem::current_path(before_); }

  static const std::vector<std::string>& bundles(const WindowResult& result) {
    return result.document.tract_appearance.bundles;
  }
  static std::size_t shown(const WindowResult& result) {
    return result.view.tracts ? result.view.tracts->bundle->order.size() : 0;
  }
  /// Where the window shows `x` as `result` left its camera [pixels].
  [[nodiscard]] Vec3 pixel_of(const WindowResult& result, const Vec3& x) const {
    constexpr float kLetterHeight = 14.0F;  // [pixels] of the panel
    const PictureArea area = layout(width_, height_, kLetterHeight).picture;
    const Vec3 at =
        project(result.view.camera, x, static_cast<int>(area.width), static_cast<int>(area.height));
    return {area.left + at.x, area.top + at.y, at.z};
  }

  static constexpr int kKeyS = 'S', kKeyZ = 'Z';

 private:
  std::filesystem::path before_;
};

}  // namespace palpate::test
