#include "common/compose/trace_options.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/memory.h"
#include "common/base/text.h"

namespace palpate {
namespace {

StopRule stop_plane(const std::string& text) {
  const auto v = parse_numbers(text, 4, "--stop-plane takes nx,ny,nz,d for the plane n.x = d");
  // Of numbers near one: the square of a normal of 1e300 or 1e-300 is none.
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0.0)) throw usage_error("--stop-plane " + text + ": the normal is zero");
  const Vec3 n{v[0] / largest, v[1] / largest, v[2] / largest};
  const double length = glm::length(n), d = v[3] / largest / length;
  if (!std::isfinite(d)) throw usage_error("--stop-plane " + text + ": lies beyond all numbers");
  // A unit normal makes the level a distance, as StopRule wants it.
  return {[unit = n / length, d](const Vec3& x) { return glm::dot(unit, x) - d; }};
}

}  // namespace

std::uint64_t line_memory(const TracingOptions& tracing) {
  constexpr double kMega = 1024.0 * 1024.0;
  constexpr std::uint64_t kShare = 4;
  if (tracing.memory > 0.0)
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kMega * tracing.memory));
  return machine_memory() / kShare;
}

TraceOptions trace_options(const Document& options, const std::string& default_direction) {
  const TracingOptions& tracing = options.tracing;
  TraceOptions trace;
  if (!tracing.integrator.empty()) trace.integrator = integrator_from_name(tracing.integrator);
  const std::string direction = tracing.direction.empty() ? default_direction : tracing.direction;
  trace.forward = direction != "backward";
  trace.backward = direction != "forward";
  trace.tolerance = tracing.tolerance;
  trace.step = tracing.step;
  trace.max_length = tracing.max_length;
  trace.max_time = tracing.max_time;
  trace.max_steps = tracing.max_steps;
  trace.memory = line_memory(tracing);
  for (const std::string& plane : tracing.stop_planes) trace.stop_rules.push_back(stop_plane(plane));
  trace.threads = options.common.threads;
  return trace;
}

}  // namespace palpate
