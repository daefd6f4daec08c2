#include "common/field/heart/fibre_angles.h"

#include <cmath>
#include <limits>
#include <variant>

#include "common/field/field_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/tensor/eigenframe.h"
#include "common/math/symmetric3.h"
#include "common/math/units.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Part of a unit vector below which a projection has no direction.
constexpr double kNothingLeft = 1e-6;

/// e_c, e_l, e_t of a convention, columns.
std::optional<Mat3> axes_of(AngleConvention convention, const WallDirections& at) noexcept {
  const auto axes = wall_axes(at.axis, at.transmural);
  if (!axes) return std::nullopt;
  const bool keeps_axis = convention == AngleConvention::kBayer || convention == AngleConvention::kDoste;
  if (!keeps_axis) return axes;
  const Vec3 e_c = (*axes)[0], e_l = glm::normalize(at.axis);
  return Mat3{e_c, e_l, glm::cross(e_c, e_l)};
}

/// Of the direction without sign whose components are `along` and `across`.
std::optional<double> angle_from(double along, double across) noexcept {
  if (!(std::hypot(along, across) > kNothingLeft)) return std::nullopt;
  return along < 0.0 ? std::atan2(-across, -along) : std::atan2(across, along);
}

/// A stored tensor as a matrix.
Mat3 tensor_at(const TensorField& field, std::size_t point) {
  return std::visit(
      [point](const auto& values) {
        const auto at = [&](std::size_t i) { return static_cast<double>(values[6 * point + i]); };
        return Mat3{Vec3{at(0), at(1), at(2)}, Vec3{at(1), at(3), at(4)}, Vec3{at(2), at(4), at(5)}};
      },
      field.values());
}

struct Direction {
  Vec3 along{0.0};
  double gap = kNaN;  ///< NaN: there is no tensor
};

Direction direction_at(const TensorField& field, std::size_t point) {
  const Mat3 tensor = tensor_at(field, point);
  if (!std::isfinite(tensor[0][0] + tensor[1][1] + tensor[2][2])) return {};
  const SymmetricEigen eigen = symmetric_eigen(tensor);
  return {eigen.vectors[0], eigen_gaps(eigen.values).major};
}

}  // namespace

bool defines(AngleConvention convention, WallAngle angle) noexcept {
  switch (angle) {
    case WallAngle::kTransverse:
      return convention == AngleConvention::kStreeter || convention == AngleConvention::kDoste;
    case WallAngle::kSheet:
      return convention != AngleConvention::kDoste;
    case WallAngle::kHelix:
      break;
  }
  return true;
}

std::optional<double> wall_angle(WallAngle angle, AngleConvention convention,
                                 const WallDirections& at) noexcept {
  const auto axes = axes_of(convention, at);
  const double length = glm::length(at.fibre);
  if (!axes || !(length > 0.0) || !defines(convention, angle)) return std::nullopt;
  const Vec3 f = at.fibre * *axes / length;  // components along e_c, e_l, e_t
  const auto alpha = angle_from(f.x, f.y);
  if (angle == WallAngle::kHelix) return alpha;
  if (angle == WallAngle::kTransverse) {
    if (convention == AngleConvention::kStreeter) return angle_from(f.x, f.z);
    if (!alpha) return std::nullopt;
    const double tangential = std::hypot(f.x, f.y);  // (3): f . e_c' > 0
    return -std::atan2(f.x < 0.0 ? -f.z : f.z, tangential);
  }
  const double size = glm::length(at.sheet);
  if (!(size > 0.0)) return std::nullopt;
  const Vec3 s = at.sheet * *axes / size;
  if (convention == AngleConvention::kStreeter) return angle_from(s.z, s.y);
  if (!alpha) return std::nullopt;
  return angle_from(s.z, -std::sin(*alpha) * s.x + std::cos(*alpha) * s.y);
}

std::vector<double> map_angle(const Heart& heart, const SmoothNormals& normals, const Vec3& axis,
                              WallAngle angle, AngleConvention convention) {
  const LocalFrame& frame = heart.layer->frame();
  std::vector<double> map(heart.layer->tet_mesh()->points().size(), kNaN);
  for (std::size_t p = 0; p < map.size(); ++p) {
    const Direction fibre = direction_at(*heart.fibres, p);
    if (!(fibre.gap >= kLeastGap)) continue;
    const Vec3 normal(normals.at_point(p));
    WallDirections at{
        .axis = axis, .transmural = frame.rotated ? frame.rotation * normal : normal, .fibre = fibre.along};
    if (angle == WallAngle::kSheet) {
      const Direction sheet = direction_at(*heart.sheets, p);
      if (!(sheet.gap >= kLeastGap)) continue;
      at.sheet = sheet.along;
    }
    if (const auto found = wall_angle(angle, convention, at)) map[p] = kDegreesARadian * *found;
  }
  return map;
}

std::vector<double> map_gap(const Heart& heart) {
  std::vector<double> map(heart.layer->tet_mesh()->points().size());
  for (std::size_t p = 0; p < map.size(); ++p) map[p] = direction_at(*heart.fibres, p).gap;
  return map;
}

}  // namespace palpate
