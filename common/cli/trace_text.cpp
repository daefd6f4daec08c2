#include "common/cli/trace_text.h"

#include "common/base/text.h"

namespace palpate {

std::string trace_counts_text(const TraceSummary& summary) {
  const TraceResult& result = summary.result;
  std::string text = summary.input + ": " + counted(summary.seeds, "seed") + ", " +
                     counted(result.lines.size(), "line") + ", " + counted(result.points, "point");
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  std::string ends;
  for (int e = 0; e < kEndCount; ++e) {
    const auto count = result.ends[static_cast<std::size_t>(e)];
    if (count > 0)
      ends += (ends.empty() ? "" : ", ") + std::string(name_of(static_cast<End>(e))) + " " +
              std::to_string(count);
  }
  return text + "  ends       " + ends + "\n";
}

std::string trace_error_text(const TraceSummary& summary) {
  return "  error      at most " + short_number(summary.result.error_max) + " by its own estimate, " +
         short_number(summary.result.error_max / summary.diagonal) + " of the diagonal\n";
}

std::string trace_seconds_text(const TraceSummary& summary) {
  return "  seconds    load " + short_number(summary.seconds_load) + ", prepare " +
         short_number(summary.result.seconds_prepare) + ", trace " +
         short_number(summary.result.seconds_trace) + " (" +
         counted(static_cast<std::uint64_t>(summary.threads), "thread") + ")\n";
}

}  // namespace palpate
