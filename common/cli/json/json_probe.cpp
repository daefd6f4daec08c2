#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "common/base/index.h"
#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/json/json_parts.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/linear_mode.h"
#include "common/haptics/widget/widget_text.h"

namespace palpate {

std::string annotation_json(const AnnotationSummary& summary) {
  Json list = Json::array();
  std::size_t at = 0;
  for (const Annotation& each : summary.annotations) {
    Json points = Json::array(), values = Json::array();
    for (const Vec3& x : each.points) {
      points.push_back({x.x, x.y, x.z});
      values.push_back(std::isfinite(summary.values[at]) ? Json(summary.values[at]) : Json());
      ++at;
    }
    const double measured = measure_of(each);
    list.push_back({{"kind", name_of(each.kind)},
                    {"label", each.label},
                    {"measure", std::isfinite(measured) ? Json(measured) : Json()},
                    {"points", points},
                    {"values", values}});
  }
  return json_text(Json{{"input", summary.input},
                        {"out", summary.output},
                        {"annotations", list},
                        {"outside", summary.outside},
                        {"version", version()}});
}

std::string probe_json(const ProbeSummary& summary) {
  Json states = Json::object();
  for (int s = 0; s < kHoldStateCount; ++s) {
    states[std::string(name_of(static_cast<HoldState>(s)))] = summary.states[as_size(s)];
  }
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"mode", summary.mode},
            {"out", summary.output},
            {"steps", summary.steps},
            {"states", states},
            {"faults", summary.states[as_size(HoldState::kFault)]},
            {"stiffness_n_per_m", summary.settings.stiffness},
            {"chain_force", name_of(kDefaultChainForceForm)},
            {"release_mm", 1e3 * summary.settings.streamline.release_distance},
            {"drag_mm", 1e3 * summary.settings.drag.threshold},
            {"tick_interval", summary.settings.ticks.interval},
            {"tick_stiffness", summary.settings.ticks.stiffness},
            {"speed_force_n", summary.settings.streamline.speed_force},
            {"force_cap_n", summary.limits.force_cap},
            {"slew_cap_n_per_s", summary.limits.slew_cap},
            {"workspace_scale_m_per_unit", summary.workspace_scale},
            {"max_force_n", summary.max_force},
            {"perceived_stiffness_min_n_per_m", summary.least_perceived},
            {"max_residual", summary.max_residual},
            {"max_residual_per_diagonal", summary.max_residual / summary.diagonal},
            {"us_p50", summary.us_p50},
            {"us_p99", summary.us_p99},
            {"us_max", summary.us_max},
            {"seconds_load", summary.seconds_load},
            {"seconds_probe", summary.seconds_probe},
            {"version", version()}};
  if (!summary.fixtures.empty()) json["fixtures"] = summary.fixtures;
  if (!summary.scalar.empty()) {
    const IsosurfaceSettings& surface = summary.settings.isosurface;
    json["scalar"] = summary.scalar;
    json["isovalues"] = std::vector<double>(surface.isovalues.value.begin(),
                                            surface.isovalues.value.begin() + surface.isovalues.count);
    json["surface"] = name_of(surface.hold);
    json["depth_mm"] = 1e3 * surface.depth;
    json["snap_mm"] = 1e3 * surface.snap_distance;
  }
  if (summary.mode == kLinearMode) {
    Json& linear = json["linear"] = Json::object();
    for (const auto& [option, value] : linear_options(summary.settings.linear)) linear[option] = value;
  }
  if (summary.mode == kGridMode) {
    Json& grid = json["grid"] = Json::object();
    for (const auto& [option, value] : grid_options(summary.settings.grid_axis)) grid[option] = value;
    Json& landmarks = json["landmarks"] = Json::array();
    for (const Vec4& plane : summary.landmarks) landmarks.push_back({plane.x, plane.y, plane.z, plane.w});
    if (const auto& box = summary.box) {
      json["box"] = {box->lower.x, box->lower.y, box->lower.z, box->upper.x, box->upper.y, box->upper.z};
    }
    if (summary.focal_point) json["focal"] = vec_json(*summary.focal_point);
  }
  if (summary.mode == kPlaneWidgetMode) {
    Json& planes = json["planes"] = Json::array();
    for (int i = 0; i < summary.planes.count; ++i) {
      const PlanePose& pose = summary.planes.pose[as_size(i)];
      const Vec4 plane = plane_of_pose(pose);
      planes.push_back({{"normal", {plane.x, plane.y, plane.z}},
                        {"d", plane.w},
                        {"center", {pose.center.x, pose.center.y, pose.center.z}},
                        {"quaternion", {pose.turn.x, pose.turn.y, pose.turn.z, pose.turn.w}}});
    }
  }
  if (!summary.tract.empty()) {
    json["tract"] = summary.tract;
    json["tracts"] = summary.tracts;
  }
  if (!summary.device.empty()) json["device"] = summary.device;
  if (!summary.replay.empty()) {
    json["replay"] = summary.replay;
    json["replay_differs"] = summary.replay_differs;
    json["changed_inputs"] = summary.changed_inputs;
  }
  return json_text(json);
}

}  // namespace palpate
