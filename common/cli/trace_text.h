/// Lines of text about traced lines, the same for every program that traces.
#pragma once

#include <string>

#include "common/cli/summaries.h"

namespace palpate {

/// How many seeds and lines there are, where they went, and why lines end.
[[nodiscard]] std::string trace_counts_text(const TraceSummary& summary);

/// The estimated errors, how many lines keep the tolerance, and which are not held.
[[nodiscard]] std::string trace_error_text(const TraceSummary& summary);

/// What loading, preparing and tracing took.
[[nodiscard]] std::string trace_seconds_text(const TraceSummary& summary);

}  // namespace palpate
