#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "apps/cardiac/heart_verbs.h"
#include "common/app/cli/json_output.h"
#include "common/app/cli/summaries.h"
#include "common/app/cli/verbs.h"
#include "common/base/clock.h"
#include "common/base/output_file.h"
#include "common/base/text.h"
#include "common/field/field_on_grid.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

std::vector<Vec3> places_of(const SeriesOptions& series) {
  std::vector<Vec3> places;
  for (const std::string& text : series.places) {
    const auto v = parse_numbers(text, 3, "--at takes a place: x,y,z");
    places.emplace_back(v[0], v[1], v[2]);
  }
  if (places.empty()) throw usage_error("series needs a place: try --at x,y,z");
  return places;
}

std::string number_or_nothing(double value) { return std::isfinite(value) ? exact_number(value) : "nan"; }

void write_csv(const std::filesystem::path& path, const SeriesSummary& summary, bool overwrite) {
  OutputFile file(path, overwrite);
  file.write("time,place,x,y,z," + summary.value + "\n");
  for (std::size_t t = 0; t < summary.times.size(); ++t) {
    for (std::size_t p = 0; p < summary.places.size(); ++p) {
      const Vec3& x = summary.places[p];
      file.write(exact_number(summary.times[t]) + "," + std::to_string(p) + "," + exact_number(x.x) + "," +
                 exact_number(x.y) + "," + exact_number(x.z) + "," +
                 number_or_nothing(summary.values[t * summary.places.size() + p]) + "\n");
    }
  }
  file.finish();
}

std::string summary_text(const SeriesSummary& summary) {
  std::string text = summary.input + ": " + summary.value + " at " + counted(summary.places.size(), "place") +
                     ", " + counted(summary.times.size(), "time") +
                     (summary.output.empty() ? "\n" : " -> " + summary.output + "\n");
  for (std::size_t p = 0; p < summary.places.size(); ++p) {
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
  return text;
}

/// Whether both have the same cells at the same points, to the last bit.
bool same_cells(const DataSet& a, const DataSet& b) {
  const auto* x = std::get_if<UnstructuredTopology>(&a.topology);
  const auto* y = std::get_if<UnstructuredTopology>(&b.topology);
  return x != nullptr && y != nullptr && x->connectivity == y->connectivity && x->types == y->types &&
         std::ranges::equal(x->positions.bytes, y->positions.bytes);
}

ExitCode run_series(const Options& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty() && !options.common.json)
    throw usage_error("series needs an output: try --out series.csv (or --json to get the values alone)");
  if (!options.out.empty() && options.out.extension() != ".csv")
    throw usage_error(options.out.string() + ": a time series is written as .csv");
  SeriesSummary summary;
  summary.places = places_of(options.series);
  if (!options.out.empty()) check_output(options.out, options.common.force);
  Input input = open_input(options, context);
  const Stopwatch watch;
  const ScalarChoice choice = choose_scalar(input.arrays(), options.series.value, input.title());
  summary.input = input.title();
  summary.output = options.out.string();
  summary.value = label_of(choice, input.arrays());

  const std::vector<double>& times = input.times();
  const std::vector<std::size_t> steps = steps_in_order(times);
  for (std::size_t t = 0; t < steps.size(); ++t) summary.unordered += steps[t] == t ? 0 : 1;
  if (summary.unordered > 0)
    context.console.note(counted(summary.unordered, "time step") + " not in the order of time: sorted");
  std::shared_ptr<const FieldGrid> grid;
  DataSet before;
  context.progress.begin("reading time steps", steps.size());
  for (const std::size_t step : steps) {
    context.progress.check();
    input.set_time_step(step);
    const std::vector<DataSet> blocks = input.read({choice.array});
    if (blocks.size() != 1)
      throw input_error({input.title(), "", "has " + counted(blocks.size(), "block"), "one mesh"});
    // A wall that moves has another grid at every time; one that does not has been seen before.
    if (!grid || !same_cells(blocks.front(), before))
      grid = make_field_grid(blocks, input.title(), options.common.threads);
    before = blocks.front();
    const auto field = make_scalar_field(grid, blocks.front(), choice, input.title(), options.common.threads);
    summary.times.push_back(times.empty() ? 0.0 : times[step]);
    for (const Vec3& x : summary.places) {
      CellHint hint;
      const ScalarSample sample = field->sample(x, hint);
      summary.values.push_back(sample.status == SampleStatus::kOk ? sample.value : kNoValue);
    }
    context.progress.advance(1);
  }
  summary.seconds = watch.seconds();
  if (std::none_of(summary.values.begin(), summary.values.end(), [](double v) { return std::isfinite(v); }))
    throw work_error("no value: every place lies outside, or has no data");
  if (!options.out.empty()) {
    write_csv(options.out, summary, options.common.force);
    context.interrupt.keep(options.out);
  }
  context.console.print(summary_text(summary));
  context.console.print_json(series_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb series_verb(std::vector<UsageExample> examples) {
  return {.name = "series",
          .summary = "write a scalar at places over all time steps",
          .groups = {.series = true, .out = true},
          .examples = std::move(examples),
          .run = run_series};
}

}  // namespace palpate
