#include "common/hand/technique/workbench_place.h"

#include "common/render/stereo/screen_camera.h"

namespace palpate {

WorkbenchPlace place_of(const InteractionGeometry& interaction, const Vec3& middle, double scale) {
  return {middle, interaction.middle, interaction.rotation, interaction.gain / scale};
}

WorkbenchPlace place_of(const Camera& camera, const Screen& screen) {
  const Mat3 turn = camera.axes * glm::transpose(axes(screen));
  return {camera.focal_point, center(screen), glm::normalize(glm::quat_cast(turn)),
          camera.view_height / height(screen)};
}

Camera workbench_camera(const WorkbenchPlace& place, const Screen& screen) {
  return screen_camera(place(screen));
}

}  // namespace palpate
