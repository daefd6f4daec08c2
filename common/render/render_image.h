/// Pictures without a display.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/render/budget/frame_quality.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/scene_view.h"
#include "common/render/volume/estimate/image_error.h"

namespace palpate {

struct RenderedImage {
  Image image;
  double first_frame_ms = 0.0;                  ///< with the upload and the compiling of shaders
  std::vector<double> frame_ms;                 ///< of the repeated frames, by the clock
  FrameQuality quality;                         ///< that the budget left
  std::optional<double> expected_error;         ///< of that, RMS, as FrameBudget::expected_error()
  bool timer_query = false;                     ///< it was held by timer queries, not by the clock
  std::optional<CoarserVoxels> coarser_voxels;  ///< as VolumePass
  BrickShare bricks;                            ///< likewise
  std::optional<ImageError> error;              ///< of the volume's part, where asked for
  std::string tables_by;                        ///< SceneRenderer::tables_by()
  std::string renderer;                         ///< the OpenGL driver
  std::vector<GpuObject> gpu;                   ///< what was compiled and allocated
};

/// Draws `view` off-screen, `repeat` times after the first frame. With a budget [ms] above 0 as a window does
/// while something moves, after it stood still: errors of savings are looked at, then frames settle the
/// quality, before those that are timed. Usable from
/// any one thread; leaves no context current.
/// @param error whether to estimate that of a volume (volume/estimate/image_error.h); in any case where coarser
/// voxels are drawn than were asked for.
/// @throws Error (usage) for a size that cannot be drawn, (work failed) where OpenGL is not available.
[[nodiscard]] RenderedImage render_image(const SceneView& view, int width, int height, int repeat = 0,
                                         double budget = 0.0, bool error = false);

/// Draws one picture after another off-screen; what stays the same from one to the next stays on the graphics card. Used
/// by one thread, on which its context is current while it lives.
class ImageSequence {
 public:
  /// @throws Error (work failed) where OpenGL is not available.
  ImageSequence();
  ~ImageSequence();
  ImageSequence(const ImageSequence&) = delete;
  ImageSequence& operator=(const ImageSequence&) = delete;

  /// @throws Error (usage) for a size that cannot be drawn.
  [[nodiscard]] Image draw(const SceneView& view, int width, int height);
  /// That the last one took [ms].
  [[nodiscard]] double milliseconds() const noexcept;
  [[nodiscard]] const std::string& renderer() const noexcept;  ///< the OpenGL driver

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
