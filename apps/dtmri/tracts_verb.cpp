#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/dtmri/bundle_tables.h"
#include "apps/dtmri/bundle_text.h"
#include "apps/dtmri/bundles.h"
#include "apps/dtmri/dtmri_verbs.h"
#include "apps/dtmri/tensor_scene.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/read_tractogram.h"
#include "common/load/write/write_lines.h"
#include "common/load/write/write_tractogram.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/trace/tract/tract_edit.h"

namespace palpate {
namespace {

/// All bundles of the options, one behind the other; of several, each is a group of the lines.
/// @param cones as BundleGround::cones.
TractogramFile lines_of_bundles(const Document& options, const VerbContext& context, const DataArray* cones,
                                const TensorVoxels& voxels) {
  TractogramFile all;
  const std::vector<std::string>& texts = options.tract_appearance.bundles;
  BundleSet set;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const BundleText bundle = parse_bundle(texts[i]);
    Tractogram lines = *make_bundle_lines(
        bundle, {.document = options, .voxels = voxels, .cones = cones, .progress = &context.progress}, set,
        all.info.notes);
    if (texts.size() > 1) {
      const std::string name = bundle.name.empty() ? std::to_string(i + 1) : bundle.name;
      lines.of_lines.push_back(
          {.name = "group " + name, .values = std::vector<float>(lines.line_count(), 1.0F)});
    }
    append_lines(lines, all.lines);
  }
  for (auto& column : all.lines.of_lines) {
    if (!column.name.starts_with("group ")) continue;
    std::ranges::replace_if(
        column.values, [](float v) { return std::isnan(v); }, 0.0F);
  }
  if (all.lines.line_count() == 0) throw work_error("--bundle: no tract is left");
  return all;
}

/// Whether a bundle is traced with --max-cone.
bool asks_for_cones(const std::string& text) {
  return std::ranges::any_of(parse_bundle(text).steps,
                             [](const BundleStep& step) { return step.key == "max-cone"; });
}

ExitCode reported(const VerbContext& context, const TractFitSummary& summary) {
  for (const std::string& note : summary.notes) context.console.note(summary.tracts + ": " + note);
  context.console.print((summary.output.empty() ? summary.tracts : summary.output) + ": " +
                        counted(summary.lines.lines, "line") + ", " + counted(summary.lines.points, "point") +
                        ", median length " + short_number(summary.lines.lengths.median) + "\n");
  context.console.print_json(tract_fit_json(summary));
  return ExitCode::kDone;
}

/// A tractogram that no image goes with, or bundles of it.
ExitCode run_alone(const Document& options, const VerbContext& context, Input& input) {
  const OutputOptions& output = options.output;
  if (!output.tracts.empty() || !output.turn.empty())
    throw usage_error(
        input.title() +
        " holds tracts and no tensors that they could be held against: leave out --tracts and --turn");
  TractogramFile file = read_tractogram(input.spec().files.front(), &context.progress);
  const auto lattice = lattice_of_lines(file.lines);
  const bool whole = options.tract_appearance.bundles.empty();
  if (!whole) file = lines_of_bundles(options, context, nullptr, *lattice);
  TractFitSummary summary;
  summary.input = input.title();
  summary.tracts = whole ? input.title() : "bundles";
  if (!whole) summary.notes = file.info.notes;  // else said when it was opened
  summary.lines = {file.lines.line_count(), file.lines.points.size(), lengths_of(file.lines)};
  if (!output.file.empty()) {
    file.lines.image = TractogramImage{lattice->points, lattice->axes, lattice->origin};
    write_tractogram(output.file, file.lines, options.common.force);
    summary.output = output.file.string();
  }
  write_bundle(options, context, input, nullptr, {lattice->points, lattice->origin, lattice->axes},
               file.lines, summary.notes);
  return reported(context, summary);
}

ExitCode run_tracts(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  const std::vector<std::string>& bundles = options.tract_appearance.bundles;
  if (!options.output.tracts.empty() && !bundles.empty())
    throw usage_error("give either --tracts, a file, or --bundle; not both");
  for (const std::string& text : bundles) (void)parse_bundle(text);
  std::optional<TractTurn> turn;
  if (!options.output.turn.empty()) turn = parse_tract_turn(options.output.turn);
  if (turn && options.output.file.empty())
    throw usage_error("--turn needs a file that the turned tracts are written to: try --out turned.tck");
  if (!options.output.file.empty()) check_line_output(options.output.file, options.common.force);
  check_bundle_options(options);

  Input input = open_input(options, context);
  if (role_of(input) == FileRole::kTracts) return run_alone(options, context, input);
  if (options.output.tracts.empty() && bundles.empty())
    throw usage_error("tracts needs lines: try --tracts tracts.tck");
  TractogramFile file;
  if (bundles.empty()) file = read_tractogram(options.output.tracts, &context.progress);
  const bool cones =
      (options.output.measure == name_of(TensorMeasure::kCone) && !options.output.profile.empty()) ||
      std::ranges::any_of(bundles, asks_for_cones);
  const TensorImage made = input.load_tensor_image(options.common.threads, &context.progress, cones);
  const auto field =
      make_tensor_field(made.image, made.choice, input.title(), options.common.threads, made.notes);
  if (!bundles.empty())
    file = lines_of_bundles(options, context, made.image.find(std::string(kConeArray), Association::kPoint),
                            *make_tensor_voxels(field, input.title(), options.common.threads));
  context.progress.begin("comparing", 0);

  TractFitSummary summary;
  summary.input = input.title();
  summary.tracts = bundles.empty() ? options.output.tracts.string() : "bundles";
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
  write_bundle(options, context, input, &made, *field->voxels(), file.lines, summary.notes);
  return reported(context, summary);
}

}  // namespace

Verb tracts_verb(std::vector<UsageExample> examples) {
  return {
      .name = "tracts",
      .summary =
          "hold tracts against an image, edit them, measure along them, turn them on request, and write them in another "
          "format",
      .groups = {Group::kInput, Group::kOut, Group::kTurn},
      .examples = std::move(examples),
      .run = run_tracts};
}

}  // namespace palpate
