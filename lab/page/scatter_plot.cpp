#include "lab/page/scatter_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

// Layout in SVG user units.
constexpr double kScatterWidth = 640.0, kScatterHeight = 420.0, kScatterLeft = 70.0, kScatterRight = 20.0,
                 kScatterTop = 60.0, kScatterBottom = 56.0;
constexpr double kMark = 3.0;
// Dark enough on white paper, and told apart by most eyes (Okabe and Ito 2008).
constexpr std::array<const char*, 3> kColors{"#d55e00", "#0072b2", "#009e73"};

}  // namespace

std::string svg(const ScatterPlot& plot) {
  Vec2 upper{0.0};
  for (const ScatterSeries& series : plot.series) {
    for (const Vec2& p : series.points) {
      if (std::isfinite(p.x) && std::isfinite(p.y)) upper = glm::max(upper, p);
    }
  }
  std::string body = svg_text(kScatterLeft, 24.0, plot.title, "font-size=\"16\" font-weight=\"bold\"");
  if (upper.x > 0.0 && upper.y > 0.0) {
    const Vec2 step{tick_step(upper.x), tick_step(upper.y)};
    const Vec2 end = glm::ceil(upper / step) * step;
    const Vec2 scale =
        Vec2{kScatterWidth - kScatterLeft - kScatterRight, kScatterHeight - kScatterTop - kScatterBottom} /
        end;
    const double floor = kScatterHeight - kScatterBottom;
    const auto grid = [](double x1, double y1, double x2, double y2) {
      return "<line x1=\"" + svg_number(x1) + "\" y1=\"" + svg_number(y1) + "\" x2=\"" + svg_number(x2) +
             "\" y2=\"" + svg_number(y2) + "\" stroke=\"#ddd\"/>\n";
    };
    for (int i = 0; i * step.x <= end.x * 1.0001; ++i) {
      const double x = kScatterLeft + i * step.x * scale.x;
      body += grid(x, kScatterTop, x, floor) +
              svg_text(x, floor + 18.0, three_digits(i * step.x), "font-size=\"12\" text-anchor=\"middle\"");
    }
    for (int i = 0; i * step.y <= end.y * 1.0001; ++i) {
      const double y = floor - i * step.y * scale.y;
      body += grid(kScatterLeft, y, kScatterWidth - kScatterRight, y) +
              svg_text(kScatterLeft - 8.0, y + 4.0, three_digits(i * step.y),
                       "font-size=\"12\" text-anchor=\"end\"");
    }
    double key = kScatterLeft;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
      // Rings and discs stay apart without colour.
      const std::string paint = s == 0 ? std::string("fill=\"none\" stroke=\"") + kColors[0] + "\""
                                       : std::string("fill=\"") + kColors[s % kColors.size()] + "\"";
      const auto mark = [&](double x, double y) {
        return "<circle cx=\"" + svg_number(x) + "\" cy=\"" + svg_number(y) + "\" r=\"" + svg_number(kMark) +
               "\" " + paint + "/>\n";
      };
      for (const Vec2& p : plot.series[s].points) {
        if (std::isfinite(p.x) && std::isfinite(p.y))
          body += mark(kScatterLeft + p.x * scale.x, floor - p.y * scale.y);
      }
      body += mark(key, 42.0) + svg_text(key + 10.0, 46.0, plot.series[s].name, "font-size=\"12\"");
      constexpr double kPerLetter = 7.0;
      key += 40.0 + kPerLetter * static_cast<double>(plot.series[s].name.size());
    }
  } else {
    body += svg_text(kScatterLeft, kScatterHeight / 2.0, "no points", "font-size=\"14\"");
  }
  body += svg_text((kScatterLeft + kScatterWidth - kScatterRight) / 2.0, kScatterHeight - 14.0, plot.x_label,
                   "font-size=\"13\" text-anchor=\"middle\"");
  const std::string middle = svg_number((kScatterTop + kScatterHeight - kScatterBottom) / 2.0);
  body += "<text x=\"18\" y=\"" + middle +
          "\" font-size=\"13\" text-anchor=\"middle\" transform=\"rotate(-90 18 " + middle + ")\">" +
          escaped(plot.y_label) + "</text>\n";
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + svg_number(kScatterWidth) + " " +
         svg_number(kScatterHeight) + "\" width=\"" + svg_number(kScatterWidth) + "\" height=\"" +
         svg_number(kScatterHeight) +
         "\" font-family=\"sans-serif\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"#fff\"/>\n" +
         body + "</svg>\n";
}

}  // namespace palpate
