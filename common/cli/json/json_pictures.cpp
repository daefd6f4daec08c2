#include <cstdint>
#include <string>

#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/json/json_parts.h"

namespace palpate {
namespace {}  // namespace

std::string render_json(const RenderSummary& summary) {
  Json json{{"input", summary.input},
            {"field", summary.field},
            {"out", summary.output},
            {"width", summary.width},
            {"height", summary.height},
            {"lines", summary.lines},
            {"points", summary.points},
            {"seeds_left_out", summary.seeds_left_out},
            {"voxels", summary.voxels},
            {"first_frame_ms", summary.first_frame_ms},
            {"frame_ms", summary.frame_ms},
            {"frames_timed", summary.frames_timed},
            {"quality",
             {{"context_samples", summary.quality.context},
              {"focus_samples", summary.quality.focus},
              {"context_resolution", summary.quality.viewport},
              {"resolution", summary.quality.resolution},
              {"detail", summary.quality.detail}}},
            {"budget_held_by", summary.timer_query ? "timer queries" : "the clock"},
            {"image_error", summary.image_error},
            {"image_error_kind", summary.image_error_kind},
            {"seconds_load", summary.seconds_load},
            {"seconds_trace", summary.seconds_trace},
            {"renderer", summary.renderer},
            {"version", version()}};
  if (summary.frames > 1) {
    json["frames"] = summary.frames;
    json["frame_rate"] = summary.frame_rate;
    json.erase("image_error");  // is told of pictures
    json.erase("image_error_kind");
  }
  if (summary.expected_error) json["quality"]["expected_error"] = *summary.expected_error;
  if (const BrickShare& bricks = summary.bricks; bricks.all > 0)
    json["bricks"] = {{"held", bricks.held},       {"wanted", bricks.wanted}, {"all", bricks.all},
                      {"entered", bricks.entered}, {"left", bricks.left},     {"bytes", bricks.bytes}};
  for (const TakenScalar& taken : summary.volumes) {
    json["resampled"].push_back({{"scalar", taken.name},
                                 {"points", {taken.points.x, taken.points.y, taken.points.z}},
                                 {"error_rms", taken.error.rms},
                                 {"error_worst", taken.error.worst},
                                 {"outside", taken.error.outside},
                                 {"hidden", taken.error.hidden},
                                 {"compared", taken.error.compared}});
  }
  if (summary.picks) json["picked"] = nullptr;
  if (const auto& picked = summary.picked) {
    const Vec3& x = picked->place;
    json["picked"] = {{"what", name_of(*picked)}, {"x", x.x}, {"y", x.y}, {"z", x.z}};
  }
  if (const auto& estimate = summary.estimate) {
    json["image_error_spread"] = estimate->spread;
    json["image_error_worst"] = estimate->worst;
    json["image_error_pixels"] = estimate->pixels;
    json["image_error_of_asked_voxels"] = estimate->of_asked_voxels;
    json["image_error_ms"] = estimate->milliseconds;
  }
  if (!summary.tables_by.empty()) json["tables_by"] = summary.tables_by;
  return json_text(json);
}

std::string open_json(const WindowOutcome& outcome) {
  const ServoStatistics& statistics = outcome.servo.statistics;
  const auto spread = [](const TimeHistogram& times) {
    constexpr double kMicroseconds = 1e-3;
    const auto us = [&](std::uint64_t ns) { return kMicroseconds * static_cast<double>(ns); };
    return Json{{"us_p50", us(times.percentile_ns(0.5))},
                {"us_p99", us(times.percentile_ns(0.99))},
                {"us_p999", us(times.percentile_ns(0.999))},
                {"us_max", us(times.max_ns())}};
  };
  Json json{{"servo",
             {{"rate_hz", outcome.servo.rate},
              {"real_time_priority", outcome.servo.real_time.real_time_priority},
              {"memory_locked", outcome.servo.real_time.memory_locked},
              {"ticks", statistics.ticks},
              {"late", statistics.late},
              {"overruns", statistics.overruns},
              {"skipped", statistics.skipped},
              {"stalls", statistics.stalls},
              {"faults", statistics.faults},
              {"lateness", spread(statistics.lateness)},
              {"update", spread(statistics.update)}}},
            {"fault", outcome.fault},
            {"replay", outcome.replay}};
  return json_text(json);
}

}  // namespace palpate
