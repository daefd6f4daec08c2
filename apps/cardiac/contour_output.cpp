#include "apps/cardiac/contour_output.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/plane_image_text.h"
#include "common/trace/isosurface/surface_contours.h"

namespace palpate {
namespace {

constexpr std::size_t kMostValues = 1000;
/// Of the largest coordinate: a place is never more exact.
constexpr double kRounding = 0x1p-44;
/// Directions have no sign: an angle of 90 degrees is one of -90.
constexpr double kPeriodOfAngles = 180.0;

std::vector<double> values_of(const HeartOptions& options, double lowest, double highest) {
  if (!options.contour_values.empty()) return parse_contours(options.contour_values);
  const double first = std::ceil(lowest / options.contours), last = std::floor(highest / options.contours);
  if (last - first >= static_cast<double>(kMostValues))
    throw usage_error("--contour-spacing " + short_number(options.contours) + ": more than " +
                      std::to_string(kMostValues) + " values from " + short_number(lowest) + " to " +
                      short_number(highest));
  std::vector<double> values;
  for (int n = 0; first + n <= last; ++n) values.push_back((first + n) * options.contours);
  return values;
}

/// From a value of an angle or another one.
double apart(double value, double from, bool angle) {
  return angle ? std::remainder(value - from, kPeriodOfAngles) : value - from;
}

}  // namespace

bool wants_contours(const HeartOptions& options) {
  const bool listed = !options.contour_values.empty();
  if (listed && options.contours > 0.0)
    throw usage_error(
        "--contours lists the values, --contour-spacing says how far apart they are: one of them");
  if (listed) (void)parse_contours(options.contour_values);
  return listed || options.contours > 0.0;
}

LayerContours make_layer_contours(const LayeredHeart& heart, const AngleProbe& probe, const Document& options,
                                  Progress* progress) {
  LayerContours out;
  out.depth = layer_of(options.heart).value_or(kViewLayer);
  const IsosurfaceMesh mesh = layer_mesh(heart, out.depth, progress);
  const std::vector<double> found = values_at(probe, mesh.points, options.common.threads);
  out.lowest = std::numeric_limits<double>::infinity();
  out.highest = -out.lowest;
  for (const double value : found) {
    if (!std::isfinite(value)) continue;
    out.lowest = std::min(out.lowest, value);
    out.highest = std::max(out.highest, value);
  }
  const Box& bounds = heart.heart().layer->bounds();
  const Vec3 farthest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
  const double rounding = kRounding * std::max({farthest.x, farthest.y, farthest.z});
  const bool angle = probe.is_angle();
  const double most = angle ? 0.5 * kPeriodOfAngles : std::numeric_limits<double>::infinity();
  std::vector<double> above(found.size());
  CellHint hint;
  if (out.lowest <= out.highest) {
    const std::vector<double> values = values_of(options.heart, out.lowest, out.highest);
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (progress) progress->check();
      for (std::size_t p = 0; p < found.size(); ++p) above[p] = apart(found[p], values[v], angle);
      for (const SurfaceContour& contour : surface_contours(mesh, above, most)) {
        const bool closed = contour.front().position == contour.back().position;
        Line line{.end = closed ? End::kLoop : End::kLeftDomain, .seed = static_cast<std::uint32_t>(v)};
        double arc = 0.0;
        for (const EdgePoint& at : contour) {
          if (!line.points.empty()) arc += glm::distance(line.points.back().position, at.position);
          const double steep = (above[at.above] - above[at.below]) /
                               glm::distance(mesh.points[at.above], mesh.points[at.below]);
          const double off = std::abs(apart(probe.at(at.position, hint), values[v], angle)) / steep;
          line.points.push_back(
              {.position = at.position, .arc = arc, .error = rounding + (std::isfinite(off) ? off : 0.0)});
        }
        out.values.values.insert(out.values.values.end(), line.points.size(), values[v]);
        out.lines.push_back(std::move(line));
      }
    }
  }
  if (!out.lines.empty()) return out;
  throw work_error("no line at depth " + short_number(out.depth) + ": " + probe.name() +
                   (out.lowest <= out.highest ? " reaches from " + short_number(out.lowest) + " to " +
                                                    short_number(out.highest) + " there"
                                              : " is not defined there"));
}

}  // namespace palpate
