#include "common/app/cli/lens_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

constexpr const char* kGrammar =
    "a lens is sphere:x,y,z,r, box:x,y,z,x,y,z (two corners), cylinder:x,y,z,x,y,z,r or "
    "halfspace:nx,ny,nz,d, "
    "and ',cut' behind it where it cuts away";
constexpr std::string_view kCut = ",cut";

Vec3 vec_at(const std::vector<double>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

void check_above_zero(double size, const std::string& text, const char* what) {
  if (!(size > 0.0)) throw usage_error("--lens " + text + ": the " + what + " must be above zero");
}

ConvexShape shape_of(std::string_view text, const std::string& all) {
  const std::string refusal = "--lens " + all + ": " + kGrammar;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) throw usage_error(refusal);
  const std::string_view kind = text.substr(0, colon), rest = text.substr(colon + 1);
  if (kind == "sphere") {
    const auto v = parse_numbers(rest, 4, refusal);
    check_above_zero(v[3], all, "radius");
    return make_sphere(vec_at(v, 0), v[3]);
  }
  if (kind == "box") {
    const auto v = parse_numbers(rest, 6, refusal);
    const Vec3 half = 0.5 * glm::abs(vec_at(v, 3) - vec_at(v, 0));
    for (int axis = 0; axis < 3; ++axis) check_above_zero(half[axis], all, "size along each axis");
    return make_box(0.5 * (vec_at(v, 0) + vec_at(v, 3)),
                    Mat3(Vec3(half.x, 0.0, 0.0), Vec3(0.0, half.y, 0.0), Vec3(0.0, 0.0, half.z)));
  }
  if (kind == "cylinder") {
    const auto v = parse_numbers(rest, 7, refusal);
    check_above_zero(glm::length(vec_at(v, 3) - vec_at(v, 0)), all, "length");
    check_above_zero(v[6], all, "radius");
    return make_cylinder(vec_at(v, 0), vec_at(v, 3), v[6]);
  }
  if (kind == "halfspace") return parse_beyond(rest, "--lens " + all);
  throw usage_error(refusal);
}

std::string joined(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers)
    text += (text.empty() ? "" : ",") + exact_number(number + 0.0);  // no -0
  return text;
}

double trace(const Mat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

std::optional<std::string> shape_text(const ConvexShape& shape) {
  const auto& faces = shape.half_spaces;
  if (shape.quadric && faces.empty()) {
    const Vec3& c = shape.quadric->center;
    // M = I / r
    return "sphere:" + joined({c.x, c.y, c.z, 3.0 / trace(shape.quadric->unit_from_data)});
  }
  if (shape.quadric && faces.size() == 2) {
    // M = (I - a a^T) / r; the ends stand on the faces, whose normals are a and -a.
    const Vec3 &from = shape.quadric->center, &axis = faces[0].outward;
    const Vec3 to = from + (faces[0].offset - glm::dot(axis, from)) * axis;
    return "cylinder:" +
           joined({from.x, from.y, from.z, to.x, to.y, to.z, 2.0 / trace(shape.quadric->unit_from_data)});
  }
  if (!shape.quadric && faces.size() == 1) {
    const Vec3 n = -faces[0].outward;
    return "halfspace:" + joined({n.x, n.y, n.z, -faces[0].offset});
  }
  if (!shape.quadric && faces.size() == 6) {
    Vec3 lower{0.0}, upper{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      // make_box() gives the faces of an axis one after the other, outward and back.
      const std::size_t face = 2 * static_cast<std::size_t>(axis);
      if (std::abs(faces[face].outward[axis]) != 1.0) return std::nullopt;
      const double a = faces[face].outward[axis] * faces[face].offset;
      const double b = faces[face + 1].outward[axis] * faces[face + 1].offset;
      lower[axis] = std::min(a, b);
      upper[axis] = std::max(a, b);
    }
    return "box:" + joined({lower.x, lower.y, lower.z, upper.x, upper.y, upper.z});
  }
  return std::nullopt;
}

}  // namespace

ConvexShape parse_beyond(std::string_view text, const std::string& asked) {
  const std::string refusal = asked + ": nx,ny,nz,d is expected, for what lies where n.x > d";
  const auto v = parse_numbers(text, 4, refusal);
  const Vec3 normal = vec_at(v, 0);
  const double length = glm::length(normal);
  if (!(length > 0.0) || !std::isfinite(length)) throw usage_error(refusal + "; n must not be zero");
  ConvexShape shape;
  shape.half_spaces.push_back({-normal / length, -v[3] / length});
  return shape;
}

Lens parse_lens(const std::string& text) {
  std::string_view shape = text;
  Lens lens;
  lens.cut = shape.ends_with(kCut);
  if (lens.cut) shape.remove_suffix(kCut.size());
  lens.shape = shape_of(shape, text);
  return lens;
}

std::optional<std::string> lens_text(const Lens& lens) {
  auto text = shape_text(lens.shape);
  if (text && lens.cut) *text += kCut;
  return text;
}

std::string lenses_text(const std::vector<Lens>& lenses) {
  std::string all;
  for (const Lens& lens : lenses) {
    const auto text = lens_text(lens);
    if (text) all += (all.empty() ? "" : ";") + *text;
  }
  return all;
}

std::vector<Lens> make_lenses(const VolumeOptions& options, const std::optional<ColorTransfer>& focus) {
  std::vector<Lens> lenses;
  for (const std::string& plane : options.clips)
    lenses.push_back({.shape = parse_beyond(plane, "--clip " + plane), .cut = true});
  for (const std::string& text : options.lenses) lenses.push_back(parse_lens(text));
  std::stable_partition(lenses.begin(), lenses.end(), [](const Lens& lens) { return lens.cut; });
  if (lenses.size() > kMostLenses) {
    throw usage_error("--lens: " + std::to_string(lenses.size()) + " lenses and clipping planes; at most " +
                      std::to_string(kMostLenses) + " are possible");
  }
  for (Lens& lens : lenses) {
    lens.samples_per_voxel = options.samples;
    lens.shading = options.shading;
    if (!lens.cut) lens.transfer = focus;
  }
  return lenses;
}

}  // namespace palpate
