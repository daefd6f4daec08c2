#include "lab/data/tract_errors.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/field/tensor/tensor_field.h"
#include "common/math/symmetric3.h"
#include "common/math/units.h"
#include "common/ode/explicit_step.h"
#include "common/ode/tableau.h"
#include "common/trace/tract/trace_tracts.h"
#include "lab/data/fit_errors.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"
#include "lab/peer/tckgen.h"

namespace palpate {
namespace {

constexpr double kLength = 40.0;    ///< of the lines [mm]
constexpr double kAside = 1.5;      ///< seeds lie no farther from the centre line [mm]
constexpr double kRounding = 1e-5;  ///< [mm] points are single: errors below mean nothing
constexpr double kTightest = 1e-9;  ///< tolerance of the reference

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

Vec3 center_of(std::size_t voxel, const UniformTopology& image) {
  const auto nx = as_size(image.points.x), ny = as_size(image.points.y);
  return image.origin + image.axes * Vec3(voxel % nx, voxel / nx % ny, voxel / (nx * ny));
}

/// Numbers of voxels near the beginning of the centre line.
std::vector<std::size_t> voxels_near(const AnalyticTensor& formula, const UniformTopology& image,
                                     std::size_t most) {
  const CenterLine center = formula.center_lines().front();
  const Mat3 to_voxels = glm::inverse(image.axes);
  std::vector<std::size_t> found;
  for (int n = 0; n < 400 && found.size() < most; ++n) {
    const Vec3 x = center.position(0.3 + 0.0005 * n);
    const Index3 i = Index3(glm::round(to_voxels * (x - image.origin)));
    const std::size_t voxel =
        as_size(i.x) + as_size(image.points.x) * (as_size(i.y) + as_size(image.points.y) * as_size(i.z));
    if (glm::distance(center_of(voxel, image), x) <= kAside && std::ranges::find(found, voxel) == found.end())
      found.push_back(voxel);
  }
  return found;
}

/// The median distance of the lines' ends at kLength from those of the formula's curves, each begun as its line begins.
/// @param whole gets how many lines come so far.
double off_the_formula(const AnalyticTensor& formula, const std::vector<std::vector<Vec3>>& lines,
                       double step, std::size_t& whole) {
  const auto last = static_cast<std::size_t>(std::lround(kLength / step));
  std::vector<double> distances;
  for (const std::vector<Vec3>& line : lines) {
    if (line.size() > last)
      distances.push_back(glm::distance(line[last], true_end(formula, line.front(), line[1] - line.front())));
  }
  whole = distances.size();
  return value_at_part(std::move(distances));
}

/// tckgen, and our own methods from the same seeds.
void run_peers(const AnalyticTensor& formula, const TensorField& field, const UniformTopology& image,
               Effort effort, TractErrors& errors) {
  errors.why_no_peer = Tckgen::why_none();
  if (!errors.why_no_peer.empty()) return;
  constexpr int kGradients = 30;
  const bool quick = effort == Effort::kQuick;
  const std::vector<std::size_t> voxels = voxels_near(formula, image, quick ? 8 : 32);
  const auto add = [&](const std::string& method, const std::string& setting, double step,
                       const std::vector<std::vector<Vec3>>& lines, double seconds_a_line) {
    TractPeerRow row{.method = method, .setting = setting};
    row.end = off_the_formula(formula, lines, step, row.lines);
    row.seconds = seconds_a_line;
    errors.peers.push_back(std::move(row));
  };
  const Tckgen peer(formula, image, spread_gradients(kGradients), voxels);
  for (const double step : quick ? std::vector{1.0, 0.2} : std::vector{1.0, 0.5, 0.2, 0.1}) {
    constexpr double kCutoff = 0.1, kAngle = 80.0;
    const TckgenLines found = peer.trace(step, kLength, kCutoff, kAngle);
    add("tckgen Tensor_Det", "step=" + short_number(step), step, found.lines, found.seconds);
  }
  std::vector<Vec3> seeds;
  for (const std::size_t voxel : voxels) seeds.push_back(center_of(voxel, image));
  struct Own {
    Integrator integrator;
    double step, tolerance;
    std::string setting;
  };
  for (const Own& own :
       {Own{Integrator::kEuler, 0.2, 1e-4, "step=0.2"}, Own{Integrator::kRk4, 1.0, 1e-4, "step=1"},
        Own{Integrator::kDp54, 1.0, 1e-3, "tolerance=0.001"}}) {
    TractOptions options = options_for(own.integrator, own.step, own.tolerance);
    options.sense = TractSense::kForward;
    const TractResult result = trace_tracts(field, seeds, options);
    std::vector<std::vector<Vec3>> lines;
    for (std::size_t l = 0; l < result.lines.line_count(); ++l) {
      const auto line = result.lines.line(l);
      lines.emplace_back(line.begin(), line.end());
    }
    add(std::string(name_of(own.integrator)), own.setting, own.step, lines,
        timed(field, seeds, options, quick ? 0.002 : 0.02) /
            static_cast<double>(std::max<std::size_t>(lines.size(), 1)));
  }
}

TractErrors run_bundle(const std::string& name, Effort effort, Progress* progress) {
  const auto formula = tensor_formula(name);
  TractErrors errors;
  errors.bundle = name;
  errors.voxel = effort == Effort::kQuick ? 2.0 : 1.0;
  errors.length = kLength;
  const Index3 points = Index3(glm::round(formula->bounds().size() / errors.voxel)) + 1;
  const DataSet image = sample_tensors(*formula, points, 0.0);
  const auto field = make_tensor_field(image, {.array = kTensorArray}, name);
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
        angles.push_back(kDegreesARadian * axis_angle(main_direction_at(*field, ends[i]->place),
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
  run_peers(*formula, *field, std::get<UniformTopology>(image.topology), effort, errors);
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
    for (const TractPeerRow& row : bundle.peers) {
      section.table.push_back({bundle.bundle + " from voxels, " + row.method, row.setting,
                               three_digits(row.end), "", "", three_digits(1e3 * row.seconds)});
      section.work_precision.push_back(
          {bundle.bundle + ", " + counted(row.lines, "line") + " from centres of voxels", row.method,
           row.setting, row.end, "end point from the formula's [mm], median",
           row.seconds * static_cast<double>(row.lines)});
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
      "is too much.",
      helix.why_no_peer.empty()
          ? "Rows 'from voxels' are another measure: the distance of end points from the formula's curves, of lines that begin "
            "at the centres of voxels, for MRtrix's tckgen and for our own methods. tckgen interpolates signals of 30 "
            "directions and fits a tensor at each step, so that its image is off by another amount. Its time is that of its "
            "processor, without what a run from one seed takes."
          : "No peer is on this page: " + helix.why_no_peer + "."};
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
