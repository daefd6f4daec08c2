#include "apps/workbench/calibration_section.h"

#include <array>
#include <cmath>
#include <iterator>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/math/quaternion.h"
#include "lab/page/html.h"
#include "lab/page/plane_picture.h"
#include "lab/page/scatter_plot.h"

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

EyePair eyes_of(const HeadErrorSetup& setup) {
  return {{-0.5 * setup.separation, setup.eye_distance}, {0.5 * setup.separation, setup.eye_distance}};
}

/// e of eqs. 4.27 and 4.29: half the separation turned by the error.
double turn_offset(const HeadErrorSetup& setup) {
  return 0.5 * setup.separation * std::sin(setup.orientation_error);
}

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : "; ") + part;
  return out;
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
  if (!report.weak.empty()) out.paragraphs.push_back("Hardly told apart: " + joined(report.weak) + ".");
  for (const std::string& advice : report.advice) out.paragraphs.push_back("Next: " + advice + ".");
  if (!report.outliers.empty()) {
    std::vector<std::string> rows;
    for (const std::size_t row : report.outliers) rows.push_back(std::to_string(row));
    out.paragraphs.push_back("Rows that lie far from the fit: " + joined(rows) + ".");
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

std::vector<HeadErrorRow> head_error_rows(const HeadErrorSetup& setup) {
  for (const double size : {setup.eye_distance, setup.separation, setup.screen_width}) {
    if (!(size > 0.0 && std::isfinite(size)))
      throw usage_error(
          "distance, eye separation and width of the screen must be positive lengths in metres");
  }
  if (!(setup.front >= 0.0 && setup.behind >= 0.0 && setup.front < 0.95 * setup.eye_distance))
    throw usage_error(
        "objects must stay between the eyes and a finite depth behind the screen: give --front "
        "less than the eyes' distance, and --behind not negative");
  if (!(std::abs(setup.position_error.y) < setup.eye_distance))
    throw usage_error("a head that is tracked behind the screen sees nothing: give a smaller position error");
  const EyePair eyes = eyes_of(setup);
  std::vector<HeadErrorRow> out;
  for (const double part : {-1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0}) {
    const double z = part < 0.0 ? -part * -setup.behind : part * setup.front;
    for (const double x : {0.0, 0.25 * setup.screen_width}) {
      HeadErrorRow row{.point = {x, z}};
      row.position = position_error_effect(setup.eye_distance, row.point, setup.position_error);
      const double lambda = std::abs(z) / setup.eye_distance;
      const double kappa = 1.0 - std::abs(setup.position_error.y) / setup.eye_distance;
      row.bound = position_error_bound(lambda, kappa) * glm::length(setup.position_error);
      row.orientation = orientation_error_effect(eyes, row.point, turn_offset(setup));
      EyePair modelled = displaced(turned(eyes, turn_offset(setup)), setup.position_error);
      const auto drawn = [&](const Vec2& eye) { return (x - eye.x) * eye.y / (eye.y - z) + eye.x; };
      // On the screen itself what is drawn stays, to the bit.
      if (z != 0.0)
        row.on_screen = std::max(std::abs(drawn(modelled.left) - drawn(eyes.left)),
                                 std::abs(drawn(modelled.right) - drawn(eyes.right)));
      out.push_back(row);
    }
  }
  return out;
}

namespace {

PicturePanel perceived_grid(const HeadErrorSetup& setup, bool orientation) {
  const EyePair eyes = eyes_of(setup);
  const EyePair modelled =
      orientation ? turned(eyes, turn_offset(setup)) : displaced(eyes, setup.position_error);
  const double half = 0.5 * setup.screen_width;
  PicturePanel panel;
  panel.title =
      orientation ? "Head turned by " + three_digits(setup.orientation_error / kDegree) + " degrees"
                  : "Head " + three_digits(1e3 * glm::length(setup.position_error)) + " mm beside its place";
  // Lines across and along, finely cut: what is straight need not look so.
  constexpr int kLines = 12, kCuts = 60;
  const auto add = [&](const auto& point) {
    for (const bool perceived : {true, false}) {  // the true grid lies above
      PictureCurve curve{.name = perceived ? "as perceived" : "as it should be"};
      for (int cut = 0; cut <= kCuts; ++cut) {
        const Vec2 e = point(static_cast<double>(cut) / kCuts);
        if (!perceived) {
          curve.points.push_back(e);
          continue;
        }
        const auto f = perceived_point(eyes, modelled, e);
        // Beyond the eyes nothing is seen where it is drawn: the curve ends there.
        if (f && f->y < setup.eye_distance && std::abs(f->x) < 4.0 * half && f->y > -8.0 * setup.behind)
          curve.points.push_back(*f);
      }
      panel.curves.push_back(std::move(curve));
    }
  };
  const double depth = setup.front + setup.behind;
  for (int i = 0; i <= kLines; ++i) {
    const double s = static_cast<double>(i) / kLines;
    add([&](double t) { return Vec2{half * (2.0 * s - 1.0), -setup.behind + t * depth}; });
    add([&](double t) { return Vec2{half * (2.0 * t - 1.0), -setup.behind + s * depth}; });
  }
  panel.curves.push_back({.name = "screen", .points = {{-half, 0.0}, {half, 0.0}}});
  panel.curves.push_back({.name = "eyes", .points = {eyes.left, eyes.right}, .marks = true});
  panel.curves.push_back({.name = "as tracked", .points = {modelled.left, modelled.right}, .marks = true});
  return panel;
}

}  // namespace

std::string head_error_picture(const HeadErrorSetup& setup) {
  const double half = 0.5 * setup.screen_width;
  PlanePicture picture;
  picture.title = "What is perceived of a regular grid";
  picture.lower = {-1.1 * half, -1.3 * setup.behind - 0.05};
  picture.upper = {1.1 * half, 1.15 * setup.eye_distance};
  picture.bar = 0.1;
  picture.bar_label = "100 mm";
  picture.panels = {perceived_grid(setup, false), perceived_grid(setup, true)};
  return svg(picture);
}

ReportSection head_error_section(const HeadErrorSetup& setup) {
  ReportSection out;
  out.title = "What errors of head tracking do";
  out.paragraphs = {"Eyes " + three_digits(1e3 * setup.separation) + " mm apart, " +
                        three_digits(1e3 * setup.eye_distance) + " mm before a screen " +
                        three_digits(1e3 * setup.screen_width) + " mm wide, tracked " +
                        three_digits(1e3 * glm::length(setup.position_error)) + " mm and " +
                        three_digits(setup.orientation_error / kDegree) +
                        " degrees wrong (Ikits 2006, sec. 4.5).",
                    "A position error shears and scales what is seen, by at most its own size where objects "
                    "lie no farther from "
                    "the screen than the eyes do; an orientation error is small in a diamond about the "
                    "middle of the screen "
                    "and grows fast outside. On the screen itself neither does anything."};
  out.columns = {"point x, z [mm]",        "by position [mm]",       "at most [mm]",
                 "by orientation, x [mm]", "by orientation, z [mm]", "on the screen [mm]"};
  if (setup.pixel > 0.0) out.columns.emplace_back("[pixels]");
  for (const HeadErrorRow& row : head_error_rows(setup)) {
    std::vector<std::string> cells{
        three_digits(1e3 * row.point.x) + ", " + three_digits(1e3 * row.point.y + 0.0),
        three_digits(1e3 * row.position),
        three_digits(1e3 * row.bound),
        three_digits(1e3 * row.orientation.x),
        three_digits(1e3 * row.orientation.y),
        three_digits(1e3 * row.on_screen)};
    if (setup.pixel > 0.0) cells.push_back(three_digits(row.on_screen / setup.pixel));
    out.table.push_back(std::move(cells));
  }
  out.plots.push_back(
      {"head_errors.svg",
       "the grid of space as it is perceived over the true one: sheared and scaled with an error of the "
       "head's position; with an error of its orientation the two agree within a diamond about the "
       "middle of the screen",
       head_error_picture(setup)});
  return out;
}

}  // namespace palpate
