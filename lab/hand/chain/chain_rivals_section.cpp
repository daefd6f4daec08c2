#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "lab/hand/chain/chain_rivals.h"
#include "lab/page/html.h"
#include "lab/page/plane_picture.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr double kMilli = 1e3;  // m to mm

Vec2 in_plane(const Vec3& x) { return {kMilli * x.x, kMilli * x.y}; }

std::string picture_of(const std::vector<RivalRun>& runs) {
  PlanePicture picture{
      .title = "A streamline into a penetrable surface, at " + three_digits(kPictureAngle) +
               " degrees from its normal",
      .bar = kMilli * kDepthLimit,
      .bar_label = three_digits(kMilli * kDepthLimit) + " mm, where the surface is to let go"};
  PictureCurve surface{.name = "surface"};
  constexpr double kRadius = 60.0, kAround = 0.7;  // mm, of the sphere; radians
  constexpr int kParts = 70;
  for (int n = -kParts; n <= kParts; ++n) {
    const double turn = kAround * n / kParts;
    surface.points.push_back({kRadius * std::cos(turn), kRadius * std::sin(turn)});
  }
  // The chain's first proxy is on the curve to a nanometre, which makes it the curve for all panels.
  PictureCurve streamline{.name = "streamline"};
  Box shown;
  for (const RivalRun& run : runs) {
    if (run.angle != kPictureAngle) continue;
    if (run.method == RivalMethod::kChain) {
      for (const RivalStep& step : run.steps) streamline.points.push_back(in_plane(step.curve_proxy));
    }
    PictureCurve hand{.name = "hand", .dashed = true};
    PictureCurve curve{.name = "curve proxy", .marks = true};
    PictureCurve depth{.name = "surface proxy", .marks = true};
    PictureCurve one{.name = "one proxy", .marks = true};
    constexpr std::size_t kEvery = 3;
    for (std::size_t n = 0; n < run.steps.size(); n += kEvery) {
      const RivalStep& step = run.steps[n];
      hand.points.push_back(in_plane(step.probe));
      if (run.method != RivalMethod::kChain) {
        one.points.push_back(in_plane(step.curve_proxy));
      } else {
        curve.points.push_back(in_plane(step.curve_proxy));
        if (step.cue > 0.0) depth.points.push_back(in_plane(step.surface_proxy));
      }
      shown.include({in_plane(step.probe), 0.0});
    }
    PicturePanel panel{.title = std::string(name_of(run.method)), .curves = {surface, streamline, hand}};
    if (run.method == RivalMethod::kChain) {
      panel.curves.push_back(std::move(curve));
      panel.curves.push_back(std::move(depth));
    } else {
      panel.curves.push_back(std::move(one));
    }
    picture.panels.push_back(std::move(panel));
  }
  const Vec3 margin{3.0, 3.0, 0.0};
  picture.lower = Vec2(shown.lower - margin);
  picture.upper = Vec2(shown.upper + margin);
  return svg(picture);
}

std::string cue_plot(const std::vector<RivalRun>& runs) {
  std::vector<PlotSeries> all;
  for (const RivalRun& run : runs) {
    if (run.angle != kPictureAngle) continue;
    PlotSeries series{std::string(name_of(run.method)), {}};
    constexpr std::size_t kEvery = 4;
    for (std::size_t n = 0; n < run.steps.size(); n += kEvery) {
      const RivalStep& step = run.steps[n];
      if (step.depth > 0.0 && step.surface_on) {
        series.points.push_back({kMilli * step.depth, kMilli * step.cue});
      }
    }
    all.push_back(std::move(series));
  }
  return svg({.title = "What tells the hand of the depth",
              .x_label = "depth of the curve behind the surface [mm]",
              .y_label = "haptic stretch [mm]; it should be the depth",
              .series = std::move(all),
              .diagonal = true});
}

}  // namespace

ReportSection chain_rivals_section(const std::vector<RivalRun>& runs) {
  ReportSection section;
  section.title = "Chain, pipe and balance";
  section.plots = {
      {"chain_rivals.svg", "the hand, the surface and the proxies of each method", picture_of(runs)},
      {"chain_cue.svg", "haptic stretch against depth, log-log", cue_plot(runs)}};
  section.paragraphs = {
      "A hand goes along a streamline and on through an isosurface (Ikits 2006, figure 6.7), which is to let "
      "go "
      "at a depth of " +
          three_digits(kMilli * kDepthLimit) +
          " mm. The chain has a proxy for each: both stay where they belong, the stretch between them is the "
          "depth, and the surface lets go by the depth whatever the angle. The pipe keeps its one proxy "
          "where "
          "curve and surface cross; its stretch is the way along the curve with the hand's distance from it, "
          "and lets go at a small depth where they cross at a small angle. The balance follows linear "
          "primitives "
          "that are placed anew at each step: it leaves the surface where the line is the stronger, and the "
          "curve, for good, where the plane is.",
      "Drifts and cue error are the largest ones; none in 'lets go' means that the hand came to twice the "
      "depth "
      "limit without it."};
  section.columns = {"angle [deg]",
                     "method",
                     "off the curve [mm]",
                     "behind the surface [mm]",
                     "cue error [mm]",
                     "release distance [mm]",
                     "off the curve after [mm]",
                     "us a step"};
  constexpr double kMicro = 1e-6;
  for (const RivalRun& run : runs) {
    const std::string method(name_of(run.method));
    const bool let_go = run.release_depth > 0.0;
    section.table.push_back({three_digits(run.angle), method, three_digits(kMilli * run.curve_drift),
                             three_digits(kMilli * run.surface_drift), three_digits(kMilli * run.cue_error),
                             let_go ? three_digits(kMilli * run.release_depth) : "none",
                             let_go ? three_digits(kMilli * run.drift_after) : "none",
                             three_digits(run.us_mean)});
    const auto add = [&](double error, const char* kind) {
      section.work_precision.push_back({"streamline into an isosurface", method,
                                        "angle=" + three_digits(run.angle), error, kind,
                                        kMicro * run.us_mean});
    };
    add(run.curve_drift, "largest distance from the curve / m");
    add(run.surface_drift, "largest depth behind the surface / m");
    add(run.cue_error, "largest error of the penetration cue / m");
    if (let_go) add(std::abs(run.release_depth - kDepthLimit), "error of the release distance / m");
  }
  return section;
}

}  // namespace palpate
