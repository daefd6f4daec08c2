/// What the render verb and the window show of a field: its lines, domain and labels.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"
#include "common/trace/trace.h"

namespace palpate {

/// Seeds of a global view where none are given: where the fluid moves, few enough to see through.
inline constexpr const char* kViewSeeds = "speed:300";
/// Length of its lines in diagonals: longer ones fill the picture with the same few vortices.
inline constexpr double kViewDiagonals = 1.0;

/// The options of tracing with the defaults of a global view: both directions, lines of kViewDiagonals.
[[nodiscard]] TraceOptions view_trace_options(const Document& options, const VectorField& field);

/// "azimuth,elevation,roll,zoom"; empty: the default view.
/// @throws Error (usage).
[[nodiscard]] CameraAngles camera_angles(const std::string& text);

/// What `--focal` says; none where it says nothing. @throws Error (usage).
[[nodiscard]] std::optional<Vec3> focal_point_of(const ViewOptions& options);

/// The camera that `--camera` and `--focal` name, before `bounds`. @throws Error (usage).
[[nodiscard]] Camera camera_of(const ViewOptions& options, const Box& bounds, double aspect,
                               Projection projection = Projection::kPerspective);

/// The angles of a camera that looks at the box, as `--camera` writes them; the focal point is not part of
/// them.
[[nodiscard]] std::string camera_text(const Camera& camera, const Box& bounds, double aspect);

/// A scene of `lines` seen by the camera that `options` name.
/// @param aspect width / height of the picture.
[[nodiscard]] SceneView make_line_view(const std::string& title, const VectorField& field,
                                       std::shared_ptr<const std::vector<Line>> lines,
                                       const Document& options, const LineStyle& style, double aspect);
/// The same with the title of the input, and its time where it has several.
[[nodiscard]] SceneView make_line_view(const Input& input, const VectorField& field,
                                       std::shared_ptr<const std::vector<Line>> lines,
                                       const Document& options, const LineStyle& style, double aspect);

}  // namespace palpate
