// The study of an experiment with participants.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/study/study_damage.h"
#include "lab/experiment/experiment_page.h"
#include "lab/page/report.h"
#include "lab/study.h"

namespace palpate {

ReportAnswer study_experiment(const Study& study) {
  const Stopwatch clock;
  const StudyFolder folder(study.document().study.folder);
  const std::vector<TrialRecord> trials = folder.trials();
  if (trials.empty()) {
    throw input_error(
        {folder.path().string(), "", "there is no trial yet", "", "study run or study simulate makes some"});
  }
  const ExperimentAnalysis found = analyse_experiment(folder, trials);
  const std::vector<DamagedFile> damaged = damaged_files(folder, trials, *study.progress(), study.threads());
  constexpr std::size_t kMostNamed = 10;
  for (std::size_t i = 0; i < std::min(kMostNamed, damaged.size()); ++i)
    study.note(damaged[i].file + ": " + damaged[i].why + "; its trial counts, and cannot be looked at again");
  if (damaged.size() > kMostNamed)
    study.note("and " + std::to_string(damaged.size() - kMostNamed) +
               " more files that are missing or damaged: the page names them");
  if (found.missing > 0)
    study.note(counted(found.missing, "trial") +
               " of the design of those who have begun not there: not done yet, or deleted");
  Report report;
  report.title = folder.plan().program + ": experiment " + folder.path().filename().string();
  if (found.simulated) report.title += " (simulated)";
  report.command_line = study.request().command_line;
  report.machine = this_machine();
  if (const std::string words = experiment_label(found); !words.empty()) report.scene.push_back(words);
  report.scene.push_back(counted(found.participants, "participant") + ", " + counted(trials.size(), "trial") +
                         ", seed " + std::to_string(folder.plan().design.seed) + ", guidance times " +
                         short_number(folder.plan().guidance) + ".");
  report.sections = experiment_sections(folder, trials, found, damaged);
  report.seconds = clock.seconds();
  std::string text;
  std::size_t rows = 0;
  for (const TaskAnalysis& t : found.tasks) {
    text += "  " + t.info.title + ": error " + t_text(t.of(Measure::kError).of_means) + "; time " +
            t_text(t.of(Measure::kTime).of_means) + "; left out " +
            std::to_string(t.flawed + t.too_far + t.too_slow) + " of " + counted(t.trials, "trial") + "\n";
    ++rows;
  }
  ReportAnswer answer = study.finish(report, text, rows);
  Json json = parse_json(answer.json);
  json["participants"] = found.participants;
  json["simulated"] = found.simulated ? found.participants : 0;
  json["set_aside"] = found.set_aside;
  json["missing_trials"] = found.missing;
  json["damaged_files"] = damaged.size();
  for (const TaskAnalysis& t : found.tasks) {
    const MeasureAnalysis& e = t.of(Measure::kError);
    const auto number_or_null = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    json["tasks"][t.info.name] = {{"t", number_or_null(e.of_means.t)},
                                  {"p", number_or_null(e.of_means.p)},
                                  {"difference_mm", number_or_null(e.of_means.mean)},
                                  {"left_out", t.flawed + t.too_far + t.too_slow},
                                  {"goal_not_met", t.unreached}};
  }
  answer.json = json_text(json);
  return answer;
}

}  // namespace palpate
