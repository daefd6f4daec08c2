/// The spheres, arrows and tensor glyphs that stand for a ProbeView: pure arithmetic, no OpenGL.
#pragma once

#include <vector>

#include "common/render/camera.h"
#include "common/render/glyph/glyph_pass.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_glyphs.h"

namespace palpate {

struct ProbeGlyphs {
  std::vector<SphereInstance> spheres;
  std::vector<ArrowInstance> arrows;
  std::vector<TensorGlyph> tensors;
};

/// With s a thousandth of the picture's height at the focal point, d = |proxy - probe| / s the stretch,
/// w and r ProbeStyle::band_width and band_rest, and l ProbeStyle::arrow_length:
///   width of the band     w s / sqrt(1 + d / r)      an elastic band keeps its volume
///   length of the arrow   l s min(|v| / v_ref, 3)
/// What is not finite is left out. A tensor whose largest eigenvalue is above zero takes the place of the
/// proxy's sphere; its glyph is that of the slices, or where these have none a superquadric.
/// @param range of the colours of the followed line's balls.
/// @pre view.probe.
[[nodiscard]] ProbeGlyphs make_probe_glyphs(const SceneView& view, const SceneFrame& frame,
                                            const ValueRange& range);

}  // namespace palpate
