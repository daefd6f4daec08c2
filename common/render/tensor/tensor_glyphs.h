/// The glyphs that stand for tensors on slices: pure arithmetic, no OpenGL.
#pragma once

#include <vector>

#include "common/math/vec.h"
#include "common/render/camera.h"
#include "common/render/tensor/tensor_view.h"

namespace palpate {

/// One glyph, as laid out in the shader's buffer (shaders/tensor/glyph.vert). Scene frame.
struct TensorGlyph {
  Vec3f center{0.0F};
  float alpha = 1.0F;  ///< exponent about the pole
  Vec3f axis_x{1.0F, 0.0F, 0.0F};
  float beta = 1.0F;  ///< exponent toward the pole
  Vec3f axis_y{0.0F, 1.0F, 0.0F};
  float padding0 = 0.0F;
  Vec3f axis_z{0.0F, 0.0F, 1.0F};  ///< that of the pole
  float padding1 = 0.0F;
  Rgb color{1.0F};
  float padding2 = 0.0F;
};

/// A glyph of `tensor` about `center`, both in data coordinates. Its half axes are
/// `reach` lambda_i / lambda_1 [data units], at least a twentieth of `reach`: all glyphs are equally long,
/// and a surface has normals. A superquadric has, with c_l and c_p as of Ikits 2006 (8.3, 8.4) and gamma = 3,
///   c_l >= c_p:  pole e_1, alpha = (1 - c_p)^gamma, beta = (1 - c_l)^gamma
///   c_l <  c_p:  pole e_3, alpha = (1 - c_l)^gamma, beta = (1 - c_p)^gamma        (Kindlmann 2004, eq. 4)
/// exponents below 0.05 are lifted to that.
/// @pre lambda_1 > 0; shape is not kNone.
[[nodiscard]] TensorGlyph make_glyph(const Mat3& tensor, GlyphShape shape, TensorColor color,
                                     const Vec3& center, double reach, const SceneFrame& frame);

/// Of every `stride`-th voxel along the image's axes a glyph may stand on a slice.
/// @param distance least distance of glyphs [data units].
[[nodiscard]] Index3 glyph_stride(const TensorVoxels& image, double distance) noexcept;

/// Glyphs on the slices that are shown, with half axes no longer than half the way to the next glyph.
/// Voxels without a tensor and with less anisotropy than view.glyph_least_fa have none. Of an image with several
/// directions a voxel each has a needle of its own, as long as it is beside the longest there.
[[nodiscard]] std::vector<TensorGlyph> make_slice_glyphs(const TensorView& view, const SceneFrame& frame,
                                                         const Index3& stride);

}  // namespace palpate
