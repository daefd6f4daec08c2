#include "common/render/render_panes.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/slice/slice_panes.h"

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

RenderedImage render_panes(const SceneView& view, int width, int height, int repeat, double budget,
                           bool error) {
  if (!view.volume || view.volume->panes.layout == 1)
    return render_image(view, width, height, repeat, budget, error);
  if (has_two_eyes(view))
    throw usage_error("--layout: slices are for one eye: leave out --stereo, or ask for --layout 1");
  const SlicePanes& panes = view.volume->panes;
  const std::vector<Pane> parts = panes_of(panes, width, height);
  RenderedImage rendered;
  Image whole{width, height, std::vector<std::uint8_t>(4 * as_size(width) * as_size(height), 255)};
  for (std::size_t i = 0; i < whole.rgba.size(); ++i) {
    if (i % 4 != 3) whole.rgba[i] = view.background.is_light() ? 160 : 70;  // between panes
  }
  for (const Pane& pane : parts) {
    if (pane.plane) {
      paste(render_image(pane_view(view, panes, parts, pane), pane.width, pane.height).image, pane, whole);
      continue;
    }
    rendered = render_image(view, pane.width, pane.height, repeat, budget, error);
    paste(rendered.image, pane, whole);
  }
  rendered.image = std::move(whole);
  return rendered;
}

}  // namespace palpate
