#include "lab/page/plane_picture.h"

#include <algorithm>
#include <array>

#include "lab/page/plot.h"

namespace palpate {
namespace {

// Layout in SVG user units.
constexpr double kPanelWidth = 300.0, kGap = 20.0, kTop = 64.0, kLegend = 44.0;
constexpr double kMark = 2.2;
constexpr std::size_t kPanelsInARow = 2;

/// Dark enough on white paper, and told apart by most eyes (Okabe and Ito 2008).
const char* color_of(std::size_t index) {
  constexpr std::array<const char*, 6> kColors{"#777777", "#0072b2", "#d55e00",
                                               "#009e73", "#cc79a7", "#e69f00"};
  return kColors[index % kColors.size()];
}

/// Where the plane lies in one panel.
struct Panel {
  double x = 0.0, y = 0.0;  ///< its upper left corner
  double scale = 1.0;
  Vec2 lower{0.0}, upper{0.0};
  [[nodiscard]] std::string at(const Vec2& p) const {
    return svg_number(x + scale * (p.x - lower.x)) + "," + svg_number(y + scale * (upper.y - p.y));
  }
};

std::string drawn(const PictureCurve& curve, const Panel& panel, const char* color) {
  std::string out;
  if (!curve.marks) {
    out = "<polyline fill=\"none\" stroke=\"" + std::string(color) + "\" stroke-width=\"1.8\"" +
          (curve.dashed ? " stroke-dasharray=\"6 4\"" : "") + " points=\"";
    for (const Vec2& p : curve.points) out += panel.at(p) + " ";
    return out + "\"/>\n";
  }
  for (const Vec2& p : curve.points) {
    const std::string place = panel.at(p);
    const std::size_t comma = place.find(',');
    out += "<circle cx=\"" + place.substr(0, comma) + "\" cy=\"" + place.substr(comma + 1) + "\" r=\"" +
           svg_number(kMark) + "\" fill=\"" + color + "\"/>\n";
  }
  return out;
}

}  // namespace

std::string svg(const PlanePicture& picture) {
  std::vector<const PictureCurve*> legend;
  const auto index_of = [&](const PictureCurve& curve) {
    for (std::size_t i = 0; i < legend.size(); ++i) {
      if (legend[i]->name == curve.name) return i;
    }
    legend.push_back(&curve);
    return legend.size() - 1;
  };
  const Vec2 size = picture.upper - picture.lower;
  const double height = kPanelWidth * size.y / size.x;
  const std::size_t rows = (picture.panels.size() + kPanelsInARow - 1) / kPanelsInARow;
  const double width = kPanelsInARow * (kPanelWidth + kGap) + kGap;
  const double total = kTop + static_cast<double>(rows) * (height + kTop - kGap) + kLegend;
  std::string body;
  for (std::size_t n = 0; n < picture.panels.size(); ++n) {
    const PicturePanel& content = picture.panels[n];
    const std::size_t column = n % kPanelsInARow, row = n / kPanelsInARow;
    const Panel panel{kGap + static_cast<double>(column) * (kPanelWidth + kGap),
                      kTop + static_cast<double>(row) * (height + kTop - kGap), kPanelWidth / size.x,
                      picture.lower, picture.upper};
    const std::string box = "x=\"" + svg_number(panel.x) + "\" y=\"" + svg_number(panel.y) + "\" width=\"" +
                            svg_number(kPanelWidth) + "\" height=\"" + svg_number(height) + "\"";
    const std::string clip = "panel" + std::to_string(n);
    body += svg_text(panel.x, panel.y - 8.0, content.title, "font-size=\"14\"");
    body.append("<clipPath id=\"").append(clip).append("\"><rect ").append(box);
    body.append("/></clipPath>\n<g clip-path=\"url(#").append(clip).append(")\">\n");
    for (const PictureCurve& curve : content.curves) body += drawn(curve, panel, color_of(index_of(curve)));
    body.append("</g>\n<rect ").append(box).append(" fill=\"none\" stroke=\"#444\"/>\n");
    const double bar_y = panel.y + height - 10.0, bar_x = panel.x + 10.0;
    body += "<line x1=\"" + svg_number(bar_x) + "\" y1=\"" + svg_number(bar_y) + "\" x2=\"" +
            svg_number(bar_x + panel.scale * picture.bar) + "\" y2=\"" + svg_number(bar_y) +
            "\" stroke=\"#222\" stroke-width=\"2.5\"/>\n" +
            svg_text(bar_x, bar_y - 5.0, picture.bar_label, "font-size=\"11\"");
  }
  double x = kGap;
  const double y = total - kLegend + 14.0;
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const Panel key{x, y, 1.0, Vec2{0.0}, Vec2{0.0}};
    PictureCurve sample = *legend[i];
    sample.points = sample.marks ? std::vector{Vec2{4.0, 4.0}, Vec2{12.0, 4.0}, Vec2{20.0, 4.0}}
                                 : std::vector{Vec2{0.0, 4.0}, Vec2{24.0, 4.0}};
    body += drawn(sample, key, color_of(i)) + svg_text(x + 30.0, y, sample.name, "font-size=\"12\"");
    constexpr double kPerLetter = 6.6;
    x += 44.0 + kPerLetter * static_cast<double>(sample.name.size());
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + svg_number(width) + " " +
         svg_number(total) + "\" width=\"" + svg_number(width) + "\" height=\"" + svg_number(total) +
         "\" font-family=\"sans-serif\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"#fff\"/>\n" +
         svg_text(kGap, 26.0, picture.title, "font-size=\"16\" font-weight=\"bold\"") + body + "</svg>\n";
}

}  // namespace palpate
