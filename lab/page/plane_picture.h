/// Pictures of what happens in a plane, as SVG: panels side by side at one scale, with curves and marks.
#pragma once

#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A curve, or marks at its points. The looks of a name are the same in all panels.
struct PictureCurve {
  std::string name;  ///< in the legend, once
  std::vector<Vec2> points;
  bool marks = false;  ///< small discs in place of a line
  bool dashed = false;
};

struct PicturePanel {
  std::string title;
  std::vector<PictureCurve> curves;  ///< the first ones lie below
};

struct PlanePicture {
  std::string title;
  Vec2 lower{0.0}, upper{0.0};  ///< what of the plane is shown, the same in all panels
  double bar = 0.0;             ///< length of the scale's bar, in units of the plane
  std::string bar_label;        ///< "5 mm"
  std::vector<PicturePanel> panels;
};

/// An SVG document. @pre lower < upper.
[[nodiscard]] std::string svg(const PlanePicture& picture);

}  // namespace palpate
