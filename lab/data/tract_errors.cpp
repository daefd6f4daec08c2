#include "lab/data/tract_errors.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/field/tensor/tensor_field.h"
#include "common/math/symmetric3.h"
#include "common/ode/explicit_step.h"
#include "common/ode/tableau.h"
#include "common/trace/tract/trace_tracts.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr double kLength = 40.0;    ///< of the lines [mm]
constexpr double kAside = 1.5;      ///< seeds lie no farther from the centre line [mm]
constexpr double kRounding = 1e-5;  ///< [mm] points are single: errors below mean nothing
constexpr double kTightest = 1e-9;  ///< tolerance of the reference
constexpr double kDegrees = 180.0 / std::numbers::pi;

double value_at_part(std::vector<double> values, double quantile = 0.5) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[floor_size(quantile * static_cast<double>(values.size() - 1))];
}

/// Seeds about the beginning of the bundle's centre line.
std::vector<Vec3> seeds_of(const AnalyticTensor& formula, std::size_t count) {
  const CenterLine center = formula.center_lines().front();
  std::vector<Vec3> seeds;
  for (std::size_t n = 0; n < count; ++n) {
    const double u = 0.3 + 0.2 * (static_cast<double>(n) + 0.5) / static_cast<double>(count);
    const Vec3 e = center.direction(u);
    const Vec3 a = glm::normalize(glm::cross(e, Vec3{0.31, 0.87, 0.39})), b = glm::cross(e, a);
    const double angle = 2.4 * static_cast<double>(n);
    const double r = kAside * std::sqrt((static_cast<double>(n) + 0.5) / static_cast<double>(count));
    seeds.push_back(center.position(u) + r * (std::cos(angle) * a + std::sin(angle) * b));
  }
  return seeds;
}

TractOptions options_for(Integrator integrator, double step, double tolerance) {
  TractOptions options;
  options.integrator = integrator;
  options.step = step;
  options.tolerance = tolerance;
  options.max_length = kLength;
  options.cutoff = 0.05;
  options.max_angle = 90.0;
  options.threads = 1;
  return options;
}

struct LineEnd {
  Vec3 place{0.0};
  double stated = 0.0;  ///< error [mm]
};

/// The end of each seed's line where it has come the whole length forward; the image may end before.
std::vector<std::optional<LineEnd>> ends_of(const TractResult& result, std::size_t seeds) {
  std::vector<std::optional<LineEnd>> ends(seeds);
  for (std::size_t l = 0; l < result.lines.line_count(); ++l) {
    if (result.ends[l][1] != End::kMaxLength || result.ends[l][0] != End::kMaxLength) continue;
    const Vec3f& last = result.lines.line(l).back();
    const auto point = static_cast<std::size_t>(&last - result.lines.points.data());
    ends[result.seeds[l]] = {Vec3{last}, static_cast<double>(result.lines.of_points[0].values[point])};
  }
  return ends;
}

Vec3 main_direction_at(const TensorField& field, const Vec3& x) {
  CellHint hint;
  return symmetric_eigen(field.sample(x, hint).value).vectors[0];
}

/// Where the formula's own line from `seed` ends, looking along `toward` first.
Vec3 true_end(const AnalyticTensor& formula, const Vec3& seed, Vec3 toward) {
  constexpr int kSteps = 400;
  Vec3 x = seed;
  const auto direction = [&](double, const Vec3& at) {
    const Vec3 e = symmetric_eigen(formula.tensor(at) * 1e3).vectors[0];
    toward = glm::dot(e, toward) < 0.0 ? -e : e;
    return toward;
  };
  for (int n = 0; n < kSteps; ++n) {
    ExplicitStep<Rk4, Vec3> rk;
    rk.run(direction, 0.0, x, kLength / kSteps);
    x = rk.end;
  }
  return x;
}

/// Time of the fastest of as many runs as fill a while: what else the machine does only adds to it.
double timed(const TensorField& field, std::span<const Vec3> seeds, const TractOptions& options,
             double enough) {
  constexpr int kRuns = 3;
  double least = HUGE_VAL;
  const Stopwatch all;
  for (int n = 0; n < kRuns || all.seconds() < enough; ++n) {
    least = std::min(least, trace_tracts(field, seeds, options).seconds);
  }
  return least;
}

struct Setting {
  Integrator integrator;
  std::vector<double> values;
};

