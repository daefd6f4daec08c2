/// Draws a SceneView with OpenGL: into a framebuffer of its own, to be read or shown.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/render/budget/quality_errors.h"
#include "common/render/picture_cache.h"
#include "common/render/scene_view.h"
#include "common/render/tract/tract_progress.h"
#include "common/render/volume/estimate/image_error.h"

namespace palpate {

/// Keeps what it has uploaded while the view's lines, bounds and colouring stay the same, and with a probe
/// in the view also the picture, with its depths, of all that does not move with it: while camera, lines and
/// style stay, only the probe and what hangs on it are drawn, over a copy (local redraw). The order is that
/// of drawing everything, so the picture is the same to the bit. Transparent lines are drawn every time (in
/// a volume as layers of its rays: what lies before them veils them, and they veil what is behind), and
/// the volume, of which a picture of its own may be kept (VolumeView::cache_picture). The probe is in it: what
/// lies before it veils it, and it shines through as through anything nearer.
/// A view with two eyes is drawn once for each, then composed (stereo_pass.h). What stands still is kept for
/// one eye alone, so that each of the two draws all of it, tracts without a limit of time. Needs an
/// OpenGL 4.5 core context, the same at every call and at destruction.
class SceneRenderer {
 public:
  SceneRenderer();
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// @param resolution in (0, 1]: less draws lines with fewer pixels along either edge and enlarges them,
  /// while the mouse moves a scene that is slow to draw; text stays sharp.
  /// @param tract_milliseconds that this picture may spend on tracts. Where they take longer it shows an even
  /// sample of them; the same view again adds more of them (tract_progress.h).
  /// @param stop_tracts where set, asked every few hundredths of a second whether to end that before.
  /// @param stop where set, asked every few hundredths of a second while opaque lines are drawn, or rays cast through a
  /// volume, for one eye, whether to leave this picture.
  /// @return false where it was left: the last one of that size stays, and complete() and what else is told of
  /// a picture mean nothing until the next.
  /// @throws Error (usage) for a size that cannot be drawn.
  bool draw(const SceneView& view, int width, int height, double resolution = 1.0,
            double tract_milliseconds = HUGE_VAL, const std::function<bool()>& stop_tracts = {},
            const std::function<bool()>& stop = {});
  /// From now on lines are drawn with this share of the segments that they have in full quality, in (0, 1]; transparent
  /// ones with all.
  void set_line_detail(double share);
  /// Whether the last picture shows all tracts that there is room for, and all bricks of a volume.
  [[nodiscard]] bool complete() const noexcept;
  /// What the last picture shows of the tracts.
  [[nodiscard]] TractShare tract_share() const noexcept;
  /// As VolumePass, of the last picture.
  [[nodiscard]] std::optional<CoarserVoxels> coarser_voxels() const noexcept;
  [[nodiscard]] BrickShare bricks() const noexcept;
  bool prepare_slabs(std::size_t cut);
  /// Whether the last picture made what that cache holds, which takes longer than the pictures that follow.
  [[nodiscard]] bool made(PictureCache cache) const noexcept;
  /// Whether shaders were compiled since the last call of draw() began: that picture took longer than the ones that
  /// follow.
  [[nodiscard]] bool compiled() const noexcept;
  /// Gives back what that cache holds; the next picture may make it anew.
  void forget(PictureCache cache) noexcept;
  /// From now on pictures keep what estimate_error() and estimate_savings() compare, where they show a
  /// volume: copies of them before and behind it; of two eyes that of the one drawn last.
  void keep_for_error(bool on);
  /// Looks at some pixels of the last picture again (volume/picture_estimates.h), as far as they were kept and
  /// the picture is complete. @return whether more are worth it.
  bool estimate_error();
  /// Of the pixels of the last picture that were looked at; nothing where none were.
  [[nodiscard]] std::optional<ImageError> image_error() const;
  /// Looks at what one more saving would add to that error (volume/saving_estimate.h), likewise.
  /// @return whether there are more.
  bool estimate_savings();
  /// Nothing before all of them were looked at.
  [[nodiscard]] std::optional<QualityErrors> quality_errors() const;
  /// Refines one more part of the volume's picture, for the next ones of the same view to show: as
  /// VolumePass::refine(). @return whether parts are left; never for two eyes, or while the picture lacks
  /// something.
  bool refine(int doublings);
  /// By whom and for which reason the preintegrated tables of the last volume were filled
  /// (TableChoice::text()); empty: none was drawn.
  [[nodiscard]] std::string tables_by() const;
  /// Waits until the picture is drawn. [ms] since the call of draw(), by the clock.
  double finish();
  /// In place of finish(): does not wait, and another renderer may draw meanwhile.
  void leave();
  /// What the last picture that was waited for took, for a frame budget [ms]: by a timer query where those of
  /// the driver hold against the clock (gl/frame_timer.h), else by the clock.
  [[nodiscard]] double gpu_milliseconds() const noexcept;
  [[nodiscard]] bool timed_by_query() const noexcept;
  [[nodiscard]] Image read() const;
  /// Copies the picture to the framebuffer that the window shows, or to another one, `left` and `bottom`
  /// pixels from its lower left corner. One for a window with two buffers is twice as high in another one,
  /// the left eye's on top.
  void show(int left, int bottom, std::uint32_t framebuffer = 0) const;
  /// The range that the colours of the last picture spread over.
  [[nodiscard]] ValueRange range() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
