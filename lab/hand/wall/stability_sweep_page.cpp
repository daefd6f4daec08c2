#include <array>
#include <utility>

#include "common/base/text.h"
#include "lab/hand/wall/stability_sweep.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

std::string stiffness_text(double stiffness) {
  return stiffness >= kStiffest ? "> " + three_digits(kStiffest) : three_digits(stiffness);
}

std::vector<std::string> stiffness_cells(const std::string& what, const StiffnessRow& row) {
  return {what,
          three_digits(row.bound),
          stiffness_text(row.unheld),
          row.bound > 0.0 ? three_digits(row.unheld / row.bound) : "none",
          stiffness_text(row.controlled),
          stiffness_text(row.relaxed),
          stiffness_text(row.firm)};
}

struct Column {
  const char* name;
  const char* method;  ///< in report.json
  double StiffnessRow::*value;
};
constexpr std::array kColumns{
    Column{"unheld", "unheld", &StiffnessRow::unheld},
    Column{"with controller", "unheld, passivity controller", &StiffnessRow::controlled},
    Column{"relaxed hand", "relaxed hand", &StiffnessRow::relaxed},
    Column{"firm hand", "firm hand", &StiffnessRow::firm},
    // Last, on top of what lies on it.
    Column{"theoretical bound", "theoretical bound", &StiffnessRow::bound},
};

ReportPlot plot_of(const StiffnessSweep& sweep, const std::string& file) {
  LogLogPlot plot{.title = "Stiffest wall against " + sweep.name,
                  .x_label = sweep.name + " [" + sweep.unit + "]",
                  .y_label = "stiffness [N/m]"};
  for (const Column& column : kColumns) {
    PlotSeries series{column.name, {}};
    for (const StiffnessRow& row : sweep.rows) {
      series.points.push_back({sweep.shown * row.value, row.*column.value});
    }
    plot.series.push_back(std::move(series));
  }
  return {file, "largest stable stiffness against " + sweep.name + ", log-log", svg(plot)};
}

void add_measured(const std::string& subject, const std::string& parameter, const StiffnessRow& row,
                  std::vector<Measurement>& all) {
  for (const Column& column : kColumns) {
    all.push_back({subject, column.method, parameter, "largest stable stiffness [N/m]", row.*column.value});
  }
}

ReportSection stiffness_section(const WallStability& wall) {
  ReportSection section{.title = "The stiffest wall"};
  const DeviceProfile& swept = wall.swept;
  const bool ideal = swept.name == find_profile("ideal").name;
  section.paragraphs = {
      "A simulated arm (" + std::string(swept.title) + ": " + short_number(swept.mass) + " kg, " +
          short_number(swept.damping) + " N s/m, " + short_number(swept.friction) +
          " N of friction, unless swept) is pushed against a virtual wall by " +
          (ideal ? "1 N from 1 mm away" : "2 N from 2 mm away") +
          ", through the very step that the servo takes, and its motion between ticks is exact. "
          "Shown is the stiffness above which it goes on swinging for ever: alone, with the time-domain "
          "passivity controller, and in a relaxed and a firm hand. The bound is 2 b / T without delay, b / "
          "(T/2 "
          "+ t_d) with it, and with encoder steps also 2 f_c / step. The sweep of encoder steps has a "
          "friction "
          "of "
          "0.05 N at least.",
      "The bound of passivity is kept by a device whatever the hand does, so that a friendly hand, friction "
      "and luck go beyond it. Devices of a class are pushed by 2 N from 2 mm away; what friction quiets here "
      "may still swing after a harder knock."};
  section.columns = {"swept",           "bound [N/m]",  "unheld",   "of the bound",
                     "with controller", "relaxed hand", "firm hand"};
  const std::array<const char*, 4> files{"stiffness_rate.svg", "stiffness_damping.svg", "stiffness_delay.svg",
                                         "stiffness_encoder.svg"};
  for (std::size_t s = 0; s < wall.sweeps.size(); ++s) {
    const StiffnessSweep& sweep = wall.sweeps[s];
    section.plots.push_back(plot_of(sweep, files.at(s)));
    for (const StiffnessRow& row : sweep.rows) {
      const std::string value = short_number(sweep.shown * row.value) + " " + sweep.unit;
      section.table.push_back(stiffness_cells(sweep.name + " " + value, row));
      add_measured("virtual wall, " + sweep.name, value, row, section.measurements);
    }
  }
  for (const DeviceRow& row : wall.devices) {
    section.table.push_back(stiffness_cells(std::string(row.device.title), row.stiffness));
    add_measured("virtual wall, devices", std::string(row.device.name), row.stiffness, section.measurements);
  }
  return section;
}

ReportSection ledger_section(const WallStability& wall) {
  constexpr double kMilli = 1e3, kMicro = 1e6;
  ReportSection section{.title = "Where a wall's energy goes"};
  section.paragraphs = {
      "The books of four seconds against that wall, at parts and multiples of the bound: what the push put "
      "in, what the motors gave (a passive wall gives nothing: below zero it took), what the arm's damping "
      "lost. The swing is that of the last second; one that does not die out is a limit cycle."};
  section.columns = {"stiffness",    "push [mJ]",       "motors [mJ]", "damping [mJ]", "largest force [N]",
                     "deepest [um]", "thrown out [um]", "swing [um]",  "at [Hz]",      "dies out"};
  for (const LedgerRow& row : wall.ledger) {
    const WallRun& run = row.run;
    const std::string times = short_number(row.wall.stiffness / row.bound) + " of the bound";
    const std::string method = row.wall.controlled ? "controlled" : "plain";
    section.table.push_back(
        {times + (row.wall.controlled ? ", controlled" : ""), three_digits(kMilli * run.energy.pushes),
         three_digits(kMilli * run.energy.motors), three_digits(kMilli * run.energy.viscous),
         three_digits(run.force) + (run.saturated ? " (peak)" : ""), three_digits(kMicro * run.deepest),
         three_digits(kMicro * run.farthest), three_digits(kMicro * run.swing.amplitude),
         three_digits(run.swing.frequency), run.swing.sustained ? "no" : "yes"});
    const auto measure = [&](const char* quantity, double value) {
      section.measurements.push_back({"virtual wall, energy", method, times, quantity, value});
    };
    measure("work of the push [J]", run.energy.pushes);
    measure("work of the motors [J]", run.energy.motors);
    measure("lost in damping [J]", run.energy.viscous);
    measure("largest force [N]", run.force);
    measure("amplitude of the swing [m]", run.swing.amplitude);
    measure("frequency of the swing [Hz]", run.swing.frequency);
    measure("swing goes on", run.swing.sustained ? 1.0 : 0.0);
  }
  return section;
}

}  // namespace

std::vector<ReportSection> wall_sections(const WallStability& wall) {
  return {stiffness_section(wall), ledger_section(wall)};
}

}  // namespace palpate
