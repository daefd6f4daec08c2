#include "common/render/tract/tract_pass.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>

#include "common/base/clock.h"
#include "common/render/tract/tract_room.h"

namespace palpate {
namespace {

// Points that no picture shows are left out on the way to the GPU [scene frame, whose longest side is about
// one]: a twentieth of a pixel of a picture of the whole.
constexpr double kThinning = 5e-5;

}  // namespace

void TractPass::update(const TractView& view, const SceneFrame& frame) {
  const bool same_frame = frame.center == frame_.center && frame.exponent == frame_.exponent;
  if (bundle_ == view.bundle && same_frame) return;
  bundle_ = view.bundle;
  frame_ = frame;
  sets_.clear();
  sets_.resize(pieces_with_room(*bundle_));
}

std::size_t TractPass::draw(LineProgram& program, const TractView& view, const LineDraw& base, float unit,
                            std::size_t first, double milliseconds) {
  const Stopwatch watch;
  program.use(ColorMap::kSequential);
  LineDraw how = base;
  how.coloring = LineDraw::Coloring::kDirection;
  how.width = static_cast<float>(view.width) * unit;
  how.min_width = 1.0F;
  how.fading = view.depth_cue ? 1.0F : 0.0F;
  how.screened = true;
  how.opacity = static_cast<float>(std::clamp(view.opacity, 0.0, 1.0));
  std::size_t piece = first;
  while (piece < sets_.size()) {
    std::unique_ptr<LineSet>& set = sets_[piece];
    if (!set) {
      set = std::make_unique<LineSet>();
      set->set_geometry(piece_geometry(*bundle_, piece, frame_, kThinning));
    }
    how.screen = static_cast<int>(piece);
    set->draw(how);
    ++piece;
    if (!std::isfinite(milliseconds)) continue;
    // The driver takes calls faster than it draws: without waiting there is nothing to measure.
    glFinish();
    // Ends where the next piece would end too late, as those so far let one expect.
    const auto drawn = static_cast<double>(piece - first);
    if (1e3 * watch.seconds() * (drawn + 1.0) / drawn > milliseconds) break;
  }
  return piece;
}

}  // namespace palpate
