#include "common/window/controls/scene_controls.h"

#include <cmath>
#include <utility>
#include <vector>

#include "common/geometry/box_edges.h"
#include "common/hand/drawn/annotation_list.h"
#include "common/render/stereo/stereo_view.h"
#include "common/window/controls/plane_control.h"

namespace palpate {
namespace {

/// Whether the plane through the focal point, across the line of sight, meets the box.
bool is_met(const Box& box, const Camera& camera) {
  const Vec3& normal = camera.axes[2];
  return std::abs(glm::dot(box.center() - camera.focal_point, normal)) <=
         0.5 * glm::dot(box.size(), glm::abs(normal));
}

}  // namespace

SceneControls::SceneControls(ProbeSession& touch, const std::optional<Box>& region)
    : session_(touch), region_(region), touch_control_(touch) {}

void SceneControls::place(const ControlledScene& on, bool two) {
  menu_.place(on.view.camera, on.picture, session_.hand().device_reach());
  pointer_.over(two ? on.view.stereo : StereoView{}, on.picture);
}

Camera SceneControls::seeing(const ControlledScene& on) const {
  if (on.workbench == nullptr || on.beside_screens) return seeing_camera(on.view, pointer_.eye());
  SceneView seen = on.view;
  on.workbench->show(seen);
  return seeing_camera(seen, pointer_.eye());
}

std::optional<std::string> SceneControls::handle(const InputEvent& event, const ControlledScene& on,
                                                 bool over_panel, bool in_text) {
  const PictureArea& area = pointer_.area();
  SceneView& view = on.view;
  const Aim aim(view.camera, seeing(on));
  const bool begins = event.kind == InputKind::kPress || event.kind == InputKind::kWheel;
  const bool key = event.kind == InputKind::kKeyDown || event.kind == InputKind::kKeyUp;
  const bool of_panel = (begins && over_panel && !view_.dragging()) || (key && in_text);
  // A lens that follows the mouse is left where it is clicked, whatever the hand could take there.
  const bool leaves_lens = event.kind == InputKind::kPress && (lens_.followed() || color_lens_.followed());
  const bool followed = lens_.followed().has_value();
  bool lens = false;
  const bool of_pane = !of_panel && view.volume && handle_pane(event, on);
  const bool picks = !of_panel && !of_pane && !touch_control_.grabbed() &&
                     tract_pick_.handle(event, area, seeing(on), std::nullopt);
  if (!of_panel && !of_pane && !picks && !menu_.handle(event, area, view.camera) &&
      !handle_region(event, on) && !handle_plane_image(event, on) &&
      !(leaves_lens && (lens = handle_lens(event, on))) &&
      !touch_control_.handle(event, area, view, on.time, over_panel) && !(lens = handle_lens(event, on)) &&
      !(view.tensors && slice_.handle(event, area, view.camera, *view.tensors))) {
    view_.handle(event, area, view.bounds, view.camera);
  } else if (event.kind == InputKind::kMove) {
    view_.place(event.x, event.y);
    slice_.place(event.x, event.y);
  }
  // Where it is left, what was said of moving it is over.
  const bool left = (lens && event.kind == InputKind::kPress) || (followed && !lens_.followed());
  return left ? std::optional(std::string()) : std::nullopt;
}

/// What is marked, a region and a lens can be placed in slices as in the picture of the volume; else the event is for the
/// slices themselves.
bool SceneControls::handle_pane(const InputEvent& event, const ControlledScene& on) {
  const std::optional<Sight> sight = pane_control_.sight(on.panes, on.view);
  if (!sight) return false;
  const bool presses = event.kind == InputKind::kPress && event.button == MouseButton::kLeft;
  if (const auto place = pane_control_.place(on.panes, on.view);
      presses && touch_control_.marking() && place) {
    session_.notes().add(*place);
    return true;
  }
  const std::optional<Vec3> under = pane_control_.place(on.panes, on.view);
  if (brush_.handle(event, under)) return true;
  if (under && tract_pick_.handle(event, sight->area, sight->camera, under)) return true;
  if (touch_control_.grabbed() || touch_control_.waiting()) {
    // The hand moves in the plane of the slice.
    const Camera own = std::exchange(on.view.camera, sight->camera);
    const bool taken = touch_control_.handle(event, sight->area, on.view, on.time, false);
    on.view.camera = own;
    if (taken) return true;
  }
  VolumeView& volume = *on.view.volume;
  const bool region = on.has_region() && region_.box() && !touch_control_.grabbed() &&
                      (region_.dragging() || is_met(*region_.box(), sight->camera));
  if (region && region_.handle(event, sight->area, sight->camera, on.view.bounds)) return true;
  // One that stays on the screen is none of slices.
  const auto lens = lens_.followed();
  if (lens && *lens < volume.lenses.size() && !volume.lenses[*lens].screen) {
    lens_moved_ = true;
    if (lens_.handle(event, sight->area, sight->camera, on.view.bounds, volume)) return true;
  }
  return pane_control_.handle(event, on.panes, on.view, volume);
}

/// While the probe is grabbed the mouse is its own.
bool SceneControls::handle_region(const InputEvent& event, const ControlledScene& on) {
  if (!on.has_region() || (touch_control_.grabbed() && event.kind != InputKind::kMove)) return false;
  return region_.handle(event, pointer_.area(), on.view.camera, on.view.bounds);
}

bool SceneControls::handle_plane_image(const InputEvent& event, const ControlledScene& on) {
  if (!on.view.volume) return false;
  const bool taken = plane_image_.handle(event, pointer_.area(), on.view.camera, *on.view.volume);
  lens_moved_ = lens_moved_ || plane_image_.dragging();
  return taken;
}

bool SceneControls::handle_lens(const InputEvent& event, const ControlledScene& on) {
  if (on.has_layer()) return color_lens_.handle(event, pointer_.area(), on.view);
  if (!on.view.volume) return false;
  lens_moved_ = lens_moved_ || lens_.followed();
  return lens_.handle(event, pointer_.area(), on.view.camera, on.view.bounds, *on.view.volume);
}

std::string SceneControls::run_lens(Command command, const ControlledScene& on) {
  if (on.has_layer()) return color_lens_.run(command, on.view);
  lens_moved_ = true;
  return lens_.run(command, pointer_.area(), on.view.camera, on.view.bounds, on.scene->appearance(0),
                   *on.view.volume);
}

std::string SceneControls::put_corner() {
  if (!session_.readout().held) return "grab the probe (G) first: the corner is put where it is";
  return region_.put_corner(session_.readout().proxy);
}

std::optional<std::string> SceneControls::run(Command command, const ControlledScene& on) {
  SceneView& view = on.view;
  // What is under the mouse is what the eye sees whose picture it is in.
  const Aim aim(view.camera, seeing(on));
  switch (command) {
    case Command::kLens:
    case Command::kLensSmaller:
    case Command::kLensLarger:
      return on.scene && (on.has_layer() || view.volume)
                 ? run_lens(command, on)
                 : "a lens shows a part of a volume, or of a heart's layer: there is none here";
    case Command::kCorner:
      return on.has_region() ? put_corner()
                             : "a box of interest is cut from a volume alone: there is none here";
    case Command::kSliceRight:
    case Command::kSliceLeft:
    case Command::kSliceFront:
    case Command::kSliceBack:
    case Command::kSliceUp:
    case Command::kSliceDown:
      if (!view.tensors) return "these keys move slices of tensors: there are none here";
      break;
    default:
      break;
  }
  const double aspect = eye_aspect(view.stereo.mode, on.picture.width, on.picture.height);
  if (ViewControl::look(command, view.bounds, aspect, view.camera)) return std::nullopt;
  if (view.tensors && SliceControl::run(command, *view.tensors)) return std::nullopt;
  if (view.volume && PaneControl::run(command, *view.volume)) return std::nullopt;
  return touch_control_.run(command, pointer_.area(), view, on.time);
}

void SceneControls::let_go() {
  view_.let_go();
  slice_.let_go();
  pane_control_.let_go();
  lens_.let_go();
  color_lens_.follow(false);
  plane_image_.let_go();
  region_.let_go();
  brush_.let_go();
  tract_pick_.let_go();
  touch_control_.let_go();
  touch_control_.mark(false);
}

std::optional<std::string> SceneControls::work_in_space(const ControlledScene& on) {
  Camera seeing = on.view.camera;
  if (on.workbench != nullptr) {
    // Between both eyes, where they are before the screen.
    const Eyes& eyes = on.workbench->eyes();
    const Vec3 viewer = place_of(on.view.camera, on.workbench->screen())(0.5 * (eyes[0] + eyes[1]));
    if (glm::dot(viewer - seeing.focal_point, seeing.axes[2]) > 0.0) seeing = seen_from(seeing, viewer);
  }
  auto words = hand_in_space_.follow(menu_, session_, on.view, seeing, pointer_.area(), on.time);
  lens_moved_ = lens_moved_ || hand_in_space_.holding();
  return words;
}

void SceneControls::lead_by_grid(const ControlledScene& on) {
  const bool holds = session_.holds_on_grid();
  const Vec3& hand = session_.readout().proxy;
  if (on.has_region()) region_.follow_hand(holds, hand, holds ? session_.box_reach() : 0.0, on.view.bounds);
  const std::optional<Vec3> left = view_hold_.follow(holds && !region_.dragging(), hand);
  if (!left) return;
  on.view.camera.focal_point += *left;
  session_.shift_hand(on.time, *left);
}

void SceneControls::toggle_menu(const ControlledScene& on) {
  if (on.scene == nullptr) return;
  std::vector<std::string> modes;
  for (const HapticMode& mode : session_.modes()) modes.push_back(mode.name);
  menu_.toggle(*on.scene, on.view, modes);
  session_.hand().engage(false);
}

std::optional<TensorPick> SceneControls::tensor_under_mouse(const ControlledScene& on) const {
  if (!on.view.tensors || view_.dragging() || session_.readout().held) return std::nullopt;
  return slice_.under_mouse(pointer_.area(), seeing(on), *on.view.tensors);
}

/// The place under the mouse that is the next one of an annotation which is begun; none where none is.
std::optional<Vec3> SceneControls::next_mark(const ControlledScene& on) {
  if (session_.notes().pending().empty()) return std::nullopt;
  SceneView seen = on.view;
  seen.camera = seeing(on);
  return touch_control_.next_mark(pointer_.area(), seen);
}

void SceneControls::decorate(const ControlledScene& on, SceneView& picture) {
  if (const Vec3 moved = view_hold_.moved(); moved != Vec3{0.0}) {
    // The hand is drawn on the place of the scene that it has taken hold of.
    picture.camera.focal_point += moved;
    if (picture.probe) {
      picture.probe->probe += moved;
      picture.probe->proxy += moved;
      for (Vec3& proxy : picture.probe->links) proxy += moved;
    }
  }
  // Since place() it may have turned the view itself.
  menu_.place(on.view.camera, on.picture, session_.hand().device_reach());
  if (auto menu = menu_.drawn()) picture.labels.push_back(std::move(*menu));
  picture.notes = notes_of(session_.notes(), length_unit(picture), next_mark(on));
  if (const auto& picked = hand_in_space_.picked()) picture.notes.push_back(note_of(*picked));
  std::vector<std::vector<Vec3>> handled;
  if (session_.planes())
    handled = lines_of_planes(session_.planes()->poses, picture.bounds, session_.sphere_radius());
  const auto lens = lens_.followed();
  if (lens && on.view.volume && *lens < on.view.volume->lenses.size()) {
    if (auto circle = outline_of(on.view.volume->lenses[*lens], on.view.camera); !circle.empty())
      handled.push_back(std::move(circle));
  }
  if (on.has_region()) {
    if (region_.box()) {
      picture.volume->panes.box = region_.box();
      for (auto& edge : box_edges(*region_.box())) handled.push_back(std::move(edge));
    }
    if (auto dots = region_.dots(); !dots.empty())
      picture.notes.push_back({.points = std::move(dots), .outline = {}, .words = {}});
  }
  if (!handled.empty() && picture.outline.empty()) picture.outline = box_edges(picture.bounds);
  picture.outline.insert(picture.outline.end(), handled.begin(), handled.end());
}

}  // namespace palpate
