#include <string>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "lab/data/volume_quality.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

ReportPlot plot_of(const VolumeQuality& quality) {
  LogLogPlot plot{.title = "Error of the picture against the time of a frame",
                  .x_label = "frame [ms]",
                  .y_label = "root mean square error"};
  for (const VolumeQualityRow& row : quality.rows) {
    if (plot.series.empty() || plot.series.back().name != row.method) plot.series.push_back({row.method, {}});
    plot.series.back().points.push_back({row.milliseconds, row.rms});
  }
  return {"volume_error.svg", "error of the picture against milliseconds a frame, log-log", svg(plot)};
}

std::string csv_of(const std::vector<VolumeQualityRow>& rows) {
  std::string out = "what,value,rms,worst,milliseconds\n";
  for (const VolumeQualityRow& row : rows) {
    out += "\"" + row.method + "\"," + exact_number(row.parameter) + "," + exact_number(row.rms) + "," +
           exact_number(row.worst) + "," + exact_number(row.milliseconds) + "\n";
  }
  return out;
}

ReportSection error_section(const VolumeQuality& quality) {
  ReportSection section;
  section.title = "Error of a volume's picture against the time of a frame";
  const std::string pixels = std::to_string(quality.pixels);
  section.paragraphs.push_back(
      quality.subject + ", " + pixels + " x " + pixels + " pixels, by " + quality.renderer +
      ". Errors are differences of colours (1 is full scale) from a picture with 32 samples a voxel and "
      "tables of 512 entries that leaves nothing out. The picture that was asked for has " +
      quality.asked_for +
      "; only what stands in the first two columns differs from it. Frames are timed by the clock, to the "
      "end of all drawing.");
  if (quality.made_focus) {
    section.paragraphs.push_back(
        "It has no lens: what is coarser around lenses was drawn so around a ball in the middle of the "
        "volume "
        "that shows the same as the rest, a fifth of the diagonal in radius.");
  }
  section.paragraphs.push_back(
      "A plane that moves cuts the volume across, about its middle; with its slabs cached, what lies behind it "
      "is not cast again.");
  section.plots.push_back(plot_of(quality));
  section.csv = {"volume_error.csv", csv_of(quality.rows)};
  section.columns = {"what", "value", "root mean square error", "worst error", "frame [ms]"};
  for (const VolumeQualityRow& row : quality.rows) {
    section.table.push_back({row.method, short_number(row.parameter), three_digits(row.rms),
                             three_digits(row.worst), three_digits(row.milliseconds)});
    section.work_precision.push_back({quality.subject, row.method, short_number(row.parameter), row.rms,
                                      "root mean square of colours, 1 is full scale",
                                      1e-3 * row.milliseconds});
    section.measurements.push_back(
        {quality.subject, row.method, short_number(row.parameter), "worst error of a colour", row.worst});
  }
  return section;
}

ReportSection table_section(const VolumeQuality& quality) {
  ReportSection section;
  section.title = "Time of a preintegrated table";
  const bool compute = quality.tables.front().compute_ms.has_value();
  section.paragraphs.push_back(
      std::string("From a transfer function of floating point numbers to a table of 16 bits (8 in the "
                  "reference), beside the totals of table 5.1 of Ikits 2006: an ATI Radeon 9800 Pro and two "
                  "Pentium 4 of 2.0 GHz.") +
      (compute ? "" : " No compute shader: on a software rasteriser the processor fills tables."));
  section.columns = {"table", "processor [ms]"};
  if (compute) section.columns.emplace_back("compute shader [ms]");
  section.columns.insert(section.columns.end(), {"printed, CPU [ms]", "printed, GPU [ms]"});
  for (const TableTime& row : quality.tables) {
    const std::string size = "128 x 128 x " + std::to_string(row.lengths);
    section.table.push_back({size, three_digits(row.milliseconds)});
    if (compute) section.table.back().push_back(three_digits(*row.compute_ms));
    section.table.back().push_back(short_number(row.printed_cpu));
    section.table.back().push_back(short_number(row.printed_gpu));
    section.measurements.push_back({"preintegrated table", "processor", size, "time [ms]", row.milliseconds});
    if (compute) {
      section.measurements.push_back(
          {"preintegrated table", "compute shader", size, "time [ms]", *row.compute_ms});
    }
  }
  return section;
}

ReportSection focus_section(const VolumeQuality& quality) {
  ReportSection section;
  section.title = "Focus and context";
  section.paragraphs.push_back(
      "Frames a second, beside those of table 5.3 of Ikits 2006 (an ATI Radeon X1900 GT, 4 scalars of 256^3 "
      "in "
      "the focus) and, with its parameters (table 5.2), of this volume: a shaded focus at 4 samples a voxel, "
      "in "
      "the corner next to the viewer, in a context that is not shaded, at 1 sample a voxel of twice the "
      "size, "
      "with half the entries of tables and half the pixels along either edge. Nothing is left out of either, "
      "be it empty or hidden. 'Times' is the speed relative to the first row, where all is focus.");
  section.columns = {"focus, of the sides", "of the volume"};
  for (const FocusTable& table : quality.focus) {
    const std::string size = std::to_string(table.pixels) + " x " + std::to_string(table.pixels);
    section.columns.insert(section.columns.end(),
                           {size + " [1/s]", "times", "printed [1/s]", "printed times"});
  }
  for (std::size_t i = 0; i < quality.focus.front().rows.size(); ++i) {
    const double axis = quality.focus.front().rows[i].axis;
    std::vector<std::string> cells{short_number(100.0 * axis) + " %",
                                   three_digits(100.0 * axis * axis * axis) + " %"};
    for (const FocusTable& table : quality.focus) {
      const FocusRate &row = table.rows[i], &whole = table.rows.front();
      cells.insert(cells.end(), {three_digits(row.rate), three_digits(row.rate / whole.rate),
                                 short_number(row.printed), three_digits(row.printed / whole.printed)});
      section.measurements.push_back({"focus and context", std::to_string(table.pixels) + " pixels a side",
                                      "focus=" + short_number(axis), "frames a second", row.rate});
    }
    section.table.push_back(std::move(cells));
  }
  return section;
}

}  // namespace

std::vector<ReportSection> volume_quality_sections(const VolumeQuality& quality) {
  return {error_section(quality), table_section(quality), focus_section(quality)};
}

}  // namespace palpate
