#include "lab/experiment/experiment_page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/study/data_column.h"
#include "lab/experiment/printed_tests.h"
#include "lab/page/interval_plot.h"
#include "lab/page/scatter_plot.h"

namespace palpate {
namespace {

/// "69 (34 %)": of those that were left out and those that count.
std::string share_text(std::size_t out, std::size_t kept) {
  if (out + kept == 0) return "-";
  const double share = 100.0 * static_cast<double>(out) / static_cast<double>(out + kept);
  return std::to_string(out) + " (" + short_number(std::round(share)) + " %)";
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return "not defined";
  return p < 0.001 ? "< 0.001" : short_number(std::round(p * 1000.0) / 1000.0);
}

std::string rounded(double value, double unit = 0.01) {
  return std::isfinite(value) ? short_number(std::round(value / unit) * unit) : "not defined";
}

/// Numbers of a subject and a method, for report.json.
struct Numbers {
  ReportSection& section;
  std::string subject, method;

  void add(const std::string& parameter, const std::string& quantity, double value) const {
    section.measurements.push_back({subject, method, parameter, quantity, value});
  }
  void add_test(const std::string& parameter, const PairedTest& test, const std::string& unit) const {
    add(parameter, "pairs", static_cast<double>(test.count));
    add(parameter, "mean difference" + unit, test.mean);
    add(parameter, "95 % lower" + unit, test.lower);
    add(parameter, "95 % upper" + unit, test.upper);
    add(parameter, "t", test.t);
    add(parameter, "degrees of freedom", test.freedom);
    add(parameter, "p", test.p);
    add(parameter, "d_z", test.effect_z);
    add(parameter, "d_av", test.effect_average);
  }
};

class ExperimentPage {
 public:
  ExperimentPage(const StudyFolder& folder, const std::vector<TrialRecord>& trials,
                 const ExperimentAnalysis& found, const std::vector<DamagedFile>& damaged)
      : folder_(folder), trials_(trials), found_(found), damaged_(damaged) {}

