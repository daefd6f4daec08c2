#include "common/app/cli/json_output.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/app/haptic/grid_mode.h"
#include "common/app/haptic/linear_mode.h"
#include "common/base/version.h"
#include "common/haptics/widget/widget_text.h"

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostSeedsNamed = 10;

/// File names need not be UTF-8, JSON does.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

Json vec_json(const Vec3& x) { return {x.x, x.y, x.z}; }
Json box_json(const Box& box) { return {{"lower", vec_json(box.lower)}, {"upper", vec_json(box.upper)}}; }

Json needs_json(const Needs& needs) {
  Json list = Json::array();
  for (const Need& need : needs) {
    list.push_back({{"what", need.what},
                    {"why", need.why},
                    {"used", need.used},
                    {"bytes", need.bytes},
                    {"milliseconds", need.milliseconds}});
  }
  return list;
}

Json measured_json(const std::vector<MeasuredCost>& measured) {
  Json costs = Json::object();
  for (const MeasuredCost& cost : measured)
    costs[std::string(cost.what)] = {{"milliseconds", cost.milliseconds}, {"bytes", cost.bytes}};
  return costs;
}

Json gpu_json(const std::vector<GpuObject>& objects) {
  Json list = Json::array();
  for (const GpuObject& object : objects)
    list.push_back({{"kind", name_of(object.kind)}, {"what", object.what}, {"bytes", object.bytes}});
  return list;
}

/// The plan with its estimates, and what the work took in the end.
void add_plan(Json& json, const Needs& plan, const std::vector<MeasuredCost>& measured) {
  if (plan.empty()) return;
  json["plan"] = needs_json(plan);
  json["measured"] = measured_json(measured);
}

Json array_json(const ArraySummary& array) {
  Json ranges = Json::array();
  for (const ComponentRange& range : array.ranges) ranges.push_back({range.lower, range.upper});
  const std::uint64_t bytes = static_cast<std::uint64_t>(array.info.tuples) *
                              static_cast<std::uint64_t>(array.info.components) * byte_size(array.info.type);
  return {{"name", array.info.name},
          {"on", array.info.association == Association::kCell ? "cell" : "point"},
          {"components", array.info.components},
          {"type", name_of(array.info.type)},
          {"tuples", array.info.tuples},
          {"bytes", bytes},
          {"ranges", ranges},
          {"bad_values", array.bad_values}};
}

Json blocks_json(const FileInfo& file) {
  Json blocks = Json::array();
  for (const BlockInfo& block : file.blocks) {
    Json json{{"name", block.name}, {"grid", block.grid}};
    if (block.points.x > 0) json["size"] = {block.points.x, block.points.y, block.points.z};
    json["points"] = block.point_count;
    json["cells"] = block.cell_count;
    json["bounds"] = box_json(block.bounds);
    blocks.push_back(std::move(json));
  }
  return blocks;
}

}  // namespace

std::string error_json(const std::string& line, int exit_code) {
  return text_of({{"error", line}, {"exit", exit_code}});
}

std::string examples_json(const std::vector<ExampleInfo>& examples) {
  Json list = Json::array();
  for (const ExampleInfo& example : examples)
    list.push_back({{"name", example.name}, {"summary", example.summary}});
  return text_of({{"examples", list}});
}

std::string trace_json(const TraceSummary& summary) {
  const TraceResult& result = summary.result;
  Json ends = Json::object();
  for (int e = 0; e < kEndCount; ++e) {
    ends[std::string(name_of(static_cast<End>(e)))] = result.ends[static_cast<std::size_t>(e)];
  }
  Json outside = Json::array();
  for (const std::uint32_t seed : result.outside_seeds) {
    if (outside.size() == kMostSeedsNamed) break;
    outside.push_back({{"seed", seed}, {"position", vec_json(summary.seed_points[seed])}});
  }
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
            {"seeds", summary.seeds},
            {"seeds_outside", result.outside_seeds.size()},
            {"first_outside", outside},
            {"lines", result.lines.size()},
            {"points", result.points},
            {"ends", ends},
            {"integrator", name_of(result.integrator)},
            {"tolerance", summary.tolerance},
            {"max_length", summary.max_length},
            {"diagonal", summary.diagonal},
            {"error_max", result.error_max},
            {"threads", summary.threads},
            {"seconds_load", summary.seconds_load},
            {"seconds_prepare", result.seconds_prepare},
            {"seconds_trace", result.seconds_trace},
            {"seconds_write", summary.seconds_write},
            {"advice", summary.advice},
            {"version", version()}};
  if (!summary.failure.empty()) {
    json["error"] = summary.failure;
    json["exit"] = 1;
  }
  add_plan(json, summary.plan, summary.measured);
  return text_of(json);
}

