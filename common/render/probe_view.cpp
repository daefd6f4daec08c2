#include "common/render/probe_view.h"

#include <algorithm>

namespace palpate {
namespace {

// What is not finite is not drawn, wherever it is not.
bool same_place(const Vec3& a, const Vec3& b) { return a == b || (!is_finite(a) && !is_finite(b)); }

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

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
