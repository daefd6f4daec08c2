#include "lab/page/interval_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/text.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr double kWide = 560.0, kHigh = 380.0, kLeftEdge = 70.0, kRightEdge = 20.0, kTopEdge = 62.0,
                 kBottomEdge = 50.0;
constexpr std::array<const char*, 2> kFills{"#d55e00", "#0072b2"};  // Okabe and Ito 2008

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + svg_number(value) + "\"";
}

std::string stroke(double x0, double y0, double x1, double y1, const char* more) {
  return "<line" + attribute("x1", x0) + attribute("y1", y0) + attribute("x2", x1) + attribute("y2", y1) +
         " " + more + "/>\n";
}

}  // namespace

std::string svg(const IntervalPlot& plot) {
  double upper = 0.0;
  for (const IntervalGroup& group : plot.groups) {
    for (const IntervalBar& bar : group.bars) {
      const double top = bar.middle + (std::isfinite(bar.half) ? bar.half : 0.0);
      if (std::isfinite(top)) upper = std::max(upper, top);
    }
  }
  std::string body = svg_text(kLeftEdge, 24.0, plot.title, "font-size=\"16\" font-weight=\"bold\"");
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const double x = kLeftEdge + 110.0 * static_cast<double>(s);
    body += "<rect" + attribute("x", x) + attribute("y", 36.0) + " width=\"12\" height=\"12\" fill=\"" +
            kFills[s % kFills.size()] + "\"/>\n" +
            svg_text(x + 18.0, 47.0, plot.series[s], "font-size=\"13\"");
  }
  if (upper > 0.0) {
    const double step = tick_step(upper), most = step * std::ceil(upper / step * 1.02);
    const double bottom = kHigh - kBottomEdge, unit = (bottom - kTopEdge) / most;
    for (int i = 0; i * step <= most * (1.0 + 1e-9); ++i) {
      const double y = bottom - unit * i * step;
      body +=
          stroke(kLeftEdge, y, kWide - kRightEdge, y, "stroke=\"#ddd\"") +
          svg_text(kLeftEdge - 8.0, y + 4.0, short_number(i * step), "font-size=\"12\" text-anchor=\"end\"");
    }
    const double room = (kWide - kLeftEdge - kRightEdge) / static_cast<double>(plot.groups.size());
    for (std::size_t g = 0; g < plot.groups.size(); ++g) {
      const IntervalGroup& group = plot.groups[g];
      const double left = kLeftEdge + room * static_cast<double>(g);
      const double width = 0.7 * room / static_cast<double>(std::max<std::size_t>(1, group.bars.size()));
      for (std::size_t s = 0; s < group.bars.size(); ++s) {
        const IntervalBar& bar = group.bars[s];
        if (!std::isfinite(bar.middle)) continue;
        const double x = left + 0.15 * room + width * static_cast<double>(s), y = bottom - unit * bar.middle;
        body += "<rect" + attribute("x", x + 0.08 * width) + attribute("y", y) +
                attribute("width", 0.84 * width) + attribute("height", bottom - y) + " fill=\"" +
                kFills[s % kFills.size()] + "\" fill-opacity=\"0.75\"/>\n";
        if (!std::isfinite(bar.half)) continue;
        const double middle = x + 0.5 * width, half = unit * bar.half, cap = 0.12 * width;
        const char* ink = "stroke=\"#111\" stroke-width=\"1.6\"";
        body += stroke(middle, y - half, middle, y + half, ink) +
                stroke(middle - cap, y - half, middle + cap, y - half, ink) +
                stroke(middle - cap, y + half, middle + cap, y + half, ink);
      }
      body +=
          svg_text(left + 0.5 * room, bottom + 20.0, group.name, "font-size=\"13\" text-anchor=\"middle\"");
    }
    body += stroke(kLeftEdge, bottom, kWide - kRightEdge, bottom, "stroke=\"#333\"");
  } else {
    body +=
        svg_text(0.5 * kWide, 0.5 * kHigh, "nothing was measured", "font-size=\"14\" text-anchor=\"middle\"");
  }
  body += svg_text(
      18.0, 0.5 * kHigh, plot.y_label,
      ("font-size=\"13\" text-anchor=\"middle\" transform=\"rotate(-90 18 " + svg_number(0.5 * kHigh) + ")\"")
          .c_str());
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + svg_number(kWide) + " " +
         svg_number(kHigh) + "\" width=\"" + svg_number(kWide) +
         "\" font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + body +
         "</svg>\n";
}

}  // namespace palpate
