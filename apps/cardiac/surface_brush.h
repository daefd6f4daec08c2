/// The part of the panel about the wall's surfaces: which are shown, what they were taken for, and a brush that corrects
/// them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/cardiac/tag_writer.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/math/vec.h"
#include "common/window/panels/panel.h"

namespace palpate {

/// While the brush is on, the mouse paints where it is led over the wall with its left button down; when that is let go
/// of, what was painted goes into the document as `--paint-surface` has it, one edit a stroke.
class SurfaceBrush {
 public:
  void operator()(PanelContext& on);

 private:
  void paint(PanelContext& on);
  void save_tags(PanelContext& on);

  bool on_ = false;
  BorderRole role_ = BorderRole::kInner;
  double size_ = 0.05;               ///< radius [diagonals of the scene]
  std::vector<std::string> stroke_;  ///< not in the document yet
  std::optional<Vec3> last_;         ///< where its last ball of paint is
  std::shared_ptr<TagWriter> tags_ = std::make_shared<TagWriter>();
};

}  // namespace palpate
