#include "common/window/panels/volume/region_panel.h"

#include <array>

#include <imgui.h>

#include "common/base/index.h"
#include "common/field/grid/image_resample.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {

RegionActions edit_region(RegionControl& region, const VolumeImage& image) {
  RegionActions actions;
  if (!region.box()) {
    if (small_button("+ box")) region.put(new_region(image.bounds()));
    hint(
        "about the middle; drag the dots on its faces. With the probe grabbed, C puts corners, and in mode "
        "grid a press takes hold of the face that the probe is at");
    return actions;
  }
  Box box = *region.box();
  constexpr std::array kAxes{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, 2> ends{box.lower[axis], box.upper[axis]};
    const bool typed = input_numbers(kAxes[as_size(axis)], ends.data(), 2, "%.6g");
    explain("box");
    if (!typed || !(ends[0] < ends[1])) continue;
    box.lower[axis] = ends[0];
    box.upper[axis] = ends[1];
    region.put(box);
  }
  const auto part =
      points_in({.points = image.points, .origin = image.origin, .axes = image.axes}, box, image.lines.get());
  if (part) {
    const Index3 n = part->points();
    ImGui::Text("%d x %d x %d voxels", n.x, n.y, n.z);
  } else {
    ImGui::TextDisabled("no voxel lies in it");
  }
  if (image.lines) {
    ImGui::TextDisabled("uneven steps: no crop");
    hint("files of images have one step an axis; clip --resample writes one");
  }
  ImGui::BeginDisabled(!part || image.lines);
  constexpr std::array kEndings{".nii.gz", ".nrrd", ".vti"};
  ImGui::TextUnformatted("crop to");
  for (const char* ending : kEndings) {
    ImGui::SameLine();
    if (small_button(ending)) actions.crop = ending;
    hint("saves the voxels in the box, in their place");
  }
  ImGui::EndDisabled();
  if (small_button("remove")) region.put(std::nullopt);
  hint("the box; the voxels stay");
  return actions;
}

}  // namespace palpate
