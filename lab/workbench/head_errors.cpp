#include "lab/workbench/head_errors.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/figures.h"
#include "common/base/text.h"
#include "common/calibration/head_error.h"
#include "common/math/quaternion.h"
#include "lab/page/plane_picture.h"

namespace palpate {
namespace {

EyePair eyes_of(const HeadErrorSetup& setup) {
  return {{-0.5 * setup.separation, setup.eye_distance}, {0.5 * setup.separation, setup.eye_distance}};
}

/// e of eqs. 4.27 and 4.29: half the separation turned by the error.
double turn_offset(const HeadErrorSetup& setup) {
  return 0.5 * setup.separation * std::sin(setup.orientation_error);
}

}  // namespace

HeadErrorSetup head_error_setup(const HeadErrorOptions& options) {
  const std::vector<double> millimetres =
      parse_numbers(options.position_error, 2,
                    "--position-error takes two lengths in mm, along the screen and away from it: 5,5");
  return {.eye_distance = options.distance,
          .separation = options.separation,
          .position_error = 1e-3 * Vec2{millimetres[0], millimetres[1]},
          .orientation_error = options.orientation_error * kDegree,
          .screen_width = options.width,
          .front = options.front,
          .behind = options.behind,
          .pixel = options.pixel};
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
