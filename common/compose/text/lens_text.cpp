#include "common/compose/text/lens_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/math/vec.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr const char* kGrammar =
    "a lens is sphere:x,y,z,r, box:x,y,z,x,y,z (two corners), cylinder:x,y,z,x,y,z,r, "
    "polyhedron:nx,ny,nz,d,nx,ny,nz,d,..., halfspace:nx,ny,nz,d or screen:x,y,r, and behind it ',cut' where "
    "it cuts away, "
    "',magnify=M', ',blend=B', ',samples=N', ',shading=on' or 'off', "
    "',illustration=on' or 'off', ',field=NAME' or last ',tf=NAME|FILE'";

void check_above_zero(double size, const std::string& text, const char* what) {
  if (!(size > 0.0)) throw usage_error("--lens " + text + ": the " + what + " must be above zero");
}

// Where n.x <= d for each n, d.
ConvexShape polyhedron_of(std::string_view text, const std::string& refusal) {
  const auto numbers = as_size(1 + std::count(text.begin(), text.end(), ','));
  if (numbers % 4 != 0) throw usage_error(refusal);
  if (numbers > 4 * kMostHalfSpaces)
    throw usage_error(refusal + "; at most " + std::to_string(kMostHalfSpaces) + " faces are possible");
  const auto v = parse_numbers(text, numbers, refusal);
  std::vector<ConvexShape::HalfSpace> faces;
  for (std::size_t i = 0; i < numbers; i += 4) {
    const double length = glm::length(vec_at(v, i));
    if (!(length > 0.0) || !std::isfinite(length)) throw usage_error(refusal + "; n must not be zero");
    faces.push_back({vec_at(v, i), v[i + 3]});
  }
  return make_polyhedron(faces);
}

/// @param least, most of the numbers that are taken, `least` itself included.
double number_from(double least, double most, std::string_view text, const std::string& refusal) {
  const std::string bounds =
      refusal + "; a number from " + short_number(least) + " to " + short_number(most) + " is expected";
  const double value = parse_numbers(text, 1, bounds).front();
  if (!(value >= least && value <= most)) throw usage_error(bounds);
  return value;
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
  if (kind == "polyhedron") return polyhedron_of(rest, refusal);
  if (kind == "halfspace") return parse_beyond(rest, "--lens " + all);
  throw usage_error(refusal);
}

// A circle on the screen, where the words are of one.
std::optional<ScreenCircle> circle_of(std::string_view text, const std::string& all) {
  constexpr std::string_view kKind = "screen:";
  if (!text.starts_with(kKind)) return std::nullopt;
  const auto v = parse_numbers(text.substr(kKind.size()), 3, "--lens " + all + ": " + kGrammar);
  check_above_zero(v[2], all, "radius");
  return ScreenCircle{.x = v[0], .y = v[1], .radius = v[2]};
}

std::string numbers_text(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers)
    text += (text.empty() ? "" : ",") + exact_number(number + 0.0);  // no -0
  return text;
}

bool is_half_space(const ConvexShape& shape) { return !shape.quadric && shape.half_spaces.size() == 1; }

// What is left where a half-space is gone.
ConvexShape::HalfSpace cached_beside(const ConvexShape& gone) {
  const ConvexShape::HalfSpace& face = gone.half_spaces.front();
  return {-face.outward, -face.offset};
}

double trace(const Mat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

std::optional<std::string> shape_text(const ConvexShape& shape) {
  const auto& faces = shape.half_spaces;
  if (shape.quadric && faces.empty()) {
    // M = I / r
    return sphere_text(shape.quadric->center, 3.0 / trace(shape.quadric->unit_from_data));
  }
  if (shape.quadric && faces.size() == 2) {
    // M = (I - a a^T) / r; the ends stand on the faces, whose normals are a and -a.
    const Vec3 &from = shape.quadric->center, &axis = faces[0].outward;
    const Vec3 to = from + (faces[0].offset - glm::dot(axis, from)) * axis;
    return "cylinder:" + numbers_text({from.x, from.y, from.z, to.x, to.y, to.z,
                                       2.0 / trace(shape.quadric->unit_from_data)});
  }
  if (is_half_space(shape)) {
    const Vec3 n = -faces[0].outward;
    return "halfspace:" + numbers_text({n.x, n.y, n.z, -faces[0].offset});
  }
  if (!shape.quadric && faces.size() == 6) {
    Vec3 lower{0.0}, upper{0.0};
    bool upright = true;
    for (int axis = 0; axis < 3; ++axis) {
      // make_box() gives the faces of an axis one after the other, outward and back.
      const std::size_t face = 2 * as_size(axis);
      upright = upright && std::abs(faces[face].outward[axis]) == 1.0 &&
                faces[face + 1].outward == -faces[face].outward;
      const double a = faces[face].outward[axis] * faces[face].offset;
      const double b = faces[face + 1].outward[axis] * faces[face + 1].offset;
      lower[axis] = std::min(a, b);
      upper[axis] = std::max(a, b);
    }
    if (upright) return "box:" + numbers_text({lower.x, lower.y, lower.z, upper.x, upper.y, upper.z});
  }
  if (shape.quadric || faces.size() < 2) return std::nullopt;
  std::string text;
  for (const ConvexShape::HalfSpace& h : faces) {
    text += (text.empty() ? "polyhedron:" : ",") +
            numbers_text({h.outward.x, h.outward.y, h.outward.z, h.offset});
  }
  return text;
}

}  // namespace

