#include "common/compose/text/plane_image_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {

std::vector<double> parse_contours(const std::string& text) {
  if (text.empty()) return {};
  const auto count = as_size(1 + std::count(text.begin(), text.end(), ','));
  return parse_numbers(text, count, "--contours " + text + ": values with ',' between are expected");
}

std::string contours_text(const std::vector<double>& contours) {
  std::string text;
  for (const double value : contours) text += (text.empty() ? "" : ",") + exact_number(value);
  return text;
}

PlaneImages plane_images_of(const VolumeOptions& options) {
  if (options.window && !(*options.window > 0.0 && std::isfinite(*options.window)))
    throw usage_error("--window: a finite number above zero is expected");
  if (options.level && !std::isfinite(*options.level))
    throw usage_error("--level: a finite number is expected");
  PlaneImages planes{.shown = options.plane_image, .contours = parse_contours(options.contours)};
  if (planes.contours.size() > kMostContours) {
    throw usage_error("--contours " + options.contours + ": at most " + std::to_string(kMostContours) +
                      " values are possible");
  }
  if (options.window && options.level) planes.window = ValueWindow{*options.window, *options.level};
  return planes;
}

void complete_window(PlaneImages& planes, const VolumeOptions& options, const ValueHistogram& histogram) {
  ValueWindow window = default_window(histogram);
  window.width = options.window.value_or(window.width);
  window.level = options.level.value_or(histogram.lower + 0.5 * window.width);
  planes.window = window;
}

}  // namespace palpate
