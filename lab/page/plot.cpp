#include "lab/page/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/render/color/color_map.h"
#include "common/render/ticks.h"

namespace palpate {
namespace {

// Layout in SVG user units.
constexpr double kWidth = 820.0, kHeight = 520.0;
constexpr double kLeft = 90.0, kRight = 640.0, kTop = 46.0, kBottom = 450.0;
constexpr double kLegendX = 660.0, kLegendStep = 22.0, kLegendText = 34.0, kLegendGap = 12.0;
constexpr double kLetter = 7.4;  // of text 13 high, wide ones
constexpr double kMarker = 4.5;
constexpr int kMaxTicks = 12;

bool drawable(const PlotPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && p.x > 0.0 && p.y > 0.0;
}

std::string color_of(std::size_t series) {
  // The palette's light colours come last: they are weak on white paper.
  constexpr std::array<int, kCategoryCount> kOrder{4, 1, 2, 5, 6, 0, 7, 3};
  const Rgb rgb = map_color(ColorMap::kCategorical, (kOrder[series % kOrder.size()] + 0.5) / kCategoryCount);
  std::array<char, 16> text{};
  const auto byte = [](float c) {
    return static_cast<unsigned>(std::lround(255.0F * std::clamp(c, 0.0F, 1.0F)));
  };
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(rgb.x), byte(rgb.y), byte(rgb.z));
  return text.data();
}

/// One of six shapes, so that the series can be told apart without colours.
std::string marker(std::size_t series, double x, double y, const std::string& color) {
  const double r = kMarker;
  const std::string style = "\" fill=\"" + color + "\" stroke=\"#222\" stroke-width=\"0.6\"/>";
  const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
    std::string text = "<polygon points=\"";
    for (const auto& [dx, dy] : corners) text += svg_number(x + r * dx) + "," + svg_number(y + r * dy) + " ";
    return text + style;
  };
  switch (series % 6) {
    case 0:
      return "<circle cx=\"" + svg_number(x) + "\" cy=\"" + svg_number(y) + "\" r=\"" + svg_number(r) + style;
    case 1:
      return polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
    case 2:
      return polygon({{0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}});
    case 3:
      return polygon({{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}});
    case 4:
      return polygon({{0, 1.2}, {1.1, -0.8}, {-1.1, -0.8}});
    default:
      return polygon({{-1.2, -0.4},
                      {-0.4, -0.4},
                      {-0.4, -1.2},
                      {0.4, -1.2},
                      {0.4, -0.4},
                      {1.2, -0.4},
                      {1.2, 0.4},
                      {0.4, 0.4},
                      {0.4, 1.2},
                      {-0.4, 1.2},
                      {-0.4, 0.4},
                      {-1.2, 0.4}});
  }
}

std::string anchored(double x, double y, const std::string& anchor, const std::string& text, int size = 13,
                     const std::string& more = "") {
  return svg_text(x, y, text,
                  "text-anchor=\"" + anchor + "\" font-size=\"" + std::to_string(size) + "\"" + more);
}

std::string line_between(double x0, double y0, double x1, double y1, const std::string& style) {
  return "<line x1=\"" + svg_number(x0) + "\" y1=\"" + svg_number(y0) + "\" x2=\"" + svg_number(x1) +
         "\" y2=\"" + svg_number(y1) + "\" " + style + "/>\n";
}

/// A range of whole decades around the values.
ValueRange decades(double lower, double upper) {
  ValueRange range{std::pow(10.0, std::floor(std::log10(lower) + 1e-9)),
                   std::pow(10.0, std::ceil(std::log10(upper) - 1e-9))};
  if (!(range.upper > range.lower)) range.upper = 10.0 * range.lower;
  return range;
}

double fraction_of(double value, const ValueRange& range) {
  return std::log(value / range.lower) / std::log(range.upper / range.lower);
}

struct Axes {
  ValueRange x, y;
  [[nodiscard]] double px(double value) const { return kLeft + (kRight - kLeft) * fraction_of(value, x); }
  [[nodiscard]] double py(double value) const { return kBottom - (kBottom - kTop) * fraction_of(value, y); }
};

