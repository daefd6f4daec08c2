#include "common/render/tensor/tensor_glyphs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/base/index.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/peak_field.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr double kGamma = 3.0;
constexpr double kLeastExponent = 0.05, kThinnest = 0.05;

float exponent_of(double measure) {
  return static_cast<float>(std::max(kLeastExponent, std::pow(1.0 - measure, kGamma)));
}

Rgb color_of(const SymmetricEigen& eigen, TensorColor color) {
  if (color == TensorColor::kDirection) return direction_color(eigen.vectors[0]);
  return Rgb(static_cast<float>(fractional_anisotropy(eigen.values)));
}

TensorGlyph glyph_of(const SymmetricEigen& eigen, GlyphShape shape, TensorColor color, const Vec3& center,
                     double reach, const SceneFrame& frame) {
  const double scale = reach * power_of_two(-frame.exponent);
  std::array<Vec3f, 3> half{};
  for (int i = 0; i < 3; ++i) {
    const double share = std::max(kThinnest, eigen.values[i] / eigen.values[0]);
    half[as_size(i)] = Vec3f(scale * share * eigen.vectors[i]);
  }
  TensorGlyph glyph;
  glyph.center = Vec3f(frame.scene_from_data(center));
  glyph.color = color_of(eigen, color);
  const Anisotropy measure = anisotropy(eigen.values);
  const bool linear = measure.linear >= measure.planar;
  if (shape == GlyphShape::kSuperquadric) {
    glyph.alpha = exponent_of(linear ? measure.planar : measure.linear);
    glyph.beta = exponent_of(linear ? measure.linear : measure.planar);
  }
  // In turn, so that the frame stays right-handed.
  const std::size_t first = linear ? 1 : 0;
  glyph.axis_x = half[first];
  glyph.axis_y = half[first + 1];
  glyph.axis_z = half[(first + 2) % 3];
  return glyph;
}

/// What glyphs on a slice have in common.
struct SliceGlyphs {
  const TensorView& view;
  const SceneFrame& frame;
  double reach = 0.0;  ///< of a half axis [data units]
};

/// A needle for each direction of a voxel, as long as it is beside the longest there: fatter ones would hide each other.
/// @param at centre of the voxel. @param center of the glyphs.
void add_peaks(const PeakField& peaks, const SliceGlyphs& slice, const Vec3& at, const Vec3& center,
               std::vector<TensorGlyph>& glyphs) {
  constexpr double kNeedle = 0.9;  // anisotropy
  const double longest = glm::length(peaks.longest(at));
  for (std::size_t n = 0; n < peaks.most(); ++n) {
    const Vec3 peak = peaks.peak(at, n);
    const double length = glm::length(peak);
    if (!(length > 0.0) || std::min(1.0, length) < slice.view.glyph_least_fa) continue;
    const SymmetricEigen eigen = symmetric_eigen(fibre_tensor(peak / length, kNeedle));
    TensorGlyph glyph = glyph_of(eigen, slice.view.glyphs, slice.view.color, center,
                                 slice.reach * length / longest, slice.frame);
    if (slice.view.color == TensorColor::kFa) glyph.color = Rgb(static_cast<float>(std::min(1.0, length)));
    glyphs.push_back(glyph);
  }
}

}  // namespace

TensorGlyph make_glyph(const Mat3& tensor, GlyphShape shape, TensorColor color, const Vec3& center,
                       double reach, const SceneFrame& frame) {
  return glyph_of(symmetric_eigen(tensor), shape, color, center, reach, frame);
}

Index3 glyph_stride(const TensorVoxels& image, double distance) noexcept {
  Vec3 spacing{0.0};
  for (int axis = 0; axis < 3; ++axis) spacing[axis] = glm::length(image.axes[axis]);
  // Long voxels set how far apart glyphs are along all axes, so that these stand evenly.
  const double step = std::max({distance, std::min({spacing.x, spacing.y, spacing.z})});
  Index3 stride{1};
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = std::clamp(std::ceil(step / spacing[axis] - 1e-6), 1.0, 1.0 * image.points[axis]);
    stride[axis] = static_cast<int>(voxels);
  }
  return stride;
}

std::vector<TensorGlyph> make_slice_glyphs(const TensorView& view, const SceneFrame& frame,
                                           const Index3& stride) {
  std::vector<TensorGlyph> glyphs;
  const TensorVoxels& image = *view.image;
  const Vec3 cross = image.grid_coordinates(view.position);
  for (int axis = 0; axis < 3; ++axis) {
    if (!view.slices[as_size(axis)] || !image.contains(cross)) continue;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double reach =
        0.5 * std::min(stride[u] * glm::length(image.axes[u]), stride[v] * glm::length(image.axes[v]));
    Index3 at{0};
    at[axis] = std::clamp(static_cast<int>(std::lround(cross[axis])), 0, image.points[axis] - 1);
    for (at[v] = stride[v] / 2; at[v] < image.points[v]; at[v] += stride[v]) {
      for (at[u] = stride[u] / 2; at[u] < image.points[u]; at[u] += stride[u]) {
        if (!image.shows(at)) continue;
        // On the slice itself, which may lie off the centres of its voxels.
        Vec3 g(at);
        g[axis] = cross[axis];
        if (const PeakField* const peaks = image.field->peaks(); peaks != nullptr && peaks->most() > 1) {
          add_peaks(*peaks, {view, frame, reach}, image.position(Vec3(at)), image.position(g), glyphs);
          continue;
        }
        const SymmetricEigen eigen = symmetric_eigen(image.field->voxel(at).value);
        if (fractional_anisotropy(eigen.values) < view.glyph_least_fa) continue;
        glyphs.push_back(glyph_of(eigen, view.glyphs, view.color, image.position(g), reach, frame));
      }
    }
  }
  return glyphs;
}

}  // namespace palpate
