#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/json/json_parts.h"

namespace palpate {
namespace {

constexpr std::size_t kMostSeedsNamed = 10;

/// The first of the seeds, and where they lie.
Json positions_json(const std::vector<std::uint32_t>& seeds, const std::vector<Vec3>& points) {
  Json json = Json::array();
  for (const std::uint32_t seed : seeds) {
    if (json.size() == kMostSeedsNamed) break;
    json.push_back({{"seed", seed}, {"position", vec_json(points[seed])}});
  }
  return json;
}

/// The text of a run's JSON, with why it failed, where it did.
template <typename Summary>
std::string ended(Json json, const Summary& summary) {
  if (!summary.failure.empty()) {
    json["error"] = summary.failure;
    json["exit"] = 1;
  }
  return json_text(json);
}

}  // namespace

std::string trace_json(const TraceSummary& summary) {
  const TraceResult& result = summary.result;
  const LineErrors& errors = result.errors;
  Json steps = Json::object();
  for (int k = 0; k < kIntegratorCount; ++k) {
    if (const std::int64_t count = result.steps[as_size(k)]; count > 0)
      steps[std::string(name_of(static_cast<Integrator>(k)))] = count;
  }
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
            {"seeds", summary.seeds},
            {"seeds_left_out", result.seeds_left_out},
            {"seeds_outside", result.outside_seeds.size()},
            {"first_outside", positions_json(result.outside_seeds, summary.seed_points)},
            {"lines", result.lines.size()},
            {"points", result.points},
            {"ends", ends_json(result.ends)},
            {"integrator", name_of(result.integrator)},
            {"steps", steps},
            {"tolerance", summary.tolerance},
            {"max_length", summary.max_length},
            {"diagonal", summary.diagonal},
            {"error_max", errors.max},
            {"error_max_held", errors.worst},
            {"error_p95", errors.p95},
            {"error_median", errors.median},
            {"within_tolerance", errors.within ? Json(*errors.within) : Json(nullptr)},
            {"unheld", errors.unheld_seeds.size()},
            {"first_unheld", positions_json(errors.unheld_seeds, summary.seed_points)},
            {"threads", summary.threads},
            {"seconds_load", summary.seconds_load},
            {"seconds_prepare", result.seconds_prepare},
            {"seconds_trace", result.seconds_trace},
            {"seconds_write", summary.seconds_write},
            {"advice", summary.advice},
            {"version", version()}};
  if (summary.kind != LineKind::kStreamlines) {
    const InTime& in_time = summary.in_time;
    json["kind"] = name_of(summary.kind);
    json["in_time"] = {{"from", in_time.from},
                       {"until", in_time.until},
                       {"releases", in_time.releases},
                       {"steps", in_time.steps},
                       {"steps_in_memory", in_time.steps_in_memory},
                       {"error_sampling", in_time.sampling_known ? Json(in_time.sampling) : Json(nullptr)},
                       {"error_integration", in_time.integration},
                       {"largest_gap", in_time.gap},
                       {"moving_mesh", in_time.moving_mesh},
                       {"other_meshes", in_time.other_meshes},
                       {"torn", in_time.torn}};
  }
  return ended(std::move(json), summary);
}

std::string tract_json(const TractSummary& summary) {
  const TractResult& result = summary.result;
  const TractOptions& options = summary.options;
  const TractsDropped& dropped = result.dropped;
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
            {"seeds", summary.seeds},
            {"lines", result.lines.line_count()},
            {"points", result.lines.points.size()},
            {"ends", ends_json(result.end_counts)},
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
            {"error_max", summary.errors.max},
            {"error_max_held", summary.errors.worst},
            {"error_p95", summary.errors.p95},
            {"error_median", summary.errors.median},
            {"within_tolerance", summary.errors.within ? Json(*summary.errors.within) : Json(nullptr)},
            {"unheld", summary.errors.unheld_seeds.size()},
            {"threads", summary.threads},
            {"seconds_load", summary.seconds_load},
            {"seconds_prepare", summary.seconds_prepare},
            {"seconds_trace", result.seconds},
            {"seconds_write", summary.seconds_write},
            {"advice", summary.advice},
            {"version", version()}};
  return ended(std::move(json), summary);
}

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
                  {"best_turn", fit.best.text()},
                  {"turn_gain", std::isfinite(fit.gain) ? Json(fit.gain) : Json(nullptr)},
                  {"suspicious", fit.suspicious},
                  {"notes", summary.notes},
                  {"version", version()}};
  return json_text(json);
}

}  // namespace palpate
