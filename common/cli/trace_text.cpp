#include "common/cli/trace_text.h"

#include <algorithm>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {

std::string trace_counts_text(const TraceSummary& summary) {
  const TraceResult& result = summary.result;
  std::string text = summary.input + ": " + counted(summary.seeds, "seed") + ", " +
                     counted(result.lines.size(), "line") + ", " + counted(result.points, "point");
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  std::string ends;
  for (int e = 0; e < kEndCount; ++e) {
    const auto count = result.ends[as_size(e)];
    if (count > 0)
      ends += (ends.empty() ? "" : ", ") + std::string(name_of(static_cast<End>(e))) + " " +
              std::to_string(count);
  }
  return text + "  ends       " + ends + "\n";
}

std::string trace_error_text(const TraceSummary& summary) {
  const LineErrors& errors = summary.result.errors;
  if (errors.held == 0 && errors.unheld_seeds.empty()) return {};
  std::string text = "  " + errors_text(errors) + " by their own estimate";
  if (errors.held > 0) text += " (" + short_number(errors.worst / summary.diagonal) + " of the diagonal)";
  if (errors.within) {
    text += ", " + std::to_string(*errors.within) + " of " + counted(summary.result.lines.size(), "line") +
            " within the tolerance";
  }
  text += "\n";
  if (errors.unheld_seeds.empty()) return text;
  constexpr std::size_t kMostNamed = 5;
  std::string seeds;
  for (std::size_t i = 0; i < std::min(errors.unheld_seeds.size(), kMostNamed); ++i)
    seeds += (i == 0 ? "" : ", ") + std::to_string(errors.unheld_seeds[i]);
  if (errors.unheld_seeds.size() > kMostNamed) seeds += ", …";
  return text + "  not held   " + counted(errors.unheld_seeds.size(), "line") + ", from seeds " + seeds +
         ": the estimate grows to a tenth of the diagonal and more; chaotic, or traced too loosely\n";
}

std::string trace_seconds_text(const TraceSummary& summary) {
  return "  seconds    load " + short_number(summary.seconds_load) + ", prepare " +
         short_number(summary.result.seconds_prepare) + ", trace " +
         short_number(summary.result.seconds_trace) + " (" +
         counted(static_cast<std::uint64_t>(summary.threads), "thread") + ")\n";
}

}  // namespace palpate