  [[nodiscard]] std::vector<ReportSection> sections() const;

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
  const std::vector<DamagedFile>& damaged_;
};

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
      "done, which may be the easier one. Repeats are of trials with flaws; they are among the recorded ones. Two columns say how "
      "many of those left out for error or time were ISO and how many ANISO: where these differ, the means of what is left are nearer to each other than "
      "those of all trials would be.");
  section.columns = {"task",
                     "recorded trials",
                     "of which repeats",
                     "left out: flaws",
                     "left out: error",
                     "left out: time",
                     "of ISO",
                     "of ANISO",
                     "limit of error [mm]",
                     "limit of time [s]",
                     "participants",
                     "without enough trials",
                     "goal not met"};
  std::size_t trials = 0, left_out = 0;
  for (const TaskAnalysis& t : found_.tasks) {
    section.table.push_back({t.info.title, std::to_string(t.trials), std::to_string(t.repeats),
                             std::to_string(t.flawed), std::to_string(t.too_far), std::to_string(t.too_slow),
                             share_text(t.outliers[0], t.kept[0]), share_text(t.outliers[1], t.kept[1]),
                             short_number(t.info.cutoff_error), short_number(t.info.cutoff_time),
                             std::to_string(t.participants.size()), std::to_string(t.lacking.size()),
                             std::to_string(t.unreached)});
    trials += t.trials;
    left_out += t.flawed + t.too_far + t.too_slow;
    const Numbers numbers{section, "trials", t.info.name};
    const std::pair<const char*, std::size_t> counts[]{
        {"recorded", t.trials},
        {"repeats", t.repeats},
        {"left out for flaws", t.flawed},
        {"left out for error", t.too_far},
        {"left out for time", t.too_slow},
        {"left out for error or time, ISO", t.outliers[0]},
        {"left out for error or time, ANISO", t.outliers[1]},
        {"counting, ISO", t.kept[0]},
        {"counting, ANISO", t.kept[1]},
        {"goal not met", t.unreached},
        {"participants", t.participants.size()},
        {"participants without enough trials", t.lacking.size()}};
    for (const auto& [what, count] : counts) numbers.add("", what, static_cast<double>(count));
    numbers.add("", "limit of error [mm]", t.info.cutoff_error);
    numbers.add("", "limit of time [s]", t.info.cutoff_time);
  }
  section.paragraphs.push_back(std::to_string(left_out) + " of " + std::to_string(trials) +
                               " trials are left out; printed: 70 of 1600.");
  if (found_.missing > 0)
    section.paragraphs.push_back(
        counted(found_.missing, "trial") +
        " that the design has for those who have begun, practice included: not in the "
        "folder. They were not done yet, or were deleted.");
  if (!damaged_.empty()) {
    std::string files;
    for (const DamagedFile& one : damaged_) files += (files.empty() ? "" : "; ") + one.file + ": " + one.why;
    section.paragraphs.push_back(
        counted(damaged_.size(), "file") +
        " beside the trials missing or damaged. Their trials count by what was noted of them at once, and can be "
        "neither played back nor looked at again: " +
        files + ".");
  }
  section.measurements.push_back(
      {"trials", "all tasks", "", "of the design, not there", static_cast<double>(found_.missing)});
  section.measurements.push_back(
      {"trials", "all tasks", "", "files missing or damaged", static_cast<double>(damaged_.size())});
  section.measurements.push_back({"trials", "all tasks", "", "left out", static_cast<double>(left_out)});
  section.csv.file = "trials.csv";
  const std::vector<DataColumn> columns{
      {"participant", "anonymous code"},
      {"simulated", "true where the participant is a program"},
      {"task", "name of the task"},
      {"run", "of the trial in its task, from 1; of a repeat, more by the number of trials of the task"},
      {"attempt", "1, or more for a repeat"},
      {"phase", "practice or recorded"},
      {"stimulus", "row of the task's table in stimuli/, from 0"},
      {"condition", "ISO or ANISO (guided)"},
      {"position_error", "as the task's dictionary says", "mm"},
      {"completion_time", "from the beginning to the end of the trial", "s"},
      {"reached", "whether the goal was met"},
      {"end", "space: the participant ended it; timeout: it ended by itself"},
      {"flawed_steps", "steps that were lost or faulty, or in which there was no force"},
      {"counts", "whether it is part of what is tested"},
      {"files", "whole: recording and motion are there; damaged: one of them is not, or not all of it"}};
  section.csv.content = table_header(columns, ',');
  section.csv.dictionary = data_dictionary(columns);
  for (const TrialRecord& r : trials_) {
    bool kept = false;
    const bool damaged = std::ranges::any_of(damaged_, [&r](const DamagedFile& one) {
      return one.participant == r.participant && one.task == r.task && one.run == r.run;
    });
    const TrialFlaws& flaws = r.outcome.flaws;
    for (const TaskAnalysis& t : found_.tasks)
      kept = kept || (r.simulated == found_.simulated && t.info.name == r.task && counts(r, t.info));
    section.csv.content += r.participant + (r.simulated ? ",true," : ",false,") + r.task + "," +
                           std::to_string(r.run) + "," + std::to_string(r.attempt + 1) +
                           (r.practice ? ",practice," : ",recorded,") + std::to_string(r.stimulus) + "," +
                           std::string(condition_name(r.guided)) + "," + exact_number(r.outcome.error) + "," +
                           exact_number(r.outcome.seconds) + (r.outcome.reached ? ",true," : ",false,") +
                           (r.outcome.timed_out ? "timeout," : "space,") +
                           std::to_string(flaws.lost + flaws.faults + flaws.cut + flaws.off) + "," +
                           (kept ? "true," : "false,") + (damaged ? "damaged" : "whole") + "\n";
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
         printed(t.info.name, error ? &PrintedTests::error_mean : &PrintedTests::time_mean),
         t_text(m.of_deviations),
         printed(t.info.name, error ? &PrintedTests::error_deviation : &PrintedTests::time_deviation)});
    const Numbers numbers{section, error ? "position error" : "completion time", t.info.name};
    const std::string unit = error ? " [mm]" : " [s]";
    numbers.add_test("means, ISO - ANISO", m.of_means, unit);
    numbers.add_test("deviations, ISO - ANISO", m.of_deviations, unit);
    numbers.add("means, inferential intervals", "E", m.intervals.reduction);
    numbers.add("means, inferential intervals", "half width ISO" + unit, m.intervals.half_a);
    numbers.add("means, inferential intervals", "half width ANISO" + unit, m.intervals.half_b);
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
      "The first figure is figures 7.4 and 7.5: means over participants with 95 % inferential confidence intervals (Tryon "
      "2001), which do not overlap exactly where the paired test finds a difference at the level of 5 %. The printed "
      "figures show both measures lower with ANISO in all four tasks; of times, the intervals do not overlap in 3D "
      "tracing alone.");
  IntervalPlot effects{.title = titled(error ? "Effect on position errors" : "Effect on completion times"),
                       .y_label = "d_z of the means, ISO - ANISO",
                       .series = {"here", "printed"}};
  for (const TaskAnalysis& t : found_.tasks) {
    const double there =
        printed_effect(t.info.name, error ? &PrintedTests::error_mean : &PrintedTests::time_mean);
    const double here = t.of(measure).of_means.effect_z;
    if (std::isfinite(there))
      effects.groups.push_back({t.info.title, {{here > 0.0 ? here : NAN, NAN}, {there, NAN}}});
  }
  if (effects.groups.empty()) return section;
  section.plots.push_back({error ? "position_effects.svg" : "time_effects.svg",
                           effects.title + " beside the printed one", svg(effects)});
  section.paragraphs.push_back(
      "The heights of the printed bars of figures 7.4 and 7.5 and the widths of their intervals are not available as numbers: the "
      "reference has them as pictures alone. The second figure therefore sets beside what was found the one size that follows from a printed "
      "number: d_z = t(19) / sqrt(20), of table " +
      std::string(error ? "7.1" : "7.2") + ". Where guidance did not help here, there is no bar of it.");
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
    const Numbers numbers{section, error ? "position error" : "completion time", t.info.name};
    numbers.add("Shapiro and Wilk, of differences", "W", m.normality.w);
    numbers.add("Shapiro and Wilk, of differences", "p", m.normality.p);
    numbers.add("Wilcoxon", "pairs that differ", static_cast<double>(m.ranks.count));
    numbers.add("Wilcoxon", "smaller sum of ranks", m.ranks.statistic);
    numbers.add("Wilcoxon", "p", m.ranks.p);
    numbers.add("Wilcoxon", "rank-biserial correlation", m.ranks.effect);
    numbers.add("permutation, ANISO - ISO", "beta" + unit, m.permutation.effect);
    numbers.add("permutation, ANISO - ISO", "p", m.permutation.p);
    numbers.add("permutation, ANISO - ISO", "changes", static_cast<double>(m.permutation.draws));
  }
  return section;
}

