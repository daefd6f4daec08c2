#include "common/compose/slice_plane.h"

#include <array>
#include <cmath>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// A plane with a name: across one axis of the data, seen from one side of it.
struct NamedPlane {
  std::string_view name;
  int axis;
  double side;  ///< of the viewer
};
// x runs to the right of a patient, y to the front, z to the head: right stays on the right.
constexpr std::array<NamedPlane, 3> kNamed{{{"axial", 2, 1.0}, {"coronal", 1, -1.0}, {"sagittal", 0, 1.0}}};

}  // namespace

ImagePlane parse_plane(const std::string& text, const Box& bounds) {
  const std::string refusal =
      "--plane " + text +
      ": axial, coronal or sagittal is expected, with ':' and a place behind it, or nx,ny,nz,d";
  const std::size_t colon = text.find(':');
  for (const NamedPlane& named : kNamed) {
    if (text.substr(0, colon) != named.name) continue;
    const double place = colon == std::string::npos
                             ? 0.5 * bounds.lower[named.axis] + 0.5 * bounds.upper[named.axis]
                             : parse_numbers(std::string_view(text).substr(colon + 1), 1, refusal)[0];
    ImagePlane plane{Vec3(0.0), named.side * place};
    plane.normal[named.axis] = named.side;
    return plane;
  }
  const auto v = parse_numbers(text, 4, refusal);
  const Vec3 normal(v[0], v[1], v[2]);
  const double length = glm::length(normal);
  if (!(length > 0.0) || !std::isfinite(length)) throw usage_error(refusal + "; n must not be zero");
  return {normal / length, v[3] / length};
}

std::string direction_text(const Vec3& direction, bool anatomical) {
  constexpr std::array<std::array<const char*, 2>, 3> kPatient{
      {{"left", "right"}, {"back", "front"}, {"feet", "head"}}};
  constexpr std::array<std::array<const char*, 2>, 3> kPlain{{{"-x", "+x"}, {"-y", "+y"}, {"-z", "+z"}}};
  constexpr double kLittle = 0.1;  // of a unit vector: an axis that it hardly leads to
  std::string words;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double part = direction[static_cast<int>(axis)];
    if (std::abs(part) < kLittle) continue;
    words += words.empty() ? "" : " and ";
    words += (anatomical ? kPatient : kPlain)[axis][part > 0.0 ? 1 : 0];
  }
  return words;
}

Box parse_box(const std::string& text, const std::string& option) {
  const auto v =
      parse_numbers(text, 6, option + " " + text + ": two opposite corners x,y,z,x,y,z are expected");
  Box box;
  box.include({v[0], v[1], v[2]});
  box.include({v[3], v[4], v[5]});
  return box;
}

}  // namespace palpate
