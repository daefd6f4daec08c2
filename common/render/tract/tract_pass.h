/// Draws tracts piece by piece, with a limit to the time that a picture takes.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "common/render/camera.h"
#include "common/render/line/line_pass.h"
#include "common/render/tract/tract_view.h"

namespace palpate {

/// Needs the context current in which it was made, and the frame's uniform block bound to 0.
class TractPass {
 public:
  /// Takes the lines of `view`; those of another bundle, or in another frame, are uploaded as they are drawn.
  void update(const TractView& view, const SceneFrame& frame);
  /// Draws pieces from `first` on, one at least, until the next would take longer than `milliseconds` in all,
  /// or all are drawn.
  /// @param base tolerance of lines in the scene. @param unit pixels in a thousandth of the picture's height.
  /// @pre update(). @return the piece to go on with; pieces() when all are drawn.
  std::size_t draw(LineProgram& program, const TractView& view, const LineDraw& base, float unit,
                   std::size_t first, double milliseconds);
  /// How many pieces there are to draw. Of bundles that would not fit into memory that is less than all.
  [[nodiscard]] std::size_t pieces() const noexcept { return sets_.size(); }

 private:
  std::shared_ptr<const TractBundle> bundle_;
  SceneFrame frame_;
  std::vector<std::unique_ptr<LineSet>> sets_;  ///< null until first drawn
};

}  // namespace palpate
