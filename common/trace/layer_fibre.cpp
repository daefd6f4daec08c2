#include "common/trace/layer_fibre.h"

#include <algorithm>
#include <utility>

#include "common/field/grid/tet_mesh.h"
#include "common/field/tensor/eigenframe.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// Part of a unit vector below which a projection is rounding.
constexpr double kNothingLeft = 0x1p-40;

}  // namespace

LayeredHeart::LayeredHeart(Heart heart) : heart_(std::move(heart)), normals_(heart_.layer) {}

FibreSample LayeredHeart::sample(const Vec3& x, CellHint& hint) const noexcept {
  FibreSample out;
  const TensorSample tensor = heart_.fibres->sample(frame().data_from_local(x), hint);
  out.status = tensor.status;
  if (tensor.status != SampleStatus::kOk) return out;
  const SymmetricEigen eigen = symmetric_eigen(tensor.value);
  out.fibre = eigen.vectors[0];
  out.gap = eigen_gaps(eigen.values).major;
  // The sample has left its cell in the hint.
  const auto cell = static_cast<CellIndex>(hint.cell);
  const Vec3 normal = normals_.at({cell, heart_.layer->tet_mesh()->barycentric(cell, x)});
  const double length = glm::length(normal);
  if (!(length > kNothingLeft)) return out;
  out.normal = normal / length;
  const Vec3 along = out.fibre - glm::dot(out.fibre, out.normal) * out.normal;
  const double left = glm::length(along);
  if (!(left > kNothingLeft)) return out;
  out.tangential = std::min(left, 1.0);
  out.in_layer = along / left;
  return out;
}

}  // namespace palpate
