/// What an experiment came to, as parts of a report: tables 7.1 and 7.2 and figures 7.4 to 7.6 of Ikits 2006 made anew,
/// beside what is printed there. Every number of a table is in report.json, too.
#pragma once

#include <string>
#include <vector>

#include "common/study/study_damage.h"
#include "lab/experiment/experiment_analysis.h"
#include "lab/page/section.h"

namespace palpate {

/// "12.25 (19), p < 0.001".
[[nodiscard]] std::string t_text(const PairedTest& test);

/// Whether it is of programs, or leaves them out: above every section; empty where there are people alone.
[[nodiscard]] std::string experiment_label(const ExperimentAnalysis& found);

/// @param trials all of the folder, practice included. @param damaged files of theirs.
[[nodiscard]] std::vector<ReportSection> experiment_sections(const StudyFolder& folder,
                                                             const std::vector<TrialRecord>& trials,
                                                             const ExperimentAnalysis& found,
                                                             const std::vector<DamagedFile>& damaged);

}  // namespace palpate
