/// Means of two conditions side by side, with intervals, as SVG.
#pragma once

#include <string>
#include <vector>

namespace palpate {

struct IntervalBar {
  double middle = 0.0;
  double half = 0.0;  ///< of the interval; NaN: none is drawn
};

struct IntervalGroup {
  std::string name;               ///< below it
  std::vector<IntervalBar> bars;  ///< one for each series; those that are not finite are left out
};

struct IntervalPlot {
  std::string title, y_label;
  std::vector<std::string> series;  ///< names, for the legend
  std::vector<IntervalGroup> groups;
};

/// An SVG document; the axis begins at 0.
[[nodiscard]] std::string svg(const IntervalPlot& plot);

}  // namespace palpate
