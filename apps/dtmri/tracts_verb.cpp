#include <optional>
#include <string>
#include <utility>

#include "apps/dtmri/bundle_tables.h"
#include "apps/dtmri/dtmri_verbs.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/read_tractogram.h"
#include "common/load/write/write_lines.h"
#include "common/load/write/write_tractogram.h"

namespace palpate {
namespace {

ExitCode run_tracts(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.output.tracts.empty())
    throw usage_error("tracts needs a file of lines: try --tracts tracts.tck");
  std::optional<TractTurn> turn;
  if (!options.output.turn.empty()) turn = parse_tract_turn(options.output.turn);
  if (turn && options.output.file.empty())
    throw usage_error("--turn needs a file that the turned tracts are written to: try --out turned.tck");
  if (!options.output.file.empty()) check_line_output(options.output.file, options.common.force);
  check_bundle_options(options);

  TractogramFile file = read_tractogram(options.output.tracts, &context.progress);
  Input input = open_input(options, context);
  const bool cones = options.output.measure == name_of(TensorMeasure::kCone);
  const TensorImage made = input.load_tensor_image(options.common.threads, &context.progress,
                                                   cones && !options.output.profile.empty());
  const auto field =
      make_tensor_field(made.image, made.choice, input.title(), options.common.threads, made.notes);
  context.progress.begin("comparing", 0);

  TractFitSummary summary;
  summary.input = input.title();
  summary.tracts = options.output.tracts.string();
  summary.fit = fit_of_tracts(*field, file.lines, options.common.threads);
  summary.notes = file.info.notes;
  summary.notes.push_back(fit_sentence(summary.fit, "--turn"));
  if (turn) {
    turn_tracts(map_of(*turn, *field->voxels()), file.lines);
    summary.turn = turn->text();
    summary.notes.push_back(
        "turned by " + summary.turn + ", as asked for: now " +
        fit_sentence(fit_of_tracts(*field, file.lines, options.common.threads), "--turn"));
  }
  summary.lines = {file.lines.line_count(), file.lines.points.size(), lengths_of(file.lines)};
  if (!options.output.file.empty()) {
    // Positions in a .trk file are those of an image: this one.
    const UniformTopology& voxels = *field->voxels();
    file.lines.image = TractogramImage{voxels.points, voxels.axes, voxels.origin};
    context.progress.begin("writing " + options.output.file.filename().string(), 0);
    write_tractogram(options.output.file, file.lines, options.common.force);
    summary.output = options.output.file.string();
  }
  write_bundle(options, context, input, made, *field, file.lines, summary.notes);
  for (const std::string& note : summary.notes) context.console.note(summary.tracts + ": " + note);
  context.console.print((summary.output.empty() ? summary.tracts : summary.output) + ": " +
                        counted(summary.lines.lines, "line") + ", " + counted(summary.lines.points, "point") +
                        ", median length " + short_number(summary.lines.lengths.median) + "\n");
  context.console.print_json(tract_fit_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb tracts_verb(std::vector<UsageExample> examples) {
  return {
      .name = "tracts",
      .summary =
          "hold tracts against an image, measure along them, turn them on request, and write them in another format",
      .groups = {Group::kInput, Group::kOut, Group::kTurn},
      .examples = std::move(examples),
      .run = run_tracts};
}

}  // namespace palpate
