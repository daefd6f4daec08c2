/// Draws tracts piece by piece, with a limit to the time that a picture takes.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/tract/tract_bundle.h"

namespace palpate {

/// How tracts are drawn into a picture.
struct TractDraw {
  float width = 1.5F;                  ///< [pixels] at the focal point; anywhere a pixel at least
  float fading = 1.0F;                 ///< share of the depth cue
  float dimming = 0.0F;                ///< share of the background at any depth
  float opacity = 1.0F;                ///< below one they are screened, sample by sample
  double tolerance = 0.0;              ///< how far lines may be moved to save points (scene frame)
  std::optional<TractSlab> slab = {};  ///< all that is drawn
};

/// Needs the context current in which it was made, and the frame's uniform block bound to 0.
class TractPass {
 public:
  /// Takes the lines of `bundle`; those of another bundle, or in another frame, are uploaded as they are
  /// drawn.
  void update(const std::shared_ptr<const TractBundle>& bundle, const SceneFrame& frame);
  /// Draws pieces from `first` on up to `last`, one at least, until the next would take longer than
  /// `milliseconds` in all, or `stop`, where it is set and asked several times, says so.
  /// @pre update(), first < last <= pieces(). @return the piece to go on with.
  std::size_t draw(const TractDraw& how, std::size_t first, std::size_t last, double milliseconds,
                   const std::function<bool()>& stop = {});
  /// How many pieces there seems to be time for in `milliseconds`, one at least; all if that is infinite.
  [[nodiscard]] std::size_t pieces_in(double milliseconds) const noexcept;
  /// How many pieces there are to draw. Of bundles that would not fit into memory that is less than all.
  [[nodiscard]] std::size_t pieces() const noexcept { return pieces_.size(); }

 private:
  /// What has been uploaded of a piece.
  struct Piece {
    GlBuffer points;
    GlBuffer colors;  ///< of a bundle that has some
    int vertices = 0;
    double tolerance = -1.0;  ///< of the lines; below zero: nothing has
  };
  void draw_piece(const TractDraw& how, std::size_t number);

  /// Compiled at the first use: opaque, screened, both in a slab, and all of these with colours of their own.
  std::array<GlProgram, 8> programs_;
  GlVertexArray no_vertices_;
  std::shared_ptr<const TractBundle> bundle_;
  SceneFrame frame_;
  std::vector<Piece> pieces_;
  double piece_ms_ = 0.0;  ///< that a piece took, the last time it was measured; 0: not yet
};

}  // namespace palpate
