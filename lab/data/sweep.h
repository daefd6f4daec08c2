/// Error against run time of every integrator on one field and mesh.
///
/// Adaptive methods are swept over tolerances, fixed-step methods over step lengths. Every method is judged on
/// every line of the reference. That is the tightest method that the grid allows: the cell-exact one on
/// tetrahedra, Dormand-Prince at 1e-12 elsewhere. Its own error is not assumed: a second method, of another
/// kind, is compared with it, and errors below that agreement mean nothing; lines on which the two part are
/// counted. The method of the reference is itself judged by the second one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"
#include "common/trace/trace.h"
#include "lab/data/line_error.h"

namespace palpate {

/// How much work a report does.
enum class Effort : std::uint8_t { kQuick, kNormal, kThorough };
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] Effort effort_from_name(const std::string& name);

/// One method at one setting.
struct SweepRow {
  std::string method;
  std::string parameter;  ///< "tolerance=1e-06", "step=0.01"
  double setting = 0.0;   ///< the number in it; 0 for the cell-exact method
  std::string judge;      ///< the reference that it is judged by
  LineComparison error;
  double seconds = 0.0;  ///< median of `repeats` runs
  int repeats = 1;
  std::size_t lines = 0;
  std::size_t points = 0;
};

struct Sweep {
  std::string subject;         ///< "carotid.vtk, vectors, 48 seeds"
  std::vector<SweepRow> rows;  ///< by method, loose to tight; those of VTK last
  std::string peer_missing;    ///< why rows of VTK's tracer are left out, or not all there
  std::string reference;       ///< "dp54 tolerance=1e-12"
  std::string second;          ///< the independent method it is compared with, and that it is judged by
  LineComparison agreement;    ///< of the two
  std::size_t disputed = 0;    ///< lines on which they differ by more than kDisputed, or end otherwise
  double max_length = 0.0;     ///< data units
  double spacing = 0.0;        ///< S of the comparison, data units
  int threads = 1;
  std::size_t seeds = 0;  ///< given
  std::size_t seeds_outside = 0;
  std::size_t lines_inside = 0;  ///< that run into sinks or close on themselves: neither compared nor timed
  std::vector<Line> reference_lines;  ///< compared and timed
};

struct SweepRequest {
  std::string subject;
  std::vector<Vec3> seeds;
  TraceOptions trace;  ///< directions, limits and stop rules; method and tolerance are swept
  Effort effort = Effort::kNormal;
  std::size_t most_lines = 48;  ///< seeds whose lines end inside are replaced by later ones up to this many
};

/// Pieces of a line that a tolerance is swept of, unless the request has fewer. What needs more, as explicit methods do on stiff flows, is counted as
/// not finished: a report does not wait for it.
inline constexpr std::int64_t kMostSweptSteps = 50'000;

/// The references part where they differ by more of the diagonal.
inline constexpr double kDisputed = 1e-6;

/// Length of the lines where the request does not say: long enough for errors to grow, short enough that a
/// chaotic field does not amplify them beyond meaning.
inline constexpr double kReportDiagonals = 2.0;

/// @throws Error (work failed) where no seed lies in the field; Cancelled.
[[nodiscard]] Sweep run_sweep(const VectorField& field, const SweepRequest& request, Progress* progress);

/// The rows as report.json has them: one for the 95 % quantile and one for the maximum of each.
[[nodiscard]] std::vector<WorkPrecision> work_precision_rows(const Sweep& sweep);

}  // namespace palpate
