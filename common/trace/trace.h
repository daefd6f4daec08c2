/// Batch tracing of streamlines with any integrator, in parallel over the seeds.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/field/vector_field.h"
#include "common/geometry/line.h"
#include "common/trace/line_errors.h"

namespace palpate {

/// Dp54 goes over to rodas4 where the flow is stiff, and back.
enum class Integrator : std::uint8_t { kExact, kEuler, kRk4, kBs32, kRk34, kDp54, kRodas4 };
inline constexpr int kIntegratorCount = 7;
/// How often each was at work.
using StepCounts = std::array<std::int64_t, kIntegratorCount>;
[[nodiscard]] std::string_view name_of(Integrator integrator) noexcept;  ///< "dp54"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] Integrator integrator_from_name(std::string_view name);
/// Exact on tetrahedra, dp54 elsewhere.
[[nodiscard]] Integrator default_integrator(const VectorField& field) noexcept;

/// Ends lines where they cross the zero of `level` (data coordinates) from either side; the crossing is
/// located to the tolerance. Lipschitz in x and scaled like a length; thread safe.
struct StopRule {
  std::function<double(const Vec3& x_data)> level;
};

struct TraceOptions {
  std::optional<Integrator> integrator;  ///< default_integrator() where absent
  bool forward = true;
  bool backward = false;    ///< both: two lines a seed
  double tolerance = 1e-6;  ///< accumulated position error per diagonal travelled, relative to the diagonal
  /// Fixed-step methods: step length, by default half a mean cell (1/200 of the diagonal for a formula).
  /// Others: spacing of the output points, by default one at each face of a cell and more where it turns.
  double step = 0.0;
  double max_length = 0.0;  ///< data units; 0: 10 diagonals
  double max_time = 0.0;    ///< data units; 0: no limit
  std::int64_t max_steps = 1'000'000;
  /// That the lines may take [bytes]; 0: no limit. Once they take more, the seeds that are left begin no line. Those are
  /// spread over all seeds, and the same ones for any number of threads.
  std::uint64_t memory = 0;
  std::vector<StopRule> stop_rules;
  int threads = 0;  ///< 0: all cores; the lines do not depend on it
};

struct TraceResult {
  std::vector<Line> lines;                   ///< by seed; forward before backward
  std::vector<std::uint32_t> outside_seeds;  ///< seeds in no cell: they give no line
  std::size_t seeds_left_out = 0;            ///< that were not begun, for TraceOptions::memory
  std::array<std::size_t, kEndCount> ends{};
  std::size_t points = 0;
  LineErrors errors;
  StepCounts steps{};  ///< by method: pieces of all lines, those of dp54 that rodas4 made apart
  double seconds_prepare = 0.0;
  double seconds_trace = 0.0;
  Integrator integrator = Integrator::kDp54;
};

/// Traces from every seed (data coordinates).
/// @throws Error (usage) for options that make no sense together (exact on a grid that is not
/// tetrahedral, no direction, negative limits); Cancelled.
[[nodiscard]] TraceResult trace_lines(const VectorField& field, std::span<const Vec3> seeds,
                                      const TraceOptions& options, Progress* progress = nullptr);

}  // namespace palpate
