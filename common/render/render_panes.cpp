#include "common/render/render_panes.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

void paste(const Image& part, const Pane& pane, Image& whole) {
  for (int y = 0; y < part.height; ++y) {
    const auto from = part.rgba.begin() + static_cast<std::ptrdiff_t>(4 * as_size(y) * as_size(part.width));
    const std::size_t to = 4 * (as_size(pane.top + y) * as_size(whole.width) + as_size(pane.left));
    std::copy(from, from + 4 * part.width, whole.rgba.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

}  // namespace

Image join_panes(const std::vector<PaneImage>& parts, const Background& background, int width, int height) {
  const std::uint8_t between = background.is_light() ? 160 : 70;
  Image whole{width, height, std::vector<std::uint8_t>(4 * as_size(width) * as_size(height), 255)};
  for (std::size_t i = 0; i < whole.rgba.size(); ++i) {
    if (i % 4 != 3) whole.rgba[i] = between;
  }
  for (const PaneImage& part : parts) paste(part.image, part.pane, whole);
  return whole;
}

std::array<Pane, 2> halves_of(int width, int height) {
  constexpr int kGap = 2;
  const int left = std::max((width - kGap) / 2, 1);
  return {Pane{.width = left, .height = height}, Pane{.left = std::min(left + kGap, width - 1),
                                                      .width = std::max(width - left - kGap, 1),
                                                      .height = height}};
}

SceneView beside_view(const SceneView& scene) {
  SceneView view = *scene.beside;
  const auto own = std::move(view.style.array);
  const bool same = scene.style.array && own && scene.style.array->name == own->name;
  view.style = scene.style;
  view.style.array = own;
  if (!same) {
    view.style.range.reset();
    view.style.usual.reset();
    view.style.color_map.reset();
    view.style.logarithmic.reset();
  }
  view.background = scene.background;
  view.show_outline = scene.show_outline;
  view.show_axes = scene.show_axes;
  view.show_color_bar = view.show_color_bar && scene.show_color_bar;
  view.color_bar_left = scene.color_bar_left;
  view.show_scale_bar = scene.show_scale_bar;
  view.aspect = scene.aspect;
  view.camera = scene.camera;
  const double ratio = view.bounds.diagonal() / scene.bounds.diagonal();
  constexpr double kOtherUnits = 10.0;
  double scale = 1.0;
  if (ratio > kOtherUnits || ratio < 1.0 / kOtherUnits) {
    scale = ratio;
    view.title += " (lengths " + short_number(ratio) + " times as large: not to scale)";
  }
  view.camera.focal_point = view.bounds.center() + scale * (scene.camera.focal_point - scene.bounds.center());
  view.camera.view_height *= scale;
  return view;
}

namespace {

RenderedImage render_halves(const SceneView& view, int width, int height, int repeat, double budget,
                            bool error) {
  const auto [left, right] = halves_of(width, height);
  RenderedImage rendered = render_image(view, left.width, left.height, repeat, budget, error);
  rendered.image = join_panes({{left, std::move(rendered.image)},
                               {right, render_image(beside_view(view), right.width, right.height).image}},
                              view.background, width, height);
  return rendered;
}

}  // namespace

RenderedImage render_panes(const SceneView& view, int width, int height, int repeat, double budget,
                           bool error) {
  if (view.beside && !has_two_eyes(view)) return render_halves(view, width, height, repeat, budget, error);
  if (!view.volume || view.volume->panes.layout == 1)
    return render_image(view, width, height, repeat, budget, error);
  if (has_two_eyes(view))
    throw usage_error("--layout: slices are for one eye: leave out --stereo, or ask for --layout 1");
  const SlicePanes& panes = view.volume->panes;
  const std::vector<Pane> parts = panes_of(panes, width, height);
  RenderedImage rendered;
  std::vector<PaneImage> images;
  for (const Pane& pane : parts) {
    if (pane.plane) {
      images.push_back(
          {pane, render_image(pane_view(view, panes, parts, pane), pane.width, pane.height).image});
    } else {
      rendered = render_image(view, pane.width, pane.height, repeat, budget, error);
      images.push_back({pane, std::move(rendered.image)});
    }
  }
  rendered.image = join_panes(images, view.background, width, height);
  return rendered;
}

}  // namespace palpate
