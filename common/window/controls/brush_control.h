/// A round brush that paints a region on slices: while it is on, a left drag over a slice leaves balls along its way.
/// Plain arithmetic, no window.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "common/window/input_event.h"

namespace palpate {

class BrushControl {
 public:
  bool on = false;      ///< chosen in the panel
  double radius = 1.0;  ///< of the balls [data units], > 0

  /// @param place under the mouse on a slice; none beside all slices. @return whether the event was for the brush.
  bool handle(const InputEvent& event, const std::optional<Vec3>& place);
  /// Centres of the balls so far, data coordinates; empty where nothing is being painted.
  [[nodiscard]] const std::vector<Vec3>& stroke() const noexcept { return stroke_; }
  [[nodiscard]] bool painting() const noexcept { return painting_; }
  /// The stroke that has ended, once; empty: none has.
  [[nodiscard]] std::vector<Vec3> take_stroke() {
    return painting_ ? std::vector<Vec3>() : std::exchange(stroke_, {});
  }
  void let_go() noexcept { painting_ = false; }

 private:
  std::vector<Vec3> stroke_;
  bool painting_ = false;
};

}  // namespace palpate