ConvexShape parse_beyond(std::string_view text, const std::string& asked) {
  const std::string refusal = asked + ": nx,ny,nz,d is expected, for what lies where n.x > d";
  const auto v = parse_numbers(text, 4, refusal);
  const Vec3 normal = vec_at(v, 0);
  const double length = normal_length(normal);
  if (!(length > 0.0) || !std::isfinite(length)) throw usage_error(refusal + "; n must not be zero");
  ConvexShape shape;
  shape.half_spaces.push_back({-normal / length, -v[3] / length});
  return shape;
}

LensSpec parse_lens(const std::string& text) {
  LensSpec spec;
  const std::string& all = text;
  std::string_view rest = text;
  constexpr std::string_view kTransfer = ",tf=";
  if (const std::size_t at = rest.find(kTransfer); at != std::string_view::npos) {
    spec.transfer = rest.substr(at + kTransfer.size());
    if (spec.transfer.empty()) throw usage_error("--lens " + all + ": " + kGrammar);
    rest = rest.substr(0, at);
  }
  // What is said of the lens stands behind its numbers, and begins with a letter.
  const auto says = [&](std::string_view word, std::string_view what) {
    if (what == "cut") {
      spec.lens.cut = true;
    } else if (word == "off" && what == "off") {
      spec.off = true;
    } else if (word == "magnify") {
      spec.lens.magnification = number_from(1.0, 100.0, what, "--lens " + all + ": magnify");
    } else if (word == "blend") {
      spec.lens.transition = number_from(0.0, 1.0, what, "--lens " + all + ": blend");
    } else if (word == "samples") {
      spec.samples = number_from(0.01, 64.0, what, "--lens " + all + ": samples");
    } else if (word == "field" && !what.empty()) {
      spec.field = what;
    } else if (word == "shading" && (what == "on" || what == "off")) {
      spec.shading = what == "on";
    } else if (word == "illustration" && (what == "on" || what == "off")) {
      spec.illustrated = what == "on";
    } else {
      throw usage_error("--lens " + all + ": " + kGrammar);
    }
  };
  std::vector<std::string_view> said;
  for (std::size_t comma = rest.rfind(','); comma != std::string_view::npos && comma + 1 < rest.size() &&
                                            std::isalpha(static_cast<unsigned char>(rest[comma + 1])) != 0;
       comma = rest.rfind(',')) {
    const std::string_view one = rest.substr(comma + 1);
    if (one == "nan" || one == "inf") break;  // a number, and refused as one
    said.push_back(one);
    rest = rest.substr(0, comma);
  }
  spec.lens.screen = circle_of(rest, text);
  if (!spec.lens.screen) spec.lens.shape = shape_of(rest, text);
  for (std::size_t i = 0; i < said.size(); ++i) {
    const std::size_t equal = said[i].find('=');
    const std::string_view word = said[i].substr(0, equal);
    for (std::size_t k = 0; k < i; ++k) {
      if (said[k].substr(0, said[k].find('=')) == word)
        throw usage_error("--lens " + all + ": '" + std::string(word) + "' is said twice");
    }
    says(word, equal == std::string_view::npos ? word : said[i].substr(equal + 1));
  }
  const Lens& lens = spec.lens;
  if (lens.cut && !(spec.field.empty() && spec.transfer.empty()))
    throw usage_error("--lens " + all + ": what is cut away shows nothing; leave out ',field' and ',tf'");
  if (lens.transition > 0.0 && !spec.field.empty())
    throw usage_error("--lens " + all +
                      ": values blend with those of one field; leave out ',blend' or ',field'");
  if (spec.off && !(lens.cut && is_half_space(lens.shape)))
    throw usage_error("--lens " + all + ": only a half-space that cuts can be off");
  if (!lens.cut && lens.magnification > 1.0 && !magnifies(lens))
    throw usage_error("--lens " + all + ": only a shape with a middle and bounds can magnify");
  if (!lens.cut && lens.transition > 0.0 && !magnifies(lens) && !has_transition(lens))
    throw usage_error("--lens " + all + ": only a shape with a middle and bounds can blend");
  return spec;
}

