#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/text.h"
#include "lab/data/fit_errors.h"
#include "lab/data/tract_errors.h"
#include "lab/extremes/extreme.h"
#include "lab/study.h"

namespace palpate {

ReportAnswer study_tensors(const Study& study) {
  constexpr int kSpreadGradients = 30;  // where the data have none
  const Document& document = study.document();
  const Effort effort = study.effort();
  check_report_folder(document.output.file, document.common.force);

  const Stopwatch watch;
  const int threads = study.threads();
  Input input = study.open();
  TensorImage image = input.load_tensor_image(threads, study.progress());
  const bool own = image.fit.has_value();

  Report report = study.begin(input);
  report.scene.insert(report.scene.end(), image.notes.begin(), image.notes.end());
  report.scene.push_back("Opening it took " + short_number(input.seconds_open() + input.seconds_read()) +
                         " s" + (image.fit ? ", with the fit." : "."));

  FitErrors fit = run_fit_errors(own ? image.gradients : spread_gradients(kSpreadGradients), effort, threads,
                                 study.progress());
  fit.made_up = !own;
  report.sections.push_back(fit_errors_section(fit));
  append(fit_error_cases(fit), report.stability);
  const std::vector<TractErrors> tracts = run_tract_errors(effort, study.progress());
  report.sections.push_back(tract_errors_section(tracts));
  append(tract_error_cases(tracts), report.stability);
  append(run_extremes({ExtremeKind::kTensor}, study.progress()), report.stability);
  report.seconds = watch.seconds();
  return study.finish(report, {}, work_precision_rows(report));
}

}  // namespace palpate