ReportSection ExperimentPage::means() const {
  ReportSection section = begin("Participants");
  section.paragraphs.push_back(
      "Mean and standard deviation of each participant in each condition, which are what is tested.");
  section.csv.file = "participants.csv";
  const std::vector<DataColumn> columns{
      {"participant", "anonymous code"},
      {"simulated", "true where the participant is a program"},
      {"task", "name of the task"},
      {"condition", "ISO or ANISO (guided)"},
      {"error_mean", "of position errors, over the trials that count", "mm"},
      {"error_deviation", "standard deviation of these", "mm"},
      {"time_mean", "of completion times, likewise", "s"},
      {"time_deviation", "standard deviation of these", "s"}};
  section.csv.content = table_header(columns, ',');
  section.csv.dictionary = data_dictionary(columns);
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
      for (const auto& [subject, measure, unit] :
           {std::tuple{"position error", &e, " [mm]"}, std::tuple{"completion time", &s, " [s]"}}) {
        const Numbers numbers{section, subject, t.info.name};
        const std::string condition(condition_name(guided));
        numbers.add(condition, std::string("mean of means") + unit, mean_of(of(measure->means)));
        numbers.add(condition, std::string("deviation between participants") + unit,
                    deviation_of(of(measure->means)));
        numbers.add(condition, std::string("mean deviation within") + unit, mean_of(of(measure->deviations)));
      }
    }
  }
  return section;
}

ReportSection ExperimentPage::correlations() const {
  ReportSection section = begin("Error against time (figure 7.6)");
  section.paragraphs.push_back(
      "A point a participant and condition: means of error and time. Pearson's correlation with its 95 % interval "
      "(Fisher). The reference prints r = -0.704, p < 0.001 for 2D tracing with ISO, the strongest one, and says that shorter "
      "times go with larger errors with ISO, and not necessarily with ANISO. Its points are not available as numbers, as the figure is a "
      "picture alone: the figures below have those of this experiment only, and r beside the printed one is in the table.");
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
      const Numbers numbers{section, "correlation of error with time", t.info.name};
      const std::string condition(condition_name(guided));
      numbers.add(condition, "participants", static_cast<double>(c.count));
      numbers.add(condition, "r", c.r);
      numbers.add(condition, "95 % lower", c.lower);
      numbers.add(condition, "95 % upper", c.upper);
      numbers.add(condition, "p", c.p);
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
    Numbers{section, "position error, 3D less 2D", d.task}.add_test(std::string(condition_name(d.guided)),
                                                                    d.errors, " [mm]");
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
    const Numbers numbers{section, "participants that the next study needs", t.info.name};
    for (const auto& [words, effect] : {std::pair{"d_z", d}, std::pair{"half of d_z", 0.5 * d}}) {
      numbers.add(words, "for a power of 80 %", static_cast<double>(participants_for(effect, 0.8)));
      numbers.add(words, "for a power of 90 %", static_cast<double>(participants_for(effect, 0.9)));
    }
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
    section.measurements.push_back(
        {"questionnaire", question.key, "", "answers", static_cast<double>(given)});
    if (!numbers.empty())
      section.measurements.push_back({"questionnaire", question.key, "", "mean", mean_of(numbers)});
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
  const std::string words = experiment_label(found_);
  for (ReportSection& section : out) {
    if (!words.empty()) section.paragraphs.insert(section.paragraphs.begin(), words);
  }
  return out;
}

}  // namespace

std::string t_text(const PairedTest& test) {
  if (!std::isfinite(test.t)) return "not defined";
  return rounded(test.t) + " (" + short_number(test.freedom) + "), p " + p_text(test.p);
}

std::string experiment_label(const ExperimentAnalysis& found) {
  if (found.simulated) return "Simulated participants: programs, no people.";
  if (found.set_aside == 0) return {};
  return counted(found.set_aside, "simulated participant") +
         " left out: where there are people, they alone are analysed.";
}

std::vector<ReportSection> experiment_sections(const StudyFolder& folder,
                                               const std::vector<TrialRecord>& trials,
                                               const ExperimentAnalysis& found,
                                               const std::vector<DamagedFile>& damaged) {
  return ExperimentPage(folder, trials, found, damaged).sections();
}

}  // namespace palpate
