#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "apps/cardiac/cardiac_verbs.h"
#include "common/base/clock.h"
#include "common/base/files/csv_reader.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/math/vec_text.h"
#include "common/scene/time_series.h"

namespace palpate {
namespace {

/// Places of a table, its proxies where it has such: a log of the verb probe.
/// @throws Error (bad input).
std::vector<Vec3> places_along(const std::string& file) {
  constexpr std::array<std::string_view, 3> kPlace{"x", "y", "z"}, kProxy{"px", "py", "pz"};
  CsvReader table(file, kPlace, kProxy, "a table of places, with the header x,y,z, or a log of probe");
  std::vector<Vec3> places;
  for (std::array<double, 6> row{}; table.next(row);) {
    const Vec3 place{row[0], row[1], row[2]}, proxy{row[3], row[4], row[5]};
    places.push_back(is_finite(proxy) ? proxy : place);
  }
  if (places.empty()) throw input_error({file, "", "has no rows", "a place a row", ""});
  return places;
}

std::vector<Vec3> places_of(const Document& options) {
  std::vector<Vec3> places;
  for (const std::string& text : options.series.places) {
    const auto v = parse_numbers(text, 3, "--at takes a place: x,y,z");
    places.emplace_back(v[0], v[1], v[2]);
  }
  if (!options.series.path.empty()) {
    const auto along = places_along(options.series.path.string());
    places.insert(places.end(), along.begin(), along.end());
  }
  if (places.empty()) throw usage_error("series needs a place: try --at x,y,z, or --along FILE.csv");
  return places;
}

void write_csv(const std::filesystem::path& path, const SeriesSummary& summary, bool overwrite) {
  OutputFile file(path, overwrite);
  file.write("time,place,x,y,z," + summary.value + "\n");
  for (std::size_t t = 0; t < summary.times.size(); ++t) {
    for (std::size_t p = 0; p < summary.places.size(); ++p) {
      const Vec3& x = summary.places[p];
      file.write(exact_number(summary.times[t]) + "," + std::to_string(p) + "," + exact_text(x) + "," +
                 csv_number(summary.values[t * summary.places.size() + p]) + "\n");
    }
  }
  file.finish();
}

std::string summary_text(const SeriesSummary& summary) {
  std::string text = summary.input + ": " + summary.value + " at " + counted(summary.places.size(), "place") +
                     ", " + counted(summary.times.size(), "time") +
                     (summary.output.empty() ? "\n" : " -> " + summary.output + "\n");
  constexpr std::size_t kMostReported = 20;
  for (std::size_t p = 0; p < std::min(summary.places.size(), kMostReported); ++p) {
    std::size_t least = summary.times.size(), most = least, known = 0;
    const auto value = [&](std::size_t t) { return summary.values[t * summary.places.size() + p]; };
    for (std::size_t t = 0; t < summary.times.size(); ++t) {
      if (!std::isfinite(value(t))) continue;
      ++known;
      if (least == summary.times.size() || value(t) < value(least)) least = t;
      if (most == summary.times.size() || value(t) > value(most)) most = t;
    }
    text += "  place " + std::to_string(p) + "    ";
    text += known == 0
                ? "no value: outside, or no data there\n"
                : "from " + short_number(value(least)) + " at " + short_number(summary.times[least]) +
                      " to " + short_number(value(most)) + " at " + short_number(summary.times[most]) + "\n";
  }
  if (summary.places.size() > kMostReported)
    text += "  and " + counted(summary.places.size() - kMostReported, "other place") + '\n';
  return text;
}

ExitCode run_series(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.output.file.empty() && !options.common.json)
    throw usage_error("series needs an output: try --out series.csv (or --json to get the values alone)");
  if (!options.output.file.empty() && options.output.file.extension() != ".csv")
    throw usage_error(options.output.file.string() + ": a time series is written as .csv");
  SeriesSummary summary;
  summary.places = places_of(options);
  if (!options.output.file.empty()) check_output(options.output.file, options.common.force);
  Input input = open_input(options, context);
  const Stopwatch watch;
  TimeSeries series(std::move(input), options.series.value, options.common.threads);
  summary.input = series.input().title();
  summary.output = options.output.file.string();
  summary.value = series.name();
  summary.times = series.times();
  summary.unordered = series.unordered();
  if (summary.unordered > 0)
    context.console.note(counted(summary.unordered, "time step") + " not in the order of time: sorted");
  std::vector<CellHint> hints(summary.places.size());
  context.progress.begin("reading time steps", summary.times.size());
  for (std::size_t t = 0; t < summary.times.size(); ++t) {
    context.progress.check();
    const auto field = series.read(t);
    for (std::size_t p = 0; p < summary.places.size(); ++p)
      summary.values.push_back(value_or_nan(*field, summary.places[p], hints[p]));
    context.progress.advance(1);
  }
  summary.seconds = watch.seconds();
  if (std::none_of(summary.values.begin(), summary.values.end(), [](double v) { return std::isfinite(v); }))
    throw work_error("no value: every place lies outside, or has no data");
  if (!options.output.file.empty()) {
    write_csv(options.output.file, summary, options.common.force);
    context.interrupt.keep(options.output.file);
  }
  context.console.print(summary_text(summary));
  context.console.print_json(series_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb series_verb(std::vector<UsageExample> examples) {
  return {.name = "series",
          .summary = "write a scalar at places over all time steps",
          .groups = {Group::kInput, Group::kSeries, Group::kOut},
          .examples = std::move(examples),
          .run = run_series};
}

}  // namespace palpate
