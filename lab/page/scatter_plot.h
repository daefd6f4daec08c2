/// Points over linear axes as SVG: every measurement seen, series told apart by colour and shape.
#pragma once

#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct ScatterSeries {
  std::string name;
  std::vector<Vec2> points;  ///< those that are not finite are left out
};

struct ScatterPlot {
  std::string title;
  std::string x_label, y_label;
  std::vector<ScatterSeries> series;  ///< the first one lies below
};

/// An SVG document; both axes begin at 0. A plot without a single point says so.
[[nodiscard]] std::string svg(const ScatterPlot& plot);

}  // namespace palpate
