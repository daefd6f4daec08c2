#include "common/render/transparent_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/render/render_panes.h"

namespace palpate {

Image transparent_picture(SceneView view, int width, int height) {
  constexpr double kApart =
      0.4;  // far enough for a hundred steps of alpha, near enough to be both dark or light
  const bool light = view.background.is_light();
  const double first = light ? 1.0 : 0.0, second = light ? 1.0 - kApart : kApart;
  const auto on = [&](double grey) {
    const Rgb color(static_cast<float>(grey));
    view.background = {color, color};
    return render_panes(view, width, height).image;
  };
  Image picture = on(first);
  const Image other = on(second);
  constexpr double kFull = 255.0;
  for (std::size_t i = 0; i + 3 < picture.rgba.size(); i += 4) {
    double apart = 0.0;
    for (std::size_t c = 0; c < 3; ++c) apart += (picture.rgba[i + c] - other.rgba[i + c]) / (3.0 * kFull);
    // A level of either picture is rounding, and dither of the background.
    double alpha = std::clamp(1.0 - apart / (first - second), 0.0, 1.0);
    constexpr double kRounding = 1.5 / (kApart * kFull);
    if (alpha < kRounding) alpha = 0.0;
    if (alpha > 1.0 - kRounding) alpha = 1.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double behind = (1.0 - alpha) * first * kFull;
      const double color = alpha > 0.0 ? (picture.rgba[i + c] - behind) / alpha : 0.0;
      picture.rgba[i + c] = static_cast<std::uint8_t>(std::lround(std::clamp(color, 0.0, kFull)));
    }
    picture.rgba[i + 3] = static_cast<std::uint8_t>(std::lround(alpha * kFull));
  }
  return picture;
}

}  // namespace palpate
