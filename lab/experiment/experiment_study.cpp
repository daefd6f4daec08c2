// The study of an experiment with participants: tables 7.1 and 7.2 and figures 7.4 to 7.6 of Ikits 2006 made anew,
// beside what is printed there.
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "lab/experiment/experiment_analysis.h"
#include "lab/page/interval_plot.h"
#include "lab/page/scatter_plot.h"
#include "lab/study.h"

namespace palpate {
namespace {

/// What the reference prints of a task; NaN where it prints nothing. n = 20, t(19).
struct Printed {
  const char* task;
  const char* error_mean;
  const char* error_deviation;
  const char* time_mean;
  const char* time_deviation;
};
constexpr Printed kPrinted[]{
    {"advection2d", "12.25, p < 0.001", "8.75, p < 0.001", "6.19, p < 0.001", "2.65, p < 0.016"},
    {"tracing2d", "11.14, p < 0.001", "3.17, p < 0.005", "6.93, p < 0.001", "0.127, p < 0.9"},
    {"advection3d", "8.12, p < 0.001", "9.77, p < 0.001", "3.76, p < 0.001", "2.5, p < 0.022"},
    {"tracing3d", "4.76, p < 0.001", "3.1, p < 0.006", "8.75, p < 0.001", "1.58, p < 0.13"}};

std::string printed(const std::string& task, const char* const Printed::*member) {
  for (const Printed& row : kPrinted) {
    if (task == row.task) return row.*member;
  }
  return "-";
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return "not defined";
  return p < 0.001 ? "< 0.001" : short_number(std::round(p * 1000.0) / 1000.0);
}

std::string rounded(double value, double unit = 0.01) {
  return std::isfinite(value) ? short_number(std::round(value / unit) * unit) : "not defined";
}

std::string t_text(const PairedTest& test) {
  if (!std::isfinite(test.t)) return "not defined";
  return rounded(test.t) + " (" + short_number(test.freedom) + "), p " + p_text(test.p);
}

class ExperimentPage {
 public:
  ExperimentPage(const StudyFolder& folder, const std::vector<TrialRecord>& trials,
                 const ExperimentAnalysis& found)
      : folder_(folder), trials_(trials), found_(found) {}

  [[nodiscard]] std::vector<ReportSection> sections() const;
  /// Whether it is of programs, or leaves them out: above every section; empty where there are people alone.
  [[nodiscard]] std::string label() const;

 private:
  [[nodiscard]] ReportSection begin(const std::string& title) const;
  [[nodiscard]] ReportSection data() const;
  [[nodiscard]] ReportSection comparison(Measure measure) const;
  [[nodiscard]] ReportSection effects(Measure measure) const;
  [[nodiscard]] ReportSection means() const;
  [[nodiscard]] ReportSection correlations() const;
  [[nodiscard]] ReportSection dimensions() const;
  [[nodiscard]] ReportSection power() const;
  [[nodiscard]] ReportSection answers() const;
  [[nodiscard]] std::string titled(const std::string& title) const {
    return found_.simulated ? title + " (simulated)" : title;
  }

