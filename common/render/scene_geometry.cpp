#include "common/render/scene_geometry.h"

#include <algorithm>
#include <iterator>

#include "common/geometry/box_edges.h"
#include "common/render/lens/shape_wire.h"
#include "common/render/line/line_geometry.h"
#include "common/render/scene_parts.h"

namespace palpate {

bool SceneGeometry::update(const SceneView& view) {
  const auto tensors = view.tensors ? view.tensors->image : nullptr;
  const auto tracts = view.tracts ? view.tracts->bundle : nullptr;
  if (filled_ && shown_lines_ == view.lines && same_box(shown_bounds_, view.bounds) &&
      shown_outline_ == view.outline && shown_regions_ == view.regions && shown_tensors_ == tensors &&
      shown_tracts_ == tracts) {
    return false;
  }
  reach_ = reach_of(view);
  frame_ = scene_frame(view.bounds.empty() ? reach_ : view.bounds);
  lines_.set_geometry(view.lines.get(), frame_);
  outline_.set_geometry(
      make_line_geometry(view.outline.empty() ? box_edges(view.bounds) : view.outline, frame_));
  regions_.clear();
  for (const RegionView& region : view.regions) {
    std::vector<std::vector<Vec3>> wires;
    for (const ConvexShape& shape : region.shapes)
      std::ranges::move(shape_wire(shape, view.bounds), std::back_inserter(wires));
    regions_.emplace_back().set_geometry(make_line_geometry(wires, frame_));
  }
  shown_regions_ = view.regions;
  shown_lines_ = view.lines;
  shown_bounds_ = view.bounds;
  shown_tensors_ = tensors;
  shown_tracts_ = tracts;
  shown_outline_ = view.outline;
  filled_ = true;
  return true;
}

}  // namespace palpate
