#include <utility>

#include "common/base/text.h"
#include "common/report/html.h"
#include "common/report/plot.h"
#include "common/report/volume_quality.h"

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

}  // namespace

ReportSection volume_quality_section(const VolumeQuality& quality) {
  ReportSection section;
  section.title = "Error of a volume's picture against the time of a frame";
  section.paragraphs.push_back(
      quality.subject + ", " + std::to_string(quality.pixels) + " x " + std::to_string(quality.pixels) +
      " pixels, by " + quality.renderer +
      ". Errors are differences of colours (1 is full scale) from a picture with 32 samples a voxel and "
      "tables of "
      "512 entries that leaves nothing out. Only what stands in the first two columns differs from the "
      "picture "
      "that was asked for. Frames are timed by the clock, to the end of all drawing.");
  std::string tables =
      "Preintegrated tables of 128 x 128 x n lengths in milliseconds, beside those printed in table 5.1 of "
      "Ikits "
      "2006 (a GPU, then a CPU of its time); by the processor here" +
      std::string(quality.tables.front().compute_ms ? " and by a compute shader:" : ":");
  for (const TableTime& row : quality.tables) {
    tables += " n = " + std::to_string(row.lengths) + ": " + three_digits(row.milliseconds) +
              (row.compute_ms ? ", " + three_digits(*row.compute_ms) : std::string()) + " (" +
              short_number(row.printed_gpu) + ", " + short_number(row.printed_cpu) + ");";
    section.measurements.push_back({"preintegrated table", "processor",
                                    "128x128x" + std::to_string(row.lengths), "time [ms]", row.milliseconds});
  }
  tables.back() = '.';
  section.paragraphs.push_back(tables);
  std::string focus =
      "A shaded focus at 4 samples a voxel, in the corner next to the viewer, in a context that is not "
      "shaded, "
      "at 1 sample a voxel of twice the size, with half the entries of tables and half the pixels along "
      "either "
      "edge, nothing left out (the parameters of table 5.2 of Ikits 2006): frames a second by the share of "
      "the "
      "volume's sides that the focus has, and the speed relative to all of it being focus, beside that "
      "printed "
      "in table 5.3 for 512 x 512 pixels.";
  for (const FocusRate& row : quality.focus) {
    const double gain = row.rate / quality.focus.front().rate;
    focus += " " + short_number(100.0 * row.axis) + " %: " + three_digits(row.rate) + "/s, " +
             three_digits(gain) + " times (printed " + short_number(row.printed_512) + "/s, " +
             three_digits(row.printed_512 / quality.focus.front().printed_512) + " times);";
    section.measurements.push_back(
        {"focus and context", "lens", "focus=" + short_number(row.axis), "frames a second", row.rate});
  }
  focus.back() = '.';
  section.paragraphs.push_back(focus);
  section.plots.push_back(plot_of(quality));
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

}  // namespace palpate
