/// The tracts of a scene, added to its picture bit by bit where there is no time for all of them at once.
#pragma once

#include <functional>
#include <memory>

#include "common/render/camera.h"
#include "common/render/line/line_pass.h"
#include "common/render/scene_view.h"
#include "common/render/tract/tract_pass.h"
#include "common/render/tract/tract_progress.h"

namespace palpate {

/// Needs the OpenGL context current in which it was made, and the frame's uniform block bound to 0.
class GrowingTracts {
 public:
  /// Begins anew, with the tracts of another view.
  /// @param milliseconds that the first picture may spend on them. @return whether there are any.
  bool begin(const SceneView& view, const SceneFrame& frame, double milliseconds);
  /// As TractProgress::begins_anew().
  [[nodiscard]] bool begins_anew() noexcept { return progress_.begins_anew(); }
  /// Draws from where the picture has got to, as TractPass::draw(), over the framebuffer that is bound.
  /// @param base how lines of this picture are drawn. @param unit pixels a thousandth of its height.
  void draw(const SceneView& view, const LineDraw& base, float unit, double milliseconds,
            const std::function<bool()>& stop);

  /// Whether what has grown unseen since show() last said so is worth showing: at first, and then where drawing
  /// it took as long as what has to be drawn over it.
  /// @param over what that takes [ms].
  [[nodiscard]] bool show(bool first, double over) noexcept;
  /// Whether all are shown that there is room for.
  [[nodiscard]] bool complete() const noexcept { return !pass_ || progress_.complete(); }
  [[nodiscard]] TractShare share() const noexcept;

 private:
  std::unique_ptr<TractPass> pass_;  ///< none where the view has no tracts
  std::shared_ptr<const TractBundle> bundle_;
  TractProgress progress_;
  double drawn_ms_ = 0.0;   ///< of the last picture
  double unseen_ms_ = 0.0;  ///< since show() said so
};

}  // namespace palpate