std::string tract_json(const TractSummary& summary) {
  const TractResult& result = summary.result;
  const TractOptions& options = summary.options;
  const TractsDropped& dropped = result.dropped;
  Json ends = Json::object();
  for (int e = 0; e < kEndCount; ++e) {
    ends[std::string(name_of(static_cast<End>(e)))] = result.end_counts[static_cast<std::size_t>(e)];
  }
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
            {"seeds", summary.seeds},
            {"lines", result.lines.line_count()},
            {"points", result.lines.points.size()},
            {"ends", ends},
            {"dropped",
             {{"seeds_outside", dropped.outside},
              {"seeds_bad_data", dropped.bad_data},
              {"seeds_below_cutoff", dropped.below_cutoff},
              {"lines_too_short", dropped.too_short},
              {"lines_not_included", dropped.not_included},
              {"lines_excluded", dropped.excluded}}},
            {"integrator", name_of(options.integrator)},
            {"tolerance", options.tolerance},
            {"measure", name_of(options.measure)},
            {"cutoff", options.cutoff},
            {"step", result.step},
            {"max_angle", result.max_angle},
            {"min_length", options.min_length},
            {"max_length", result.max_length},
            {"error_max", result.error_max},
            {"threads", summary.threads},
            {"seconds_load", summary.seconds_load},
            {"seconds_prepare", summary.seconds_prepare},
            {"seconds_trace", result.seconds},
            {"seconds_write", summary.seconds_write},
            {"advice", summary.advice},
            {"version", version()}};
  if (!summary.failure.empty()) {
    json["error"] = summary.failure;
    json["exit"] = 1;
  }
  add_plan(json, summary.plan, summary.measured);
  return text_of(json);
}

namespace {

Json lines_json(const LinesSummary& lines) {
  return {{"lines", lines.lines},
          {"points", lines.points},
          {"length_min", lines.lengths.least},
          {"length_median", lines.lengths.median},
          {"length_mean", lines.lengths.mean},
          {"length_max", lines.lengths.most},
          {"length_bin", lines.lengths.bin},
          {"length_histogram", lines.lengths.histogram}};
}

}  // namespace

