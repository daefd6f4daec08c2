#include "common/render/probe_view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/base/error.h"

namespace palpate {
namespace {

// What is not finite is not drawn, wherever it is not.
bool same_place(const Vec3& a, const Vec3& b) { return a == b || (!is_finite(a) && !is_finite(b)); }

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

void ProbePath::append(const Vec3& position, double force) {
  if (!is_finite(position)) {
    gap_ = true;
    return;
  }
  if (!gap_) {
    const Vec3 step = glm::abs(position - positions_.back());
    if (step.x <= spacing_ && step.y <= spacing_ && step.z <= spacing_) return;
  } else {
    pieces_.push_back(positions_.size());
    gap_ = false;
  }
  positions_.push_back(position);
  forces_.push_back(force);
}

std::shared_ptr<const ProbePath> make_probe_path(std::span<const Vec3> positions,
                                                 std::span<const double> forces, double spacing) {
  if (positions.size() != forces.size()) {
    throw work_error("the path of the proxy has " + std::to_string(forces.size()) + " forces for " +
                     std::to_string(positions.size()) + " points");
  }
  auto path = std::make_shared<ProbePath>(spacing);
  for (std::size_t i = 0; i < positions.size(); ++i) path->append(positions[i], forces[i]);
  return path;
}

Rgb cached_color(int number) noexcept {
  constexpr int kColors = kCategoryCount - 1;  // the last one is a grey
  const int k = ((number - 1) % kColors + kColors) % kColors;
  return map_color(ColorMap::kCategorical, (k + 0.5) / kCategoryCount);
}

ValueRange force_range(const ProbeView& view) noexcept {
  if (view.path.range) return *view.path.range;
  return {0.0, view.force_cap > 0.0 ? view.force_cap : 1.0};
}

bool same_picture(const ProbeView& a, const ProbeView& b) noexcept {
  return same_place(a.probe, b.probe) && same_place(a.proxy, b.proxy) &&
         std::ranges::equal(a.links, b.links, same_place) && same_number(a.force, b.force) &&
         same_number(a.force_cap, b.force_cap) && a.show_force == b.show_force &&
         same_place(a.velocity, b.velocity) && same_number(a.reference_speed, b.reference_speed) &&
         a.tensor == b.tensor && a.followed == b.followed && a.path == b.path && a.seeds == b.seeds &&
         a.drawn_lines == b.drawn_lines && a.style == b.style;
}

}  // namespace palpate
