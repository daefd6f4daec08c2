#include <array>
#include <string>
#include <vector>

#include "common/base/figures.h"
#include "common/base/text.h"
#include "common/math/quaternion.h"
#include "lab/page/scatter_plot.h"
#include "lab/workbench/calibration.h"

namespace palpate {
namespace {

struct PrintedRow {
  const char* quantity;
  const char* unit;
  double mean_before, mean_after, deviation_after, maximum_after;
};
// Ikits 2006, table 4.1: a Flock of Birds on the workbench, degree 4.
constexpr std::array<PrintedRow, 2> kTable41{
    PrintedRow{"position", "mm", 42.3, 4.82, 4.04, 22.8},
    PrintedRow{"orientation", "deg", 4.72, 0.93, 0.50, 2.09},
};

std::string percent(double before, double after) {
  return before > 0.0 ? three_digits(100.0 * (1.0 - after / before)) + " %" : "";
}

std::string scatter(const std::vector<PlacedError>& errors, const std::string& quantity,
                    const std::string& unit, double shown) {
  ScatterPlot plot{.title = "Tracker: " + quantity + " error against distance",
                   .x_label = "distance from the transmitter [m]",
                   .y_label = quantity + " error [" + unit + "]",
                   .series = {{"before", {}}, {"corrected, left out of the fit", {}}}};
  for (const PlacedError& e : errors) {
    plot.series[0].points.emplace_back(e.distance, shown * e.before);
    plot.series[1].points.emplace_back(e.distance, shown * e.after);
  }
  return svg(plot);
}

}  // namespace

ReportSection calibration_section(const FitReport& report) {
  ReportSection out;
  out.title = "Calibration: " + report.kind;
  out.paragraphs.push_back(counted(report.measurements, "measurement") + " from " + report.source +
                           "; fitted in " + three_digits(report.seconds) + " s.");
  if (report.condition_number > 0.0)
    out.paragraphs.push_back(
        "Condition number " + three_digits(report.condition_number) +
        ", columns of the Jacobian scaled to unit length; above 100 parameters are hardly "
        "told apart.");
  if (report.chi_square)
    out.paragraphs.push_back("Chi-square " + three_digits(*report.chi_square) + " for " +
                             std::to_string(report.degrees_of_freedom) + " degrees of freedom; " +
                             three_digits(100.0 * report.chi_square_probability) +
                             " % of correct models would have a larger one.");
  if (!report.weak.empty())
    out.paragraphs.push_back("Hardly distinguished: " + joined(report.weak, "; ") + ".");
  for (const std::string& advice : report.advice) out.paragraphs.push_back("Next: " + advice + ".");
  if (!report.outliers.empty()) {
    std::vector<std::string> rows;
    for (const std::size_t row : report.outliers) rows.push_back(std::to_string(row));
    out.paragraphs.push_back("Rows that lie far from the fit: " + joined(rows, "; ") + ".");
  }
  out.columns = {"method",  "judged on",       "quantity", "mean", "standard deviation",
                 "maximum", "less than before"};
  for (const ErrorRow& row : report.errors) {
    const ErrorRow* before = report.find("before", row.quantity, true);
    out.table.push_back({row.method, row.left_out ? "left out" : "fitted",
                         row.quantity + " [" + row.unit + "]", three_digits(row.errors.mean),
                         three_digits(row.errors.deviation), three_digits(row.errors.maximum),
                         before && before != &row ? percent(before->errors.mean, row.errors.mean) : ""});
  }
  if (report.kind == "tracker") {
    for (const PrintedRow& row : kTable41) {
      out.table.push_back({"printed: degree 4", "left out", std::string(row.quantity) + " [" + row.unit + "]",
                           three_digits(row.mean_after), three_digits(row.deviation_after),
                           three_digits(row.maximum_after), percent(row.mean_before, row.mean_after)});
    }
    out.paragraphs.push_back(
        "The rows marked as printed are table 4.1 of Ikits 2006: another tracker among other metal, 42.3 mm "
        "and "
        "4.72 degrees before.");
    out.plots.push_back({"tracker_position.svg", "position error against distance from the transmitter",
                         scatter(report.position_errors, "position", "mm", 1e3)});
    out.plots.push_back({"tracker_orientation.svg", "orientation error against distance from the transmitter",
                         scatter(report.orientation_errors, "orientation", "deg", 1.0 / kDegree)});
  }
  out.work_precision = report.work_precision;
  return out;
}

}  // namespace palpate
