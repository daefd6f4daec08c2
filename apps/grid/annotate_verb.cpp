#include <cmath>

#include "apps/grid/grid_verbs.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/verbs.h"
#include "common/hand/drawn/annotation_list.h"
#include "common/load/write/write_annotations.h"

namespace palpate {
namespace {

ExitCode run_annotate(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  const std::vector<Annotation> notes = annotations_of(options.touch.annotations, "--annotation");
  if (notes.empty())
    throw usage_error("annotate needs something to measure: try --annotation length:0,0,0,10,0,0");
  if (!options.output.file.empty()) check_annotation_output(options.output.file, options.common.force);
  Input input = open_input(options, context);
  const auto field = input.load_scalar(options.common.threads, &context.progress);
  AnnotationSummary summary{
      .input = input.title(), .output = options.output.file.string(), .annotations = notes};
  const std::string unit = input.file() != nullptr && input.file()->anatomical ? "mm" : "";
  CellHint hint;
  for (const Annotation& each : notes) {
    for (const Vec3& x : each.points) {
      const ScalarSample sample = field->sample(x, hint);
      if (sample.status != SampleStatus::kOk) ++summary.outside;
      summary.values.push_back(sample.status == SampleStatus::kOk ? sample.value : std::nan(""));
    }
    const std::string measure = measure_text(each, unit);
    context.console.print(std::string(name_of(each.kind)) + (measure.empty() ? "" : " " + measure) +
                          (each.label.empty() ? "" : "  " + each.label) + "\n");
  }
  if (summary.outside > 0) context.console.note(counted(summary.outside, "place") + " outside the data");
  if (!options.output.file.empty()) {
    write_annotations(options.output.file, notes, options.common.force);
    context.interrupt.keep(options.output.file);
  }
  context.console.print_json(annotation_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb annotate_verb(std::vector<UsageExample> examples) {
  return {.name = "annotate",
          .summary = "measure what is marked in the volume: lengths, angles, curves and areas",
          .groups = {Group::kInput, Group::kNotes, Group::kOut},
          .examples = std::move(examples),
          .run = run_annotate};
}

}  // namespace palpate
