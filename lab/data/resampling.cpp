#include "lab/data/resampling.h"

#include <algorithm>
#include <utility>

#include "common/base/clock.h"
#include "common/base/text.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr int kFewestPoints = 16;

int most_points(Effort effort) {
  return effort == Effort::kQuick ? 64 : effort == Effort::kNormal ? 128 : 256;
}

std::string points_text(const Index3& n, const char* between) {
  return std::to_string(n.x) + between + std::to_string(n.y) + between + std::to_string(n.z);
}

std::string percents(double share) { return three_digits(100.0 * share); }

std::string csv_of(const std::vector<ResamplingRow>& rows) {
  std::string out =
      "scalar,points_x,points_y,points_z,error_rms,error_worst,outside,hidden,compared,seconds\n";
  for (const ResamplingRow& row : rows) {
    out += "\"";
    for (const char c : row.scalar) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    out += "\"," + points_text(row.points, ",");
    for (const double value : {row.error.rms, row.error.worst, row.error.outside, row.error.hidden})
      out += "," + exact_number(value);
    out += "," + std::to_string(row.error.compared) + "," + exact_number(row.seconds) + "\n";
  }
  return out;
}

}  // namespace

std::vector<ResamplingRow> run_resampling(const std::vector<ResampledScalar>& scalars, const Box& bounds,
                                          Effort effort, int threads, Progress* progress) {
  std::vector<ResamplingRow> rows;
  for (const ResampledScalar& scalar : scalars) {
    for (int longest = kFewestPoints; longest <= most_points(effort); longest *= 2) {
      const UniformTopology lattice = lattice_over(bounds, cubic_points(bounds, longest));
      const Stopwatch watch;
      const DataSet block = take_scalar(scalar.sample, scalar.name, lattice, threads, progress);
      const double seconds = watch.seconds();
      rows.push_back(
          {scalar.name, lattice.points, lattice_error(scalar.sample, block, threads, progress), seconds});
    }
  }
  return rows;
}

ReportSection resampling_section(const std::string& subject, const std::vector<ResamplingRow>& rows) {
  ReportSection section;
  section.title = "Scalars on another grid";
  section.paragraphs = {
      "A scalar is drawn as a volume from a uniform grid. Where the data lies on none, --resample takes it "
      "at as "
      "many points as it is told, trilinear between them. Here the error of that is held against their "
      "number: "
      "root mean square and worst difference from the scalar at random places of its box, as parts of its "
      "range. "
      "Outside is the part of the box at which there is no data; hidden what is not drawn of the rest, since "
      "a "
      "neighbour on the grid lies outside.",
      "Twice as many points along each edge leave a quarter of the error where the scalar is smooth. At "
      "jumps, and "
      "at corners of the data's own cells, the worst error stays, and the mean falls more slowly."};
  section.columns = {"scalar",      "points",     "rms [% of range]", "worst [% of range]",
                     "outside [%]", "hidden [%]", "seconds"};
  std::vector<PlotSeries> series;
  for (const ResamplingRow& row : rows) {
    const std::string rms = row.scalar + ", rms", worst = row.scalar + ", worst";
    if (series.empty() || series.back().name != worst) {
      series.push_back({rms, {}});
      series.push_back({worst, {}});
    }
    const double points =
        static_cast<double>(row.points.x) * static_cast<double>(row.points.y) * row.points.z;
    (series.end() - 2)->points.push_back({points, row.error.rms});
    series.back().points.push_back({points, row.error.worst});
    section.table.push_back({row.scalar, points_text(row.points, " x "), percents(row.error.rms),
                             percents(row.error.worst), percents(row.error.outside),
                             percents(row.error.hidden), three_digits(row.seconds)});
    section.work_precision.push_back({subject + ", " + row.scalar, "resampled", points_text(row.points, "x"),
                                      row.error.rms, "root mean square / range", row.seconds});
    section.measurements.push_back({subject + ", " + row.scalar, "resampled", points_text(row.points, "x"),
                                    "worst error / range", row.error.worst});
    section.measurements.push_back({subject + ", " + row.scalar, "resampled", points_text(row.points, "x"),
                                    "hidden share of the data", row.error.hidden});
  }
  section.plots.push_back({"resampling.svg",
                           "error of resampled scalars against the number of points, log-log",
                           svg({.title = "Error of scalars on another grid",
                                .x_label = "points",
                                .y_label = "difference from the scalar / its range",
                                .series = std::move(series)})});
  section.csv = {"resampling.csv", csv_of(rows)};
  return section;
}

}  // namespace palpate
