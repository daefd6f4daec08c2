/// The plot of a scalar over time at the probe.
#pragma once

#include <optional>
#include <string>

#include "common/hand/probe_series.h"
#include "common/render/line_style.h"
#include "common/window/controls/view_control.h"

namespace palpate {

/// What the plot shows besides its curve.
struct SeriesPlot {
  SeriesCurve curve;
  bool reading = false;  ///< more of it is to come
  double now = 0.0;      ///< the time that the picture shows
};

/// Where the plot lies in a picture: along its lower edge, beside the axes [pixels].
[[nodiscard]] PictureArea series_plot_area(const PictureArea& picture, float text_height);

/// Draws it. @return the time of the curve at which the mouse was pressed or dragged in this frame.
[[nodiscard]] std::optional<double> draw_series_plot(const SeriesPlot& plot, const PictureArea& area,
                                                     const UnitNames& units);

}  // namespace palpate
