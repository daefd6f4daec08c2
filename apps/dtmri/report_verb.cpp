#include <string>
#include <vector>

#include "apps/dtmri/dtmri_verbs.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/report_output.h"
#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_fit.h"
#include "common/scene/plan.h"
#include "lab/fit_errors.h"
#include "lab/report.h"
#include "lab/tract_errors.h"

namespace palpate {
namespace {

constexpr int kSpreadGradients = 30;  ///< where the data have none

ExitCode run_tensor_report(const Options& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty()) throw usage_error("report needs a folder to make: try --out report");
  const Effort effort = effort_from_name(options.effort);
  check_report_folder(options.out, options.common.force);

  const Stopwatch watch;
  const int threads = options.common.threads;
  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  if (options.common.explain) {
    console.print(plan_text(
        plan_scene(input, {.verb = "report", .tracing = true, .threads = resolve_threads(threads)})));
  }
  const auto& gradients = input.file()->diffusion.gradients;
  const bool own = gradients && gradient_problem(*gradients).empty();
  TensorImage image = input.load_tensor_image(threads, &context.progress);

  Report report = begin_report(input, context);
  report.scene.insert(report.scene.end(), image.notes.begin(), image.notes.end());
  report.scene.push_back("Opening it took " + short_number(input.seconds_open() + input.seconds_read()) +
                         " s" + (image.fit ? ", with the fit." : "."));

  FitErrors fit = run_fit_errors(own ? *gradients : spread_gradients(kSpreadGradients), effort, threads,
                                 &context.progress);
  fit.made_up = !own;
  report.sections.push_back(fit_errors_section(fit));
  append(fit_error_cases(fit), report.stability);
  const std::vector<TractErrors> tracts = run_tract_errors(effort, &context.progress);
  report.sections.push_back(tract_errors_section(tracts));
  append(tract_error_cases(tracts), report.stability);
  report.seconds = watch.seconds();

  finish_report(report, {}, work_precision_rows(report), measured_costs(input, nullptr), options, context);
  return ExitCode::kDone;
}

}  // namespace

Verb tensor_report_verb(std::vector<UsageExample> examples) {
  return {.name = "report",
          .summary = "measure what noise, weighting, step and time do to directions and tracts",
          .groups = {.out = true, .effort = true},
          .examples = std::move(examples),
          .run = run_tensor_report};
}

}  // namespace palpate