TractErrors run_bundle(const std::string& name, Effort effort, Progress* progress) {
  const auto formula = tensor_formula(name);
  TractErrors errors;
  errors.bundle = name;
  errors.voxel = effort == Effort::kQuick ? 2.0 : 1.0;
  errors.length = kLength;
  const Index3 points = Index3(glm::round(formula->bounds().size() / errors.voxel)) + 1;
  const auto field = make_tensor_field(sample_tensors(*formula, points, 0.0), {.array = kTensorArray}, name);
  std::vector<Vec3> seeds = seeds_of(*formula, effort == Effort::kQuick ? 16 : 64);

  // Seeds whose reference line does not leave the image.
  const TractResult tightest = trace_tracts(*field, seeds, options_for(Integrator::kDp54, 0.5, kTightest));
  std::vector<Vec3> kept, reference;
  std::vector<double> from_formula;
  for (std::size_t l = 0; l < tightest.lines.line_count(); ++l) {
    const std::size_t seed = tightest.seeds[l];
    if (!ends_of(tightest, seeds.size())[seed]) continue;
    const auto line = tightest.lines.line(l);
    kept.push_back(seeds[seed]);
    reference.emplace_back(line.back());
    from_formula.push_back(
        glm::distance(reference.back(), true_end(*formula, kept.back(), Vec3{line[1] - line[0]})));
  }
  errors.lines = kept.size();
  errors.image_end = value_at_part(from_formula);

  const std::vector<Setting> settings{{Integrator::kEuler, {2.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.025}},
                                      {Integrator::kRk4, {4.0, 2.0, 1.0, 0.5, 0.25, 0.1}},
                                      {Integrator::kDp54, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}}};
  for (const Setting& setting : settings) {
    for (const double value : setting.values) {
      const bool controlled = setting.integrator == Integrator::kDp54;
      const TractOptions options =
          options_for(setting.integrator, controlled ? 2.0 : value, controlled ? value : 1e-4);
      const auto ends = ends_of(trace_tracts(*field, kept, options), kept.size());
      TractErrorRow row{.method = std::string(name_of(setting.integrator)), .setting = value};
      std::vector<double> distances, excesses, angles;
      for (std::size_t i = 0; i < kept.size(); ++i) {
        distances.push_back(ends[i] ? glm::distance(ends[i]->place, reference[i]) : kLength);
        excesses.push_back(distances.back() / ((ends[i] ? ends[i]->stated : 0.0) + kRounding));
        if (!ends[i]) continue;
        angles.push_back(kDegrees * axis_angle(main_direction_at(*field, ends[i]->place),
                                               main_direction_at(*field, reference[i])));
      }
      row.end = value_at_part(distances);
      row.end_p95 = value_at_part(distances, 0.95);
      row.excess_p95 = value_at_part(excesses, 0.95);
      row.direction = value_at_part(angles);
      row.seconds = timed(*field, kept, options, effort == Effort::kQuick ? 0.002 : 0.02);
      errors.rows.push_back(std::move(row));
      if (progress != nullptr) progress->check();
    }
  }
  return errors;
}

std::string setting_text(const TractErrorRow& row) {
  return row.method == "dp54" ? "tolerance=" + short_number(row.setting)
                              : "step=" + short_number(row.setting);
}

template <typename Value>
std::vector<PlotSeries> series_of(const TractErrors& errors, const Value& value) {
  std::vector<PlotSeries> all;
  for (const TractErrorRow& row : errors.rows) {
    if (all.empty() || all.back().name != row.method) all.push_back({row.method, {}});
    all.back().points.push_back(value(row));
  }
  return all;
}

}  // namespace

std::vector<TractErrors> run_tract_errors(Effort effort, Progress* progress) {
  std::vector<TractErrors> all;
  if (progress != nullptr) progress->begin("tracing bundles that are known", 2);
  for (const char* name : {"helix", "kissing"}) {
    all.push_back(run_bundle(name, effort, progress));
    if (progress != nullptr) progress->advance(1);
  }
  return all;
}