  const StudyFolder& folder_;
  const std::vector<TrialRecord>& trials_;
  const ExperimentAnalysis& found_;
};

std::string ExperimentPage::label() const {
  if (found_.simulated) return "Simulated participants: programs, no people.";
  if (found_.set_aside == 0) return {};
  return counted(found_.set_aside, "simulated participant") +
         " left out: where there are people, they alone are analysed.";
}

ReportSection ExperimentPage::begin(const std::string& title) const {
  ReportSection section;
  section.title = titled(title);
  return section;
}

ReportSection ExperimentPage::data() const {
  ReportSection section = begin("Trials");
  section.paragraphs.push_back(
      "A trial is left out where its position error is above the limit of its task, or its completion time is: "
      "these are those of people who got lost in the data (Ikits 2006, sec. 7.1, whose limits these are for its "
      "tasks; 70 of its 1600 trials were left out). Practice is left out, too. A participant with fewer than two "
      "trials left in a condition is left out of the tests of that task. Left out for flaws are trials in which steps were "
      "lost or faulty, or the force was cut or switched off: they tell nothing about their condition. Trials that count "
      "although the goal was not met, as they were ended before, are counted in the last column: in tracing their error is the mean over the part that was "
      "done, which may be the easier one.");
  section.columns = {"task",
                     "recorded trials",
                     "left out: flaws",
                     "left out: error",
                     "left out: time",
                     "limit of error [mm]",
                     "limit of time [s]",
                     "participants",
                     "without enough trials",
                     "goal not met"};
  std::size_t trials = 0, left_out = 0;
  for (const TaskAnalysis& t : found_.tasks) {
    section.table.push_back({t.info.title, std::to_string(t.trials), std::to_string(t.flawed),
                             std::to_string(t.too_far), std::to_string(t.too_slow),
                             short_number(t.info.cutoff_error), short_number(t.info.cutoff_time),
                             std::to_string(t.participants.size()), std::to_string(t.lacking.size()),
                             std::to_string(t.unreached)});
    trials += t.trials;
    left_out += t.flawed + t.too_far + t.too_slow;
    section.measurements.push_back(
        {"trials", t.info.name, "", "goal not met", static_cast<double>(t.unreached)});
  }
  section.paragraphs.push_back(std::to_string(left_out) + " of " + std::to_string(trials) +
                               " trials are left out.");
  section.measurements.push_back({"trials", "all tasks", "", "left out", static_cast<double>(left_out)});
  section.csv.file = "trials.csv";
  section.csv.content =
      "participant,simulated,task,run,phase,stimulus,condition,position_error_mm,completion_time_s,reached,end,flawed_steps,counts\n";
  for (const TrialRecord& r : trials_) {
    bool kept = false;
    const TrialFlaws& flaws = r.outcome.flaws;
    for (const TaskAnalysis& t : found_.tasks)
      kept = kept || (r.simulated == found_.simulated && t.info.name == r.task && counts(r, t.info));
    section.csv.content += r.participant + (r.simulated ? ",true," : ",false,") + r.task + "," +
                           std::to_string(r.run) + (r.practice ? ",practice," : ",recorded,") +
                           std::to_string(r.stimulus) + "," + std::string(condition_name(r.guided)) + "," +
                           exact_number(r.outcome.error) + "," + exact_number(r.outcome.seconds) +
                           (r.outcome.reached ? ",true," : ",false,") +
                           (r.outcome.timed_out ? "timeout," : "space,") +
                           std::to_string(flaws.lost + flaws.faults + flaws.cut + flaws.off) + "," +
                           (kept ? "true" : "false") + "\n";
  }
  return section;
}

ReportSection ExperimentPage::comparison(Measure measure) const {
  const bool error = measure == Measure::kError;
  ReportSection section = begin(error ? "Position errors (table 7.1)" : "Completion times (table 7.2)");
  section.paragraphs.push_back(
      "Paired t tests, two-sided, of each participant's mean and of each participant's standard deviation, ISO less "
      "ANISO: a positive t says that guidance helps. In brackets the degrees of freedom. Beside them what the reference prints for "
      "its 20 participants, t(19), without signs.");
  section.columns = {"task", "mean: t", "printed", "deviation: t", "printed"};
  for (const TaskAnalysis& t : found_.tasks) {
    const MeasureAnalysis& m = t.of(measure);
    section.table.push_back(
        {t.info.title, t_text(m.of_means),
         printed(t.info.name, error ? &Printed::error_mean : &Printed::time_mean), t_text(m.of_deviations),
         printed(t.info.name, error ? &Printed::error_deviation : &Printed::time_deviation)});
    const std::string subject = error ? "position error" : "completion time";
    for (const auto& [what, test] :
         {std::pair{"mean", &m.of_means}, std::pair{"deviation", &m.of_deviations}}) {
      section.measurements.push_back({subject, t.info.name, what, "t", test->t});
      section.measurements.push_back({subject, t.info.name, what, "p", test->p});
      section.measurements.push_back({subject, t.info.name, what, "ISO - ANISO", test->mean});
    }
  }
  // Figures 7.4 and 7.5 in one: flat tasks, then those in space.
  IntervalPlot plot{.title = titled(error ? "Mean position errors" : "Mean completion times"),
                    .y_label = error ? "position error [mm]" : "completion time [s]",
                    .series = {"ISO", "ANISO"}};
  for (const bool flat : {true, false}) {
    for (const TaskAnalysis& t : found_.tasks) {
      if (t.info.flat != flat || t.participants.empty()) continue;
      const MeasureAnalysis& m = t.of(measure);
      plot.groups.push_back(
          {t.info.title,
           {{mean_of(m.means.free), m.intervals.half_a}, {mean_of(m.means.guided), m.intervals.half_b}}});
    }
  }
  const std::string name = error ? "position_errors.svg" : "completion_times.svg";
  section.plots.push_back({name, plot.title + " with 95 % inferential confidence intervals", svg(plot)});
  section.paragraphs.push_back(
      "The figure is figures 7.4 and 7.5: means over participants with 95 % inferential confidence intervals (Tryon "
      "2001), which do not overlap exactly where the paired test finds a difference at the level of 5 %. The printed "
      "figures show both measures lower with ANISO in all four tasks; of times, the intervals do not overlap in 3D "
      "tracing alone.");
  return section;
}

ReportSection ExperimentPage::effects(Measure measure) const {
  const bool error = measure == Measure::kError;
  ReportSection section = begin(error ? "Position errors: size of the effect, and without assumptions"
                                      : "Completion times: size of the effect, and without assumptions");
  section.paragraphs.push_back(
      "d_z is the mean difference per standard deviation of the differences, d_av per mean standard deviation of both "
      "conditions with Hedges' correction (Lakens 2013). Shapiro and Wilk's test asks whether the differences are "
      "normal, as the t test takes them to be; Wilcoxon's signed-rank test does without that, r is its rank-biserial "
      "correlation. The last two columns take all trials at once, as a mixed model with crossed effects of "
      "participants and stimuli would: beta is the effect of guidance with both taken out, its p comes from "
      "exchanging the conditions of whole participants.");
  const std::string unit = error ? " [mm]" : " [s]";
  section.columns = {"task",        "ISO" + unit, "ANISO" + unit, "difference" + unit,
                     "95 %",        "d_z",        "d_av",         "normal: p",
                     "Wilcoxon: p", "r",          "beta" + unit,  "permutation: p"};
  for (const TaskAnalysis& t : found_.tasks) {
    const MeasureAnalysis& m = t.of(measure);
    section.table.push_back(
        {t.info.title, rounded(mean_of(m.means.free)), rounded(mean_of(m.means.guided)),
         rounded(m.of_means.mean), rounded(m.of_means.lower) + " to " + rounded(m.of_means.upper),
         rounded(m.of_means.effect_z), rounded(m.of_means.effect_average), p_text(m.normality.p),
         p_text(m.ranks.p), rounded(m.ranks.effect), rounded(m.permutation.effect), p_text(m.permutation.p)});
    const std::string subject = error ? "position error" : "completion time";
    const std::pair<const char*, double> numbers[]{{"mean ISO", mean_of(m.means.free)},
                                                   {"mean ANISO", mean_of(m.means.guided)},
                                                   {"d_z", m.of_means.effect_z},
                                                   {"d_av", m.of_means.effect_average},
                                                   {"Shapiro-Wilk p", m.normality.p},
                                                   {"Wilcoxon p", m.ranks.p},
                                                   {"permutation beta", m.permutation.effect},
                                                   {"permutation p", m.permutation.p}};
    for (const auto& [quantity, value] : numbers)
      section.measurements.push_back({subject, t.info.name, "mean", quantity, value});
  }
  return section;
}

ReportSection ExperimentPage::means() const {
  ReportSection section = begin("Participants");
  section.paragraphs.push_back(
      "Mean and standard deviation of each participant in each condition, which are what is tested.");
  section.csv.file = "participants.csv";
  section.csv.content =
      "participant,simulated,task,condition,error_mean_mm,error_deviation_mm,time_mean_s,time_deviation_s\n";
  section.columns = {"task",
                     "condition",
                     "error: mean of means [mm]",
                     "between participants",
                     "within",
                     "time: mean of means [s]",
                     "between participants",
                     "within"};
  for (const TaskAnalysis& t : found_.tasks) {
    for (const bool guided : {false, true}) {
      const auto of = [guided](const Pairs& p) -> const std::vector<double>& {
        return guided ? p.guided : p.free;
      };
      const MeasureAnalysis &e = t.of(Measure::kError), &s = t.of(Measure::kTime);
      for (std::size_t i = 0; i < t.participants.size(); ++i) {
        section.csv.content += t.participants[i] + (found_.simulated ? ",true," : ",false,") + t.info.name +
                               "," + std::string(condition_name(guided)) + "," +
                               exact_number(of(e.means)[i]) + "," + exact_number(of(e.deviations)[i]) + "," +
                               exact_number(of(s.means)[i]) + "," + exact_number(of(s.deviations)[i]) + "\n";
      }
      section.table.push_back({t.info.title, std::string(condition_name(guided)),
                               rounded(mean_of(of(e.means))), rounded(deviation_of(of(e.means))),
                               rounded(mean_of(of(e.deviations))), rounded(mean_of(of(s.means))),
                               rounded(deviation_of(of(s.means))), rounded(mean_of(of(s.deviations)))});
    }
  }
  return section;
}

ReportSection ExperimentPage::correlations() const {
  ReportSection section = begin("Error against time (figure 7.6)");
  section.paragraphs.push_back(
      "A point a participant and condition: means of error and time. Pearson's correlation with its 95 % interval "
      "(Fisher). The reference prints r = -0.704, p < 0.001 for 2D tracing with ISO, the strongest one, and says that shorter "
      "times go with larger errors with ISO, and not necessarily with ANISO.");
  section.columns = {"task", "condition", "r", "95 %", "p", "printed r"};
  for (const TaskAnalysis& t : found_.tasks) {
    const MeasureAnalysis &e = t.of(Measure::kError), &s = t.of(Measure::kTime);
    ScatterPlot plot{
        .title = titled(t.info.title), .x_label = "completion time [s]", .y_label = "position error [mm]"};
    for (const bool guided : {false, true}) {
      const Correlation& c = t.error_with_time[guided ? 1 : 0];
      section.table.push_back({t.info.title, std::string(condition_name(guided)), rounded(c.r, 0.001),
                               rounded(c.lower) + " to " + rounded(c.upper), p_text(c.p),
                               t.info.name == "tracing2d" && !guided ? "-0.704" : "-"});
      section.measurements.push_back(
          {"correlation", t.info.name, std::string(condition_name(guided)), "r", c.r});
      section.measurements.push_back(
          {"correlation", t.info.name, std::string(condition_name(guided)), "p", c.p});
      ScatterSeries series{.name = std::string(condition_name(guided))};
      const auto& x = guided ? s.means.guided : s.means.free;
      const auto& y = guided ? e.means.guided : e.means.free;
      for (std::size_t i = 0; i < x.size(); ++i) series.points.emplace_back(x[i], y[i]);
      plot.series.push_back(std::move(series));
    }
    const std::string file = "error_time_" + std::to_string(section.plots.size() + 1) + ".svg";
    section.plots.push_back({file, t.info.title + ": error against time", svg(plot)});
  }
  return section;
}

ReportSection ExperimentPage::dimensions() const {
  ReportSection section = begin("3D against 2D");
  section.paragraphs.push_back(
      "Paired t tests of the same participants' mean position errors in 3D less those in 2D. The reference prints t(19) = 7.38, p < "
      "0.001 for tracing with guidance. Lengths in 2D and 3D are alike, and so are the sizes of what is seen.");
  section.columns = {"task in 3D", "condition", "difference [mm]", "95 %", "t", "d_z", "printed"};
  for (const DimensionTest& d : found_.dimensions) {
    section.table.push_back({d.task, std::string(condition_name(d.guided)), rounded(d.errors.mean),
                             rounded(d.errors.lower) + " to " + rounded(d.errors.upper), t_text(d.errors),
                             rounded(d.errors.effect_z),
                             d.task == "3D tracing" && d.guided ? "7.38, p < 0.001" : "-"});
    section.measurements.push_back(
        {"3D less 2D", d.task, std::string(condition_name(d.guided)), "t", d.errors.t});
    section.measurements.push_back(
        {"3D less 2D", d.task, std::string(condition_name(d.guided)), "p", d.errors.p});
  }
  return section;
}

ReportSection ExperimentPage::power() const {
  ReportSection section = begin("Power: how many participants the next study needs");
  section.paragraphs.push_back(
      "For a paired t test, two-sided at 5 %, of mean position errors: with the effect d_z that was found here, and "
      "with half of it, since effects of small studies are found too large (Button et al. 2013). By the noncentral t distribution.");
  section.columns = {"task", "d_z", "80 %", "90 %", "half the effect: 80 %", "90 %"};
  const auto needed = [](double effect, double wanted) {
    const std::size_t n = participants_for(effect, wanted);
    return n == 0 ? std::string("over 100000") : std::to_string(n);
  };
  for (const TaskAnalysis& t : found_.tasks) {
    const double d = t.of(Measure::kError).of_means.effect_z;
    if (!std::isfinite(d)) continue;
    section.table.push_back({t.info.title, rounded(d), needed(d, 0.8), needed(d, 0.9), needed(0.5 * d, 0.8),
                             needed(0.5 * d, 0.9)});
    section.measurements.push_back({"power", t.info.name, "80 %, half the effect", "participants",
                                    static_cast<double>(participants_for(0.5 * d, 0.8))});
  }
  return section;
}

ReportSection ExperimentPage::answers() const {
  ReportSection section = begin("Questionnaire");
  section.columns = {"question", "answers", "mean"};
  for (const StudyQuestion& question : study_questions()) {
    std::vector<double> numbers;
    std::size_t given = 0;
    for (const StudyParticipant& who : folder_.participants()) {
      const auto answers = folder_.answers(who.code);
      const auto found = answers.find(question.key);
      if (found == answers.end() || found->second.empty()) continue;
      ++given;
      if (const auto value = number(found->second)) numbers.push_back(*value);
    }
    if (given > 0)
      section.table.push_back({question.text, std::to_string(given),
                               question.choices.empty() ? "in words" : rounded(mean_of(numbers))});
  }
  if (section.table.empty()) section.paragraphs.emplace_back("Nobody has filled in the form.");
  return section;
}

std::vector<ReportSection> ExperimentPage::sections() const {
  std::vector<ReportSection> out{data(),
                                 comparison(Measure::kError),
                                 comparison(Measure::kTime),
                                 effects(Measure::kError),
                                 effects(Measure::kTime),
                                 means(),
                                 correlations()};
  if (!found_.dimensions.empty()) out.push_back(dimensions());
  out.push_back(power());
  out.push_back(answers());
  const std::string words = label();
  for (ReportSection& section : out) {
    if (!words.empty()) section.paragraphs.insert(section.paragraphs.begin(), words);
  }
  return out;
}

}  // namespace

ReportAnswer study_experiment(const Study& study) {
  const Stopwatch clock;
  const StudyFolder folder(study.document().study.folder);
  const std::vector<TrialRecord> trials = folder.trials();
  if (trials.empty()) {
    throw input_error(
        {folder.path().string(), "", "there is no trial yet", "", "study run or study simulate makes some"});
  }
  const ExperimentAnalysis found = analyse_experiment(folder, trials);
  const ExperimentPage page(folder, trials, found);
  Report report;
  report.title = folder.plan().program + ": experiment " + folder.path().filename().string();
  if (found.simulated) report.title += " (simulated)";
  report.command_line = study.request().command_line;
  report.machine = this_machine();
  if (const std::string words = page.label(); !words.empty()) report.scene.push_back(words);
  report.scene.push_back(counted(found.participants, "participant") + ", " + counted(trials.size(), "trial") +
                         ", seed " + std::to_string(folder.plan().design.seed) + ", guidance times " +
                         short_number(folder.plan().guidance) + ".");
  report.sections = page.sections();
  report.seconds = clock.seconds();
  std::string text;
  std::size_t rows = 0;
  for (const TaskAnalysis& t : found.tasks) {
    text += "  " + t.info.title + ": error " + t_text(t.of(Measure::kError).of_means) + "; time " +
            t_text(t.of(Measure::kTime).of_means) + "\n";
    ++rows;
  }
  ReportAnswer answer = study.finish(report, text, rows);
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(answer.json);
  json["participants"] = found.participants;
  json["simulated"] = found.simulated ? found.participants : 0;
  json["set_aside"] = found.set_aside;
  for (const TaskAnalysis& t : found.tasks) {
    const MeasureAnalysis& e = t.of(Measure::kError);
    const auto number_or_null = [](double x) {
      return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
    };
    json["tasks"][t.info.name] = {{"t", number_or_null(e.of_means.t)},
                                  {"p", number_or_null(e.of_means.p)},
                                  {"difference_mm", number_or_null(e.of_means.mean)},
                                  {"left_out", t.flawed + t.too_far + t.too_slow},
                                  {"goal_not_met", t.unreached}};
  }
  answer.json = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return answer;
}

}  // namespace palpate