std::string frame_of(const LogLogPlot& plot, const Axes& axes) {
  std::string out;
  const std::string grid = "stroke=\"#ddd\" stroke-width=\"1\"";
  for (const Tick& tick : ticks(axes.x, true, kMaxTicks)) {
    out += line_between(axes.px(tick.value), kTop, axes.px(tick.value), kBottom, grid);
    out += anchored(axes.px(tick.value), kBottom + 18, "middle", tick.text);
  }
  for (const Tick& tick : ticks(axes.y, true, kMaxTicks)) {
    out += line_between(kLeft, axes.py(tick.value), kRight, axes.py(tick.value), grid);
    out += anchored(kLeft - 8, axes.py(tick.value) + 4, "end", tick.text);
  }
  out += "<rect x=\"" + svg_number(kLeft) + "\" y=\"" + svg_number(kTop) + "\" width=\"" +
         svg_number(kRight - kLeft) + "\" height=\"" + svg_number(kBottom - kTop) +
         "\" fill=\"none\" stroke=\"#444\"/>\n";
  out += anchored(0.5 * (kLeft + kRight), kBottom + 42, "middle", plot.x_label, 14);
  out += anchored(22, 0.5 * (kTop + kBottom), "middle", plot.y_label, 14,
                  " transform=\"rotate(-90 22 " + svg_number(0.5 * (kTop + kBottom)) + ")\"");
  return out;
}

std::string curve(const PlotSeries& series, std::size_t index, const Axes& axes) {
  const std::string color = color_of(index);
  std::string path;
  std::string markers;
  for (const PlotPoint& p : series.points) {
    if (!drawable(p)) continue;
    path += svg_number(axes.px(p.x)) + "," + svg_number(axes.py(p.y)) + " ";
    markers += marker(index, axes.px(p.x), axes.py(p.y), color) + "\n";
  }
  return "<polyline points=\"" + path + "\" fill=\"none\" stroke=\"" + color + "\" stroke-width=\"1.8\"/>\n" +
         markers;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string svg(const LogLogPlot& plot) {
  double lowest_x = HUGE_VAL, highest_x = 0.0, lowest_y = HUGE_VAL, highest_y = 0.0;
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& p : series.points) {
      if (!drawable(p)) continue;
      lowest_x = std::min(lowest_x, p.x);
      highest_x = std::max(highest_x, p.x);
      lowest_y = std::min(lowest_y, p.y);
      highest_y = std::max(highest_y, p.y);
    }
  }
  std::size_t longest = 0;
  for (const PlotSeries& series : plot.series) longest = std::max(longest, series.name.size());
  const double width =
      std::max(kWidth, kLegendX + kLegendText + kLetter * static_cast<double>(longest) + kLegendGap);
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + svg_number(width) + " " +
      svg_number(kHeight) + "\" width=\"" + svg_number(width) + "\" height=\"" + svg_number(kHeight) +
      "\" font-family=\"sans-serif\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += anchored(kLeft, 28, "start", plot.title, 16, " font-weight=\"bold\"");
  if (!(highest_x > 0.0)) return out + anchored(kLeft, 80, "start", "nothing to draw") + "</svg>\n";

  const bool has_floor = std::isfinite(plot.floor) && plot.floor > 0.0;
  if (has_floor) {
    lowest_y = std::min(lowest_y, plot.floor);
    highest_y = std::max(highest_y, plot.floor);
  }
  const Axes axes{decades(lowest_x, highest_x), decades(lowest_y, highest_y)};
  out += frame_of(plot, axes);
  if (has_floor) {
    const double y = axes.py(plot.floor);
    out += line_between(kLeft, y, kRight, y, "stroke=\"#777\" stroke-width=\"1.4\" stroke-dasharray=\"7 5\"");
    out += anchored(kRight - 6, y - 6, "end", plot.floor_label, 12);
  }
  if (plot.diagonal) {
    const double low = std::max(axes.x.lower, axes.y.lower);
    const double high = std::min(axes.x.upper, axes.y.upper);
    if (low < high) {
      out += line_between(axes.px(low), axes.py(low), axes.px(high), axes.py(high),
                          "stroke=\"#777\" stroke-width=\"1.4\" stroke-dasharray=\"2 4\"");
    }
  }
  double legend_y = kTop + 10;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    out += curve(plot.series[s], s, axes);
    out += line_between(kLegendX, legend_y, kLegendX + 26, legend_y,
                        "stroke=\"" + color_of(s) + "\" stroke-width=\"1.8\"");
    out += marker(s, kLegendX + 13, legend_y, color_of(s)) + "\n";
    out += anchored(kLegendX + kLegendText, legend_y + 4, "start", plot.series[s].name);
    legend_y += kLegendStep;
  }
  return out + "</svg>\n";
}

double tick_step(double largest) {
  const double rough = largest / 5.0, power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

std::string svg_text(double x, double y, const std::string& text, const std::string& attributes) {
  return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" " + attributes + ">" + escaped(text) +
         "</text>\n";
}

std::string svg_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

}  // namespace palpate
