/// The direction of muscle fibres at a place in a heart's wall, and in its layer there.
///
/// With f the major eigenvector of the interpolated outer products (Ikits 2006, sec. 8.2) and n the smoothed
/// normal of the layer (field/heart/wall_frame.h), the direction in the layer is that of (1 - n n^T) f.
#pragma once

#include <memory>

#include "common/field/heart/heart.h"
#include "common/field/heart/wall_frame.h"

namespace palpate {

/// Frame L.
struct FibreSample {
  Vec3 fibre{0.0};          ///< f: unit; its sign has no meaning
  Vec3 normal{0.0};         ///< n: unit, outwards; zero where the layer has none
  Vec3 in_layer{0.0};       ///< unit, along the layer; zero where the fibre stands on it
  double tangential = 0.0;  ///< |(1 - n n^T) f|: 1 in the layer, 0 where the fibre stands on it
  double gap = 0.0;         ///< eigen gap: 0 where f is undefined
  SampleStatus status = SampleStatus::kOutside;  ///< the rest has no meaning unless kOk
};

/// A heart with what is derived from it for tracing and touch; immutable and shared.
class LayeredHeart {
 public:
  explicit LayeredHeart(Heart heart);

  [[nodiscard]] const Heart& heart() const noexcept { return heart_; }
  [[nodiscard]] const SmoothNormals& normals() const noexcept { return normals_; }
  [[nodiscard]] const LocalFrame& frame() const noexcept { return heart_.layer->frame(); }

  /// @param x frame L. @rt Safe.
  [[nodiscard]] FibreSample sample(const Vec3& x, CellHint& hint) const noexcept;

 private:
  Heart heart_;
  SmoothNormals normals_;
};

}  // namespace palpate
