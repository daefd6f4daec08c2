/// Signs in space: flat shapes and words that lie in a plane of the scene, or face the viewer. Menus, sliders
/// and labels of an immersive view are made of them; each eye sees them where they are.
///
/// Symbols. A place (x, y) on a label, x to the right and y up, is origin + unit (x axes[0] + y axes[1]) in
/// the data.
#pragma once

#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A convex polygon, its corners counter-clockwise; sRGB.
struct LabelShape {
  std::vector<Vec2> corners;
  Vec3f color{1.0F};
  float opacity = 1.0F;

  bool operator==(const LabelShape&) const = default;
};

struct LabelText {
  Vec2 place{0.0};      ///< the left end of its line, at half its height
  double height = 1.0;  ///< of a line of text
  std::string words;
  Vec3f color{1.0F};

  bool operator==(const LabelText&) const = default;
};

struct LabelView {
  Vec3 origin{0.0};
  Mat3 axes{1.0};     ///< right, up, out; those of the camera where it faces the viewer
  double unit = 1.0;  ///< data units
  bool faces_viewer = false;
  std::vector<LabelShape> shapes;  ///< later ones over earlier ones
  std::vector<LabelText> texts;    ///< over all of them

  bool operator==(const LabelView&) const = default;
};

}  // namespace palpate
