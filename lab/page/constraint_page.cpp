#include <cmath>
#include <string>

#include "common/base/text.h"
#include "lab/hand/haptic_stability.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

/// A curve for each kind of path and swept number.
template <typename Value>
std::vector<PlotSeries> series_of(const ConstraintSweep& sweep, const Value& value) {
  std::vector<PlotSeries> all;
  for (const ConstraintRow& row : sweep.rows) {
    const std::string name = std::string(name_of(row.path)) + (row.cells_swept ? ", cells" : ", iterations");
    if (all.empty() || all.back().name != name) all.push_back({name, {}});
    all.back().points.push_back({row.us_p99, value(row)});
  }
  return all;
}

const char* const kTimeLabel = "time that 99 % of the steps stay below [us]";

std::string table(const ConstraintSweep& sweep) {
  std::string out =
      "<table><tr><th>path</th><th class=\"text\">budget</th><th>force error, 99 % [N]</th><th>worst [N]</th>"
      "<th>worst lag</th><th>worst distance</th><th>us, half</th><th>99 %</th><th>worst</th><th>let go</th>"
      "<th>fell back</th></tr>\n";
  for (const ConstraintRow& row : sweep.rows) {
    out += "<tr>" + cell(std::string(name_of(row.path)), true) + cell(row.parameter(), true) +
           cell(three_digits(row.force_error.p99)) + cell(three_digits(row.force_error.max)) +
           cell(three_digits(row.lag.max)) + cell(three_digits(row.residual.max)) +
           cell(three_digits(row.us_p50)) + cell(three_digits(row.us_p99)) + cell(three_digits(row.us_max)) +
           cell(std::to_string(row.releases)) + cell(std::to_string(row.fallbacks)) + "</tr>\n";
  }
  return out + "</table>\n";
}

}  // namespace

std::string constraint_force_plot(const Report& report) {
  return svg(
      {.title = "Force error of the streamline constraint against run time",
       .x_label = kTimeLabel,
       .y_label = "force error of the worst step [N]",
       .series = series_of(report.constraint, [](const ConstraintRow& r) { return r.force_error.max; }),
       .floor = report.constraint.release_force,
       .floor_label = "force at the release distance of a line"});
}

std::string constraint_distance_plot(const Report& report) {
  return svg({.title = "Distance of the proxy from its streamline against run time",
              .x_label = kTimeLabel,
              .y_label = "distance in the worst step / diagonal",
              .series = series_of(report.constraint, [](const ConstraintRow& r) { return r.residual.max; }),
              .floor = kResidualLimit,
              .floor_label = "promised"});
}

std::string constraint_section(const ConstraintSweep& sweep) {
  if (sweep.rows.empty()) return "";
  const ConstraintRow& first = sweep.rows.front();
  std::string out =
      "<h2>The hand on a streamline</h2>\n"
      "<img src=\"constraint_force.svg\" alt=\"force error against run time, log-log\">\n"
      "<img src=\"constraint_distance.svg\" alt=\"distance from the line against run time, log-log\">\n";
  out += paragraph(
      "One servo step of the streamline constraint, with its budget swept: iterations of the search for the "
      "nearest "
      "point, and cells by which the followed line may grow. Made-up hands follow " +
      counted(sweep.seeds, "line") + " of this scene, " + counted(first.steps, "step") +
      " at 1 kHz each time: smooth at up to 0.2 m/s; with tremor of 8 to 12 Hz and steps of an encoder; and "
      "rough, "
      "with jumps, strokes at 5 m/s, places beside the data and a metre in a millisecond.");
  out += paragraph(
      "Every line that is caught is traced again by rodas4, a thousand times tighter, and the hand is "
      "followed on it "
      "without any limit of work. The distance of the proxy from that line and how far it lags behind along "
      "it are "
      "divided by the diagonal; the force error is the stiffness times its distance from where it should be. "
      "The release "
      "force of a line is " +
      three_digits(sweep.release_force) + " N. Times are processor time of the thread and contain " +
      three_digits(sweep.clock_microseconds) + " us for reading the clock.");
  return out + table(sweep);
}

}  // namespace palpate
