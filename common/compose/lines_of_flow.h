/// The lines of a flow that a document asks for: of one moment, or in time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/load/write/write_lines.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"
#include "common/scene/seeds.h"
#include "common/trace/trace.h"
#include "common/trace/unsteady/trace_unsteady.h"

namespace palpate {

struct LinesOfFlow {
  TraceResult result;
  LineKind kind = LineKind::kStreamlines;
  InTime in_time;                  ///< of all kinds but streamlines
  std::vector<std::string> notes;  ///< what is to be known of lines in time
  std::string memory_note;         ///< how many seeds began no line for want of memory; empty: none
};

/// Refuses what can be refused before any work is done.
/// @throws Error (usage): unknown words, seeds of timelines that lie on no line.
void check_lines(const TracingOptions& tracing, const SeedSpec& seeds);

/// Traces from `seeds`. Streamlines are those of `field`, which is the input's at its own time step. Pathlines begin
/// there; streaklines and timelines are seen there if `at_step`, or where the document names a time, else at the
/// last one. `--release-from` and `--until` come first.
/// @throws Error as trace_lines() and trace_unsteady(), and of reading; Cancelled.
[[nodiscard]] LinesOfFlow trace_flow(Input& input, const VectorField& field, std::span<const Vec3> seeds,
                                     const Document& document, const TraceOptions& trace, bool at_step,
                                     Progress* progress = nullptr);

/// Line::moment for each point, as a column of a file; none for streamlines.
[[nodiscard]] std::vector<PointColumn> moment_column(const LinesOfFlow& lines);

/// "from 0 until 2, 65 releases of each seed, 21 steps of the data (2 in memory); …"
[[nodiscard]] std::string in_time_text(const InTime& in_time);

}  // namespace palpate
