#include "common/compose/window_model.h"

#include <tuple>

#include "common/base/text.h"
#include "common/render/line_style.h"
#include "common/scene/time_series.h"
#include "common/scene/time_steps.h"

namespace palpate {
namespace {

/// The colour of lines where it is an array, which is sampled for the scene; quantities of the lines are drawn
/// of any scene.
std::string color_array_of(const Document& document) {
  for (int i = 0; i < kColorByCount; ++i) {
    if (document.view.color == name_of(static_cast<ColorBy>(i))) return {};
  }
  return document.view.color;
}

auto scene_of(const Document& d) {
  // Volumes of tensors are made of them: their transfer functions are a matter of drawing alone.
  const bool scalars = d.input.kind != FieldKind::kTensor;
  return std::tuple(d.input.field, d.input.secondary, d.input.time, d.input.tensor, d.input.regions,
                    d.input.paint, d.heart.walls, d.heart.cut_face, d.tracing, d.common.seed, d.tracts,
                    d.tract_appearance.file, d.tract_appearance.bundles, d.tract_appearance.bundle_profile,
                    d.tensors.underlay, color_array_of(d), d.volume.scalar, d.volume.resample,
                    scalars ? d.volume.transfer : std::string(), scalars ? d.volume.focus : std::string(),
                    d.heart.layer, d.heart.angle, d.heart.cut, d.heart.contours, d.heart.lens_angle,
                    d.heart.lens.empty(), d.heart.beside, d.heart.beside_angle);
}

}  // namespace

std::size_t time_step_of(const Document& document, const std::vector<double>& times) {
  if (times.empty()) return 0;
  const std::string& time = document.input.time;
  if (time == "last") return times.size() - 1;
  const auto value = number(time);
  return value ? nearest_step(times, *value) : 0;
}

void set_time_step(Document& document, const std::vector<double>& times, std::size_t step) {
  if (step < times.size()) document.input.time = exact_number(times[step]);
}

bool same_scene(const Document& a, const Document& b) { return scene_of(a) == scene_of(b); }

void take_scene(const Document& used, Document& document) {
  document.input.field = used.input.field;
  document.input.secondary = used.input.secondary;
  document.input.time = used.input.time;
  document.tracing = used.tracing;
  document.tracts = used.tracts;
  document.heart.layer = used.heart.layer;
  document.heart.angle = used.heart.angle;
  document.heart.walls = used.heart.walls;
}

}  // namespace palpate