std::string tract_fit_json(const TractFitSummary& summary) {
  const TractFit& fit = summary.fit;
  const Json json{{"input", summary.input},
                  {"tracts", summary.tracts},
                  {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                  {"turn", summary.turn.empty() ? Json(nullptr) : Json(summary.turn)},
                  {"lengths", lines_json(summary.lines)},
                  {"pieces", fit.pieces},
                  {"inside", fit.inside},
                  {"angle", fit.angle},
                  {"score", fit.score},
                  {"best_turn", fit.best.words()},
                  {"turn_gain", std::isfinite(fit.gain) ? Json(fit.gain) : Json(nullptr)},
                  {"suspicious", fit.suspicious},
                  {"notes", summary.notes},
                  {"version", version()}};
  return text_of(json);
}

std::string info_json(const InfoSummary& summary) {
  const Input& input = *summary.input;
  Json json{{"input", input.title()}};
  if (const FileInfo* file = input.file()) {
    json["format"] = file->format;
    json["loader"] = file->loader;
    json["blocks"] = blocks_json(*file);
    Json arrays = Json::array();
    for (const ArraySummary& array : summary.arrays) arrays.push_back(array_json(array));
    json["arrays"] = std::move(arrays);
    json["not_volume"] = input.not_volume().empty() ? Json(nullptr) : Json(input.not_volume());
    json["fields"] = input.fields();
    json["times"] = file->times;
    json["orientation"] = summary.orientation;
    json["units"] = file->units.empty() ? Json(nullptr) : Json(file->units);
    json["space"] = file->anatomical ? Json("RAS") : Json(nullptr);
  } else {
    json["format"] = "formula";
    json["fields"] = {"velocity"};
    json["times"] = Json::array();
  }
  json["field"] = summary.field.empty() ? Json(nullptr) : Json(summary.field);
  if (input.spec().kind == FieldKind::kVector) {
    json["max_speed"] = summary.max_speed;
  } else if (input.spec().kind == FieldKind::kTensor) {
    json["largest_trace"] = summary.largest_trace;
    json["negative_tensors"] = summary.negative_tensors;
  } else if (summary.field_range) {
    json["range"] = {summary.field_range->lower, summary.field_range->upper};
  }
  if (input.spec().kind == FieldKind::kFibre)
    json["no_layers"] = summary.no_layers.empty() ? Json(nullptr) : Json(summary.no_layers);
  if (summary.tracts) json["tracts"] = lines_json(*summary.tracts);
  json["bounds"] = box_json(summary.bounds);
  json["diagonal"] = summary.bounds.diagonal();
  json["memory_bytes"] = summary.memory_bytes;
  json["notes"] = summary.notes;
  json["seconds_load"] = summary.seconds_load;
  if (!summary.plans.empty()) {
    Json plans = Json::object();
    for (const auto& plan : summary.plans) plans[plan.verb] = needs_json(plan.plan);
    json["plan"] = std::move(plans);
    json["measured"] = measured_json(summary.measured);
  }
  return text_of(json);
}

std::string image_json(const ImageSummary& summary) {
  const Json json{{"input", summary.input},
                  {"field", summary.field},
                  {"out", summary.output},
                  {"what", summary.what},
                  {"voxels", summary.voxels},
                  {"with_tensor", summary.with_tensor},
                  {"lifted", summary.lifted},
                  {"unusable", summary.unusable},
                  {"negative", summary.negative},
                  {"suggested_turn", summary.turn},
                  {"turn_gain", summary.gain},
                  {"notes", summary.notes},
                  {"seconds_load", summary.seconds_load},
                  {"seconds_made", summary.seconds_made},
                  {"seconds_write", summary.seconds_write},
                  {"version", version()}};
  return text_of(json);
}

std::string lattice_json(const LatticeSummary& summary) {
  const auto list = [](const Vec3& v) { return Json{v.x, v.y, v.z}; };
  const UniformTopology& lattice = summary.lattice;
  const Json json{{"input", summary.input},
                  {"field", summary.field},
                  {"out", summary.output},
                  {"size", {lattice.points.x, lattice.points.y, lattice.points.z}},
                  {"origin", list(lattice.origin)},
                  {"axes", {list(lattice.axes[0]), list(lattice.axes[1]), list(lattice.axes[2])}},
                  {"right", summary.right},
                  {"up", summary.up},
                  {"outside", summary.outside},
                  {"range", {summary.lowest, summary.highest}},
                  {"window", summary.window},
                  {"level", summary.level},
                  {"lines", summary.lines},
                  {"seconds_load", summary.seconds_load},
                  {"seconds_made", summary.seconds_made},
                  {"version", version()}};
  return text_of(json);
}

std::string render_json(const RenderSummary& summary) {
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"out", summary.output},
            {"width", summary.width},
            {"height", summary.height},
            {"lines", summary.lines},
            {"points", summary.points},
            {"voxels", summary.voxels},
            {"first_frame_ms", summary.first_frame_ms},
            {"frame_ms", summary.frame_ms},
            {"frames_timed", summary.frames_timed},
            {"quality",
             {{"context_samples", summary.quality.context},
              {"focus_samples", summary.quality.focus},
              {"context_resolution", summary.quality.viewport},
              {"resolution", summary.quality.resolution}}},
            {"image_error", summary.image_error},
            {"image_error_kind", summary.image_error_kind},
            {"seconds_load", summary.seconds_load},
            {"seconds_trace", summary.seconds_trace},
            {"renderer", summary.renderer},
            {"version", version()}};
  if (const BrickShare& bricks = summary.bricks; bricks.all > 0)
    json["bricks"] = {
        {"held", bricks.held}, {"wanted", bricks.wanted}, {"all", bricks.all}, {"bytes", bricks.bytes}};
  if (!summary.plan.empty()) json["gpu"] = gpu_json(summary.gpu);
  add_plan(json, summary.plan, summary.measured);
  return text_of(json);
}

std::string open_json(const OpenSummary& summary) {
  const ServoStatistics& statistics = summary.servo.statistics;
  const auto spread = [](const TimeHistogram& times) {
    constexpr double kMicroseconds = 1e-3;
    const auto us = [&](std::uint64_t ns) { return kMicroseconds * static_cast<double>(ns); };
    return Json{{"us_p50", us(times.percentile_ns(0.5))},
                {"us_p99", us(times.percentile_ns(0.99))},
                {"us_p999", us(times.percentile_ns(0.999))},
                {"us_max", us(times.max_ns())}};
  };
  Json json{{"servo",
             {{"rate_hz", summary.servo.rate},
              {"real_time_priority", summary.servo.real_time.real_time_priority},
              {"memory_locked", summary.servo.real_time.memory_locked},
              {"ticks", statistics.ticks},
              {"late", statistics.late},
              {"overruns", statistics.overruns},
              {"skipped", statistics.skipped},
              {"stalls", statistics.stalls},
              {"faults", statistics.faults},
              {"lateness", spread(statistics.lateness)},
              {"update", spread(statistics.update)}}},
            {"fault", summary.fault},
            {"replay", summary.replay}};
  return text_of(json);
}

