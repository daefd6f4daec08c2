/// Pictures of a volume alone, as the numbers that the shader computes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/render/camera.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

/// Associated colour and opacity of a pixel.
using Rgba = std::array<double, 4>;

/// `rgba` has 4 * width * height numbers, rows from the bottom.
struct FloatImage {
  int width = 0;
  int height = 0;
  std::vector<float> rgba;

  [[nodiscard]] Rgba at(int x, int y) const;
};

/// Owns a framebuffer of single precision, cleared to nothing, and a context for it unless one is current
/// already.
class VolumePicture {
 public:
  enum class Context : std::uint8_t { kOwn, kCurrent };
  VolumePicture(int width, int height, Context context = Context::kOwn);
  ~VolumePicture();

  /// @param opaque_depth where not empty: a number of [0, 1] for each pixel, as a depth buffer holds.
  [[nodiscard]] FloatImage draw(const VolumeView& view, const Camera& camera,
                                const std::vector<float>& opaque_depth = {});
  /// Draws and waits for it, without reading it. [ms], by the clock.
  double draw_alone(const VolumeView& view, const Camera& camera);
  /// Draws again what was drawn last and waits for it. [ms], by the clock.
  double draw_again();
  /// As VolumePass, after one of the above. Waits for what is drawn.
  bool prepare_slabs(std::size_t cut);
  [[nodiscard]] BrickShare bricks() const;
  [[nodiscard]] VolumePass::Cost cost() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The frame that pictures of `view` use.
[[nodiscard]] SceneFrame frame_of(const VolumeView& view);

/// The largest difference of any component of any pixel.
[[nodiscard]] double worst_difference(const FloatImage& a, const FloatImage& b);

}  // namespace palpate
