#include <algorithm>
#include <string>
#include <utility>

#include "common/base/text.h"
#include "lab/hand/chain/chain_work.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

std::string yield_plot(const ChainWork& work) {
  std::vector<PlotSeries> all;
  for (const ChainWorkRow& row : work.rows) {
    if (!(row.angle > 0.0)) continue;
    const std::string name =
        std::string(name_of(row.form)) + (row.chain.find("quarter") == std::string::npos ? "" : ", weak");
    auto found = std::find_if(all.begin(), all.end(), [&](const PlotSeries& s) { return s.name == name; });
    if (found == all.end()) found = all.insert(found, {name, {}});
    found->points.push_back({row.angle, row.yield});
  }
  return svg({.title = "Energy out of nothing: a line followed by a plane",
              .x_label = "angle between the line and the normal of the plane [degrees]",
              .y_label = "energy that a turn yields / energy that the springs hold",
              .series = std::move(all),
              .floor = kYieldLimit,
              .floor_label = "promised"});
}

std::string case_name(const ChainWorkRow& row) {
  return row.chain + (row.angle > 0.0 ? ", " + short_number(row.angle) + " degrees" : "");
}

}  // namespace

ReportSection chain_work_section(const ChainWork& work) {
  ReportSection section;
  section.title = "Chains of constraints on closed loops";
  section.plots.push_back(
      {"chain_work.svg", "yield against angle for both forms, log-log", yield_plot(work)});
  section.paragraphs = {
      "A hand is led around random loops of a few millimetres where the features of a chain cross, each of "
      "them "
      "both ways round. A chain that gives the hand energy on a turn could be made to give more on every "
      "further one: no hand and no damping of a device is sure to hold it. 'Sum' adds up the springs as they "
      "are (Ikits 2006, sec. 6.7); 'consistent' carries each of them back by the transposed Jacobians of the "
      "links before it, and is what hands feel by default.",
      "Its price is seen where a link that takes hold and lets go comes first, a dragged point or a wall: "
      "the "
      "springs behind it are felt or not, and the force steps (column 'steepest'), by no more than these "
      "springs "
      "hold; the slew limit of the safety stage turns that into a ramp. With the curve first, as sec. 6.7 "
      "has it, "
      "there is none."};
  section.columns = {"chain", "force", "yields", "takes", "steepest [N/m]", "us a step"};
  for (const ChainWorkRow& row : work.rows) {
    section.table.push_back({case_name(row), std::string(name_of(row.form)), three_digits(row.yield),
                             three_digits(row.taken), three_digits(row.steepest), three_digits(row.us_mean)});
    constexpr double kMicro = 1e-6;
    section.work_precision.push_back(
        {"closed loops of " + case_name(row), "chain force: " + std::string(name_of(row.form)),
         std::to_string(row.turns) + " turns", row.yield,
         "energy that a turn yields / energy that the springs hold", kMicro * row.us_mean});
  }
  return section;
}

std::vector<StabilityCase> chain_work_cases(const ChainWork& work) {
  double worst = 0.0, sum = 0.0;
  int turns = 0;
  for (const ChainWorkRow& row : work.rows) {
    if (row.form != kDefaultChainForceForm) {
      sum = std::max(sum, row.yield);
      continue;
    }
    worst = std::max(worst, row.yield);
    turns += row.turns;
  }
  StabilityCase yield;
  yield.row = {"chains: no energy out of nothing", worst, kYieldLimit, worst <= kYieldLimit};
  yield.unit = "of what the springs hold";
  yield.meaning = "most that a turn of " + std::to_string(turns) + " around closed loops gave the hand; " +
                  three_digits(sum) + " with the plain sum of the springs";
  return {yield};
}

}  // namespace palpate
