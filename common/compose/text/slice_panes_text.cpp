#include "common/compose/text/slice_panes_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

template <typename Names>
std::size_t place_in(const Names& names, std::string_view word, const char* option) {
  const auto at = std::find(names.begin(), names.end(), word);
  if (at == names.end())
    throw usage_error(std::string(option) + ": no such word: '" + std::string(word) + "'");
  return as_size(at - names.begin());
}

Vec3 place_of(const std::string& text, const char* option, const Vec3& otherwise) {
  if (text.empty()) return otherwise;
  return vec_at(parse_numbers(text, 3, std::string(option) + " " + text + ": a place x,y,z is expected"), 0);
}

Quat turn_of(const std::string& text) {
  if (text.empty()) return SlicePanes{}.turn;
  const std::string refusal =
      "--slice-turn " + text + ": a quaternion qw,qx,qy,qz that is not zero is expected";
  const auto q = parse_numbers(text, 4, refusal);
  const Quat turn(q[0], q[1], q[2], q[3]);
  const double length = glm::length(turn);
  if (!(length > 0.0) || !std::isfinite(length)) throw usage_error(refusal);
  constexpr double kUnit = 1e-12;  // what is written as a unit quaternion stays as it is written
  return std::abs(length - 1.0) < kUnit ? turn : turn / length;
}

}  // namespace

SlicePanes slice_panes_of(const PanesOptions& options, const Box& bounds) {
  SlicePanes panes;
  panes.layout = options.layout == "4" ? 4 : options.layout == "2" ? 2 : 1;
  panes.first = static_cast<SlicePlane>(place_in(kSlicePlaneNames, options.first, "--pane"));
  panes.cross = place_of(options.cross, "--cross", bounds.center());
  panes.turn = turn_of(options.turn);
  panes.center = place_of(options.center, "--slice-center", bounds.center());
  panes.zoom = options.zoom;
  panes.slab = options.slab;
  panes.rule = static_cast<SlabRule>(place_in(kSlabRuleNames, options.rule, "--slab-rule"));
  panes.radiological = options.side != "neurological";
  panes.blend = options.blend;
  panes.shown = options.shown;
  if (options.window.has_value() != options.level.has_value())
    throw usage_error("--slice-window and --slice-level: give both, or neither");
  if (options.window) panes.window = ValueWindow{.width = *options.window, .level = *options.level};
  return panes;
}

std::string panes_note(const VolumeView& volume) {
  const SlicePanes& panes = volume.panes;
  const Box bounds = volume.image->bounds();
  if (panes.layout == 1) {
    SlicePanes usual;
    usual.cross = usual.center = bounds.center();
    usual.first = panes.first;
    usual.radiological = panes.radiological;
    usual.shown = PanesOptions{}.shown;
    return panes == usual
               ? std::string()
               : "there are no slices in the picture that --cross, --slab and the like are of: --layout 2 and "
                 "4 have some";
  }
  if (!bounds.contains(panes.cross)) {
    const auto text = [](const Vec3& x) {
      return short_number(x.x) + "," + short_number(x.y) + "," + short_number(x.z);
    };
    return "--cross lies outside the volume, which reaches from " + text(bounds.lower) + " to " +
           text(bounds.upper) + ": slices may show nothing";
  }
  const std::vector<SliceImage>& images = volume.slice_images;
  if (!images.empty() &&
      std::ranges::none_of(images, [&](const SliceImage& one) { return one.name == panes.shown; }))
    return "slices show anisotropy: there is no " + panes.shown + " of this image (--slice-show)";
  if (panes.blend > 0.0 && volume.fields.empty())
    return "--slice-blend has nothing to lay over the slices: name a second volume, as in --field scalars,pet.nii.gz";
  return {};
}

void keep_panes(const SlicePanes& panes, const Box& bounds, PanesOptions& options) {
  const auto unless_middle = [&bounds](const Vec3& x) {
    return x == bounds.center() ? std::string() : exact_text(x);
  };
  options.layout = std::to_string(panes.layout);
  options.first = kSlicePlaneNames[as_size(panes.first)];
  options.cross = unless_middle(panes.cross);
  const Quat& q = panes.turn;
  options.turn = q == SlicePanes{}.turn ? std::string() : exact_text({q.w, q.x, q.y, q.z});
  options.center = unless_middle(panes.center);
  options.zoom = panes.zoom;
  options.slab = panes.slab;
  options.rule = kSlabRuleNames[as_size(panes.rule)];
  options.side = panes.radiological ? "radiological" : "neurological";
  options.blend = panes.blend;
  options.shown = panes.shown;
  options.window.reset();
  options.level.reset();
  if (panes.window) {
    options.window = panes.window->width;
    options.level = panes.window->level;
  }
}

}  // namespace palpate