std::optional<std::string> lens_text(const Lens& lens, const VolumeView& view) {
  const auto& circle = lens.screen;
  auto text = circle ? std::optional("screen:" + numbers_text({circle->x, circle->y, circle->radius}))
                     : shape_text(lens.shape);
  if (!text) return text;
  if (lens.cut) return *text + ",cut";
  if (lens.magnification > 1.0) *text += ",magnify=" + exact_number(lens.magnification);
  if (lens.transition > 0.0) *text += ",blend=" + exact_number(lens.transition);
  if (lens.samples_per_voxel != view.samples_per_voxel)
    *text += ",samples=" + exact_number(lens.samples_per_voxel);
  if (lens.shading != view.shading) *text += lens.shading ? ",shading=on" : ",shading=off";
  if (lens.illustrated != view.illustrated)
    *text += lens.illustrated ? ",illustration=on" : ",illustration=off";
  if (lens.field > 0) *text += ",field=" + view.fields[lens.field - 1].name;
  if (lens.own_transfer && lens.regions) {
    *text += ",tf=" + region_text(*lens.regions);
  } else if (lens.own_transfer && lens.transfer && !lens.transfer->points().empty()) {
    *text += ",tf=" + transfer_text(*lens.transfer);
  }
  return text;
}

std::string sphere_text(const Vec3& center, double radius) {
  return "sphere:" + numbers_text({center.x, center.y, center.z, radius});
}

std::vector<std::string> lens_texts(const VolumeView& view) {
  std::vector<std::string> all;
  for (const CuttingPlane& cut : view.cuts) {
    ConvexShape gone;
    gone.half_spaces.push_back({-cut.kept.outward, -cut.kept.offset});
    all.push_back(*shape_text(gone) + (cut.on ? ",cut" : ",cut,off"));
  }
  for (const Lens& lens : view.lenses) {
    if (auto text = lens_text(lens, view)) all.push_back(std::move(*text));
  }
  return all;
}

VolumeParts make_parts(const VolumeOptions& options, const Lens& model) {
  VolumeParts parts;
  std::vector<std::pair<Lens, LensSpec>> lenses;
  for (const std::string& plane : options.clips)
    parts.cuts.push_back({.kept = cached_beside(parse_beyond(plane, "--clip " + plane))});
  for (const std::string& text : options.lenses) {
    const LensSpec spec = parse_lens(text);
    if (spec.lens.cut && is_half_space(spec.lens.shape)) {
      parts.cuts.push_back({.kept = cached_beside(spec.lens.shape), .on = !spec.off});
      continue;
    }
    Lens& lens = lenses.emplace_back(spec.lens, spec).first;
    lens.samples_per_voxel = spec.samples.value_or(options.samples);
    lens.shading = spec.shading.value_or(options.shading);
    lens.illustrated = spec.illustrated.value_or(options.illustration);
    if (lens.cut) continue;
    lens.transfer = model.transfer;
    lens.regions = model.regions;
  }
  std::stable_partition(lenses.begin(), lenses.end(), [](const auto& one) { return one.first.cut; });
  for (const auto& [lens, spec] : lenses) {
    parts.lenses.push_back(lens);
    parts.fields.push_back(spec.field);
    parts.transfers.push_back(spec.transfer);
  }
  if (parts.lenses.size() > kMostLenses) {
    throw usage_error("--lens: " + std::to_string(parts.lenses.size()) + " lenses; at most " +
                      std::to_string(kMostLenses) + " are possible");
  }
  if (parts.cuts.size() > kMostCuts) {
    throw usage_error("--clip: " + std::to_string(parts.cuts.size()) + " planes that cut; at most " +
                      std::to_string(kMostCuts) + " are possible");
  }
  return parts;
}

}  // namespace palpate
