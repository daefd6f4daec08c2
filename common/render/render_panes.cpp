#include "common/render/render_panes.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"

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

RenderedImage render_panes(const SceneView& view, int width, int height, int repeat, double budget,
                           bool error) {
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