ReportSection tract_errors_section(const std::vector<TractErrors>& errors) {
  ReportSection section;
  section.title = "Tracts against curves that are known";
  section.columns = {"bundle and method",   "setting",  "end point, median [mm]", "end point, 95 % [mm]",
                     "direction [degrees]", "ms a line"};
  for (const TractErrors& bundle : errors) {
    const std::string subject =
        bundle.bundle + ", " + counted(bundle.lines, "line") + " of " + short_number(bundle.length) + " mm";
    const double ms_a_line = 1e3 / static_cast<double>(std::max<std::size_t>(bundle.lines, 1));
    section.plots.push_back(
        {"tract_end_" + bundle.bundle + ".svg", "error of end points against run time, log-log",
         svg({.title = "End points of the " + bundle.bundle + " bundle",
              .x_label = "run time of a line of " + short_number(bundle.length) + " mm [ms], one thread",
              .y_label = "distance from the reference's end, median [mm]",
              .series = series_of(bundle,
                                  [&](const TractErrorRow& r) {
                                    return PlotPoint{r.seconds * ms_a_line, r.end};
                                  }),
              .floor = bundle.image_end,
              .floor_label = "what voxels of " + short_number(bundle.voxel) + " mm cost"})});
    for (const TractErrorRow& row : bundle.rows) {
      section.table.push_back({bundle.bundle + ", " + row.method, setting_text(row), three_digits(row.end),
                               three_digits(row.end_p95), three_digits(row.direction),
                               three_digits(row.seconds * ms_a_line)});
      section.work_precision.push_back(
          {subject, row.method, setting_text(row), row.end, "end point [mm], median", row.seconds});
      section.work_precision.push_back({subject, row.method, setting_text(row), row.direction,
                                        "direction [degrees], median", row.seconds});
    }
    section.measurements.push_back({subject, "trilinear image", "voxel=" + short_number(bundle.voxel),
                                    "end point from the formula's [mm]", bundle.image_end});
  }
  const TractErrors& helix = errors.front();
  std::vector<PlotSeries> steps = series_of(helix, [](const TractErrorRow& r) {
    return PlotPoint{r.setting, r.direction};
  });
  std::erase_if(steps, [](const PlotSeries& s) { return s.name == "dp54"; });  // has no one step
  section.plots.push_back({"tract_direction_step.svg", "error of direction against step, log-log",
                           svg({.title = "Direction at the end of the helix against the step",
                                .x_label = "step [mm]",
                                .y_label = "angle from the reference's direction, median [degrees]",
                                .series = std::move(steps)})});
  const double ms_a_line = 1e3 / static_cast<double>(std::max<std::size_t>(helix.lines, 1));
  section.plots.push_back(
      {"tract_direction_time.svg", "error of direction against run time, log-log",
       svg({.title = "Direction at the end of the helix against run time",
            .x_label = "run time of a line of " + short_number(helix.length) + " mm [ms], one thread",
            .y_label = "angle from the reference's direction, median [degrees]",
            .series = series_of(helix, [&](const TractErrorRow& r) {
              return PlotPoint{r.seconds * ms_a_line, r.direction};
            })})});
  section.paragraphs = {
      "Built-in bundles without noise, as images with voxels of " + short_number(helix.voxel) +
          " mm, traced by one thread. Errors are those of the integrator: distances from where dp54 at a "
          "tolerance of 1e-9 ends on the same image. The dashed line is the error of the image itself, the "
          "distance of that end from the formula's: a step below which curves pass it buys nothing. Points "
          "are in single precision, so that nothing shows below " +
          short_number(kRounding) + " mm.",
      "Trilinear images have kinks at the faces of cells, over which no method keeps its order. rk4 goes over them "
      "with the step that it was given; dp54 counts its estimate ten times there, and ends its steps there where that "
      "is too much."};
  return section;
}

double observed_order(const TractErrors& errors, const std::string& method, double floor) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const TractErrorRow& row : errors.rows) {
    if (row.method != method || !(row.end >= floor)) continue;
    const double x = std::log(row.setting), y = std::log(row.end);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return n < 2.0 ? std::nan("") : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::vector<StabilityCase> tract_error_cases(const std::vector<TractErrors>& errors) {
  std::vector<StabilityCase> cases;
  for (const TractErrors& bundle : errors) {
    constexpr double kOrderLimit = 0.2;
    const double off = std::abs(observed_order(bundle, "euler", 10.0 * kRounding) - 1.0);
    StabilityCase order;
    order.row = {"order of euler, " + bundle.bundle, off, kOrderLimit, off <= kOrderLimit};
    order.unit = "off order 1";
    order.meaning = "slope of the end point's error over the step";
    cases.push_back(std::move(order));

    double worst = 0.0, excess = 0.0;
    for (const TractErrorRow& row : bundle.rows) {
      if (row.method != "dp54") continue;
      worst = std::max(worst, row.end_p95 / (row.setting * bundle.length + kRounding));
      excess = std::max(excess, row.excess_p95);
    }
    StabilityCase kept;
    kept.row = {"tolerance of dp54, " + bundle.bundle, worst, 1.0, worst <= 1.0};
    kept.unit = "tolerance x length";
    kept.meaning = "largest error of the end point, 95 % of the lines, over all tolerances";
    cases.push_back(std::move(kept));
    StabilityCase stated;
    stated.row = {"stated error of dp54, " + bundle.bundle, excess, 1.0, excess <= 1.0};
    stated.unit = "x what is stated";
    stated.meaning =
        "error of the end point over the one that the line states there, 95 % of the lines, over all tolerances";
    cases.push_back(std::move(stated));
  }
  return cases;
}

}  // namespace palpate
