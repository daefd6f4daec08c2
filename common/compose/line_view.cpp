#include "common/compose/line_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/domain_outline.h"
#include "common/compose/trace_options.h"
#include "common/compose/volume_scene.h"
#include "common/trace/unsteady/trace_unsteady.h"

namespace palpate {
namespace {

// What lines take that are drawn, of what they take alone: corners, segments and colours, here and on the graphics
// card. Measured: 390 bytes a point (200 and 1000 seeds in the carotid), of which 56 are the line's.
constexpr std::uint64_t kDrawnShare = 7;

}  // namespace

TraceOptions view_trace_options(const Document& options, const VectorField& field) {
  TraceOptions trace = trace_options(options, "both");
  if (trace.max_length == 0.0) trace.max_length = kViewDiagonals * field.diagonal();
  trace.memory = std::max<std::uint64_t>(1, trace.memory / kDrawnShare);
  // Particles go one way in time.
  if (options.tracing.lines != name_of(LineKind::kStreamlines) && trace.forward) trace.backward = false;
  return trace;
}

CameraAngles camera_angles(const std::string& text) {
  CameraAngles angles;
  if (text.empty()) return angles;
  const auto v =
      parse_numbers(text, 4, "--camera takes azimuth,elevation,roll,zoom in degrees, such as 30,20,0,1");
  angles = {.azimuth = v[0], .elevation = v[1], .roll = v[2], .zoom = v[3]};
  if (!(angles.zoom > 0.0)) throw usage_error("--camera " + text + ": the zoom must be above zero");
  return angles;
}

std::optional<Vec3> focal_point_of(const ViewOptions& options) {
  if (options.focal.empty()) return std::nullopt;
  const auto v = parse_numbers(options.focal, 3, "--focal takes a place x,y,z of the data, such as 10,20,0");
  return Vec3{v[0], v[1], v[2]};
}

Camera camera_of(const ViewOptions& options, const Box& bounds, double aspect, Projection projection) {
  Camera camera = make_camera(bounds, camera_angles(options.camera), aspect, projection);
  camera.focal_point = focal_point_of(options).value_or(camera.focal_point);
  return camera;
}

std::string camera_text(const Camera& camera, const Box& bounds, double aspect) {
  const auto degrees = [](double radians) { return radians * 180.0 / std::numbers::pi; };
  // The inverse of make_camera(): the axis towards the viewer gives azimuth and elevation, what is left is
  // roll.
  const Vec3 back = camera.axes[2];
  CameraAngles angles;
  angles.azimuth = degrees(std::atan2(back.x, -back.y));
  angles.elevation = degrees(std::asin(std::clamp(back.z, -1.0, 1.0)));
  const Camera level = make_camera(bounds, angles, aspect, camera.projection);
  angles.roll =
      -degrees(std::atan2(glm::dot(camera.axes[0], level.axes[1]), glm::dot(camera.axes[0], level.axes[0])));
  angles.zoom = level.view_height / camera.view_height;
  // Finer than any picture shows, and free of what rounding leaves of round numbers.
  const auto rounded = [](double value, double parts) {
    return exact_number(std::round(value * parts) / parts + 0.0);
  };
  constexpr double kOfDegree = 1e6, kOfZoom = 1e9;
  return rounded(angles.azimuth, kOfDegree) + "," + rounded(angles.elevation, kOfDegree) + "," +
         rounded(angles.roll, kOfDegree) + "," + rounded(angles.zoom, kOfZoom);
}

SceneView make_line_view(const std::string& title, const VectorField& field,
                         std::shared_ptr<const std::vector<Line>> lines, const Document& options,
                         const LineStyle& style, double aspect) {
  SceneView view;
  view.bounds = field.bounds();
  view.lines = std::move(lines);
  view.outline = domain_outline(field);
  view.style = style;
  apply_appearance(options, view);
  view.title = title;
  view.subtitle = field.name() + ", " + counted(view.lines ? view.lines->size() : 0, "line");
  view.camera = camera_of(options.view, view.bounds, aspect, projection_of(options.volume));
  return view;
}

SceneView make_line_view(const Input& input, const VectorField& field,
                         std::shared_ptr<const std::vector<Line>> lines, const Document& options,
                         const LineStyle& style, double aspect) {
  SceneView view = make_line_view(input.title(), field, std::move(lines), options, style, aspect);
  if (input.times().size() > 1) view.subtitle += ", time " + short_number(input.times()[input.time().step]);
  return view;
}

}  // namespace palpate
