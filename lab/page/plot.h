/// Log-log diagrams as SVG: axes with decades, grid, legend; readable in black and white by their markers.
#pragma once

#include <string>
#include <vector>

namespace palpate {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;  ///< in order; those that are not positive and finite are left out
};

struct LogLogPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  /// A horizontal line across the diagram, where positive: what lies below it means nothing.
  double floor = 0.0;
  std::string floor_label;
  bool diagonal = false;  ///< draws y = x, dotted
};

/// An SVG document. A diagram without a single point says so.
[[nodiscard]] std::string svg(const LogLogPlot& plot);

/// A place in an SVG, to two decimals.
[[nodiscard]] std::string svg_number(double value);
/// A text element. @param attributes such as `font-size="12" text-anchor="end"`.
[[nodiscard]] std::string svg_text(double x, double y, const std::string& text,
                                   const std::string& attributes);
/// 1, 2 or 5 times a power of ten: about five ticks up to `largest`.
[[nodiscard]] double tick_step(double largest);

/// Text with &, <, > and quotes replaced, for SVG and HTML.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace palpate