std::string map_json(const MapSummary& summary) {
  Json bands = Json::array();
  for (const MapSummary::Band& band : summary.bands) {
    if (band.points == 0) continue;
    bands.push_back(
        {{"depth", band.depth}, {"mean", band.mean}, {"deviation", band.deviation}, {"points", band.points}});
  }
  const bool angle = !summary.convention.empty();
  return text_of({{"input", summary.input},
                  {"field", summary.field},
                  {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                  {"angle", summary.angle},
                  {"convention", angle ? Json(summary.convention) : Json(nullptr)},
                  {"axis", angle ? vec_json(summary.axis) : Json(nullptr)},
                  {"points", summary.points},
                  {"undefined", summary.undefined},
                  {"bands", bands},
                  {"lines", summary.lines},
                  {"layer", summary.layer ? Json(*summary.layer) : Json(nullptr)},
                  {"seconds_load", summary.seconds_load},
                  {"seconds_map", summary.seconds_map},
                  {"version", version()}});
}

std::string series_json(const SeriesSummary& summary) {
  Json places = Json::array();
  for (std::size_t p = 0; p < summary.places.size(); ++p) {
    Json values = Json::array();
    for (std::size_t t = 0; t < summary.times.size(); ++t) {
      const double value = summary.values[t * summary.places.size() + p];
      values.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    }
    places.push_back({{"position", vec_json(summary.places[p])}, {"values", std::move(values)}});
  }
  return text_of({{"input", summary.input},
                  {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                  {"value", summary.value},
                  {"times", summary.times},
                  {"unordered", summary.unordered},
                  {"places", std::move(places)},
                  {"seconds", summary.seconds},
                  {"version", version()}});
}

std::string convert_json(const ConvertSummary& summary) {
  return text_of({{"input", summary.input},
                  {"files", summary.files},
                  {"times", summary.times},
                  {"seconds", summary.seconds},
                  {"version", version()}});
}

std::string mesh_json(const MeshSummary& summary) {
  const MeshQuality& quality = summary.quality;
  const bool curved = summary.exact_volume > 0.0;
  const double reference = curved ? summary.exact_volume : summary.cells_volume;
  return text_of({{"input", summary.input},
                  {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                  {"mesher", summary.mesher},
                  {"points", quality.points},
                  {"tetrahedra", quality.cells},
                  {"volume", quality.volume},
                  {"volume_exact", curved ? Json(summary.exact_volume) : Json(nullptr)},
                  {"volume_cells", summary.cells_volume},
                  {"volume_error", quality.volume / reference - 1.0},
                  {"outside", summary.outside},
                  {"border_slivers", summary.flat},
                  {"in_one_cell", summary.shared},
                  {"angle_min", quality.least_angle},
                  {"angle_max", quality.largest_angle},
                  {"angles_min_by_10", quality.least_angles},
                  {"angles_max_by_10", quality.largest_angles},
                  {"slivers", quality.slivers},
                  {"zero_volume", quality.zero_volume},
                  {"components", quality.components},
                  {"largest_component", quality.largest_component},
                  {"border_faces", quality.border_faces},
                  {"open_edges", quality.open_edges},
                  {"manifold_faults", quality.manifold_faults},
                  {"folded_faces", quality.folded_faces},
                  {"layer_cells", summary.layer_cells},
                  {"backward_cells", summary.backward_cells},
                  {"notes", summary.notes},
                  {"seconds_load", summary.seconds_load},
                  {"seconds_mesh", summary.seconds_mesh},
                  {"seconds_triangulate", summary.seconds_triangulate},
                  {"seconds_choose", summary.seconds_choose},
                  {"seconds_report", summary.seconds_report},
                  {"version", version()}});
}

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
  return text_of(Json{{"input", summary.input},
                      {"out", summary.output},
                      {"annotations", list},
                      {"outside", summary.outside},
                      {"version", version()}});
}

std::string probe_json(const ProbeSummary& summary) {
  Json states = Json::object();
  for (int s = 0; s < kHoldStateCount; ++s) {
    states[std::string(name_of(static_cast<HoldState>(s)))] = summary.states[static_cast<std::size_t>(s)];
  }
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"mode", summary.mode},
            {"out", summary.output},
            {"steps", summary.steps},
            {"states", states},
            {"faults", summary.states[static_cast<std::size_t>(HoldState::kFault)]},
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
            {"max_residual", summary.max_residual},
            {"max_residual_per_diagonal", summary.max_residual / summary.diagonal},
            {"us_p50", summary.us_p50},
            {"us_p99", summary.us_p99},
            {"us_max", summary.us_max},
            {"seconds_load", summary.seconds_load},
            {"seconds_probe", summary.seconds_probe},
            {"version", version()}};
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
      const PlanePose& pose = summary.planes.pose[static_cast<std::size_t>(i)];
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
  add_plan(json, summary.plan, summary.measured);
  return text_of(json);
}

std::string report_summary_json(const std::string& folder, std::size_t rows, std::size_t failed_cases,
                                double seconds) {
  return text_of({{"out", folder},
                  {"work_precision_rows", rows},
                  {"stability_cases_failed", failed_cases},
                  {"seconds", seconds},
                  {"version", version()}});
}

}  // namespace palpate
