#include "common/window/panels/plane_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <imgui.h>

#include "common/base/index.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/widget/widget_text.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/panes_panel.h"

namespace palpate {
namespace {

/// A number field that answers when the user is done with it.
bool field(const char* label, double* values, int count) {
  input_numbers(label, values, count, "%.6g");
  return ImGui::IsItemDeactivatedAfterEdit();
}

/// @return the pose after what the user did; nothing where that was nothing.
std::optional<PlanePose> edit_pose(const PlanePose& pose, const ProbeSession& session, const Camera& camera) {
  const Vec4 plane = plane_of_pose(pose);
  // What is being typed stays until it is done: a widget's own memory, by plane.
  std::array<double, 3> n{plane.x, plane.y, plane.z};
  double d = plane.w;
  std::optional<PlanePose> wanted;
  const bool turned = field("normal", n.data(), 3);
  hint("n in n.x = d: what lies where n.x > d is cut away");
  const bool moved = field("d", &d, 1);
  hint("d in n.x = d, in units of the data");
  const Vec3 normal{n[0], n[1], n[2]};
  const double size = glm::length(normal);
  if (turned && size > 0.0 && std::isfinite(size)) wanted = turned_to(pose, normal / size);
  if (moved && std::isfinite(d)) {
    wanted = pose;
    wanted->center += (d - plane.w) * Vec3{plane};
  }
  if (small_button("flip")) wanted = turned_to(pose, -Vec3{plane});
  hint("the other side is cut away");
  ImGui::SameLine();
  if (small_button("to view")) wanted = turned_to(pose, camera.axes[2]);
  hint("faces the viewer, who looks at what it leaves");
  ImGui::SameLine();
  if (small_button("gradient")) {
    if (const auto steepest = session.data().gradient_at(pose.center)) wanted = turned_to(pose, *steepest);
  }
  hint("across the steepest way of the values at its middle");
  return wanted;
}

/// A button that puts a plane through the first three points of what is marked: into the hand where it moves
/// planes, else as a cut.
void offer_plane(const Annotation& marked, ProbeSession& session, std::vector<CuttingPlane>& cuts) {
  if (marked.points.size() < 3) return;
  const bool in_hand = session.planes().has_value();
  const bool room = in_hand ? session.planes()->poses.count < PlanePoses::kMax : cuts.size() < kMostCuts;
  const auto pose = pose_through({marked.points[0], marked.points[1], marked.points[2]});
  ImGui::SameLine();
  ImGui::BeginDisabled(!room || !pose);
  const bool wanted = small_button("+ plane");
  ImGui::EndDisabled();
  hint("through its first three points");
  if (!wanted) return;
  if (in_hand) {
    PlanePoses poses = session.planes()->poses;
    poses.pose[as_size(poses.count++)] = *pose;
    session.put_planes(poses);
  } else {
    const Vec4 plane = plane_of_pose(*pose);
    cuts.push_back({.kept = {Vec3{plane}, plane.w}, .on = true});
  }
}

}  // namespace

void edit_planes(ProbeSession& session, const Camera& camera, std::span<CuttingPlane> cuts) {
  if (!session.planes()) return;
  PlanePoses poses = session.planes()->poses;
  bool edited = false;
  std::optional<int> gone;
  for (int i = 0; i < poses.count; ++i) {
    ImGui::PushID(i);
    const bool unfolded = draw_fold(true);
    const std::string name = "plane " + std::to_string(i + 1);
    if (as_size(i) < cuts.size()) {
      checkbox((name + " cuts").c_str(), &cuts[as_size(i)].on);
      hint("what lies beyond the plane is not drawn");
    } else {
      ImGui::TextUnformatted(name.c_str());
    }
    PlanePose& pose = poses.pose[as_size(i)];
    if (unfolded) {
      if (const auto wanted = edit_pose(pose, session, camera)) {
        pose = *wanted;
        edited = true;
      }
    }
    if (poses.count > 1) {
      ImGui::SameLine();
      if (small_button("remove")) gone = i;
      hint("the plane (Ctrl+Z takes it back)");
    }
    ImGui::PopID();
  }
  if (gone) {
    if (cuts.size() >= as_size(poses.count))
      std::rotate(cuts.begin() + *gone, cuts.begin() + *gone + 1, cuts.begin() + poses.count);
    for (int i = *gone; i + 1 < poses.count; ++i) poses.pose[as_size(i)] = poses.pose[as_size(i) + 1];
    poses.pose[as_size(--poses.count)] = {};
    edited = true;
  }
  if (poses.count == PlanePoses::kMax) {
    ImGui::TextDisabled("%d planes: no more are possible", PlanePoses::kMax);
  } else if (small_button("+ plane")) {
    poses.pose[as_size(poses.count++)] = turned_to({.center = camera.focal_point}, camera.axes[2]);
    edited = true;
  }
  hint("through what the view turns about, facing the viewer");
  if (edited) session.put_planes(poses);
}

void edit_cuts(std::vector<CuttingPlane>& cuts, std::size_t first) {
  constexpr float kRows = 8.0F;
  std::optional<std::size_t> gone;
  const bool scrolls = begin_list("cuts", cuts.size() - first, kRows);
  ImGuiListClipper shown;
  shown.Begin(static_cast<int>(cuts.size() - first));
  while (shown.Step()) {
    for (int row = shown.DisplayStart; row < shown.DisplayEnd; ++row) {
      const std::size_t i = first + as_size(row);
      ImGui::PushID(row);
      CuttingPlane& cut = cuts[i];
      checkbox(("plane " + std::to_string(i + 1) + " cuts").c_str(), &cut.on);
      if (ImGui::IsItemHovered()) {
        const Vec3& n = cut.kept.outward;
        ImGui::SetTooltip("away what lies beyond %.4g x + %.4g y + %.4g z = %.6g", n.x, n.y, n.z,
                          cut.kept.offset);
      }
      ImGui::SameLine();
      if (small_button("flip")) cut.kept = {-cut.kept.outward, -cut.kept.offset};
      hint("the other side is cut away");
      ImGui::SameLine();
      if (small_button("remove")) gone = i;
      hint("the cut (Ctrl+Z takes it back)");
      ImGui::PopID();
    }
  }
  if (scrolls) ImGui::EndChild();
  if (gone) cuts.erase(cuts.begin() + static_cast<std::ptrdiff_t>(*gone));
}

void edit_plane_images(VolumeView& volume, const ValueHistogram* histogram) {
  PlaneImages& planes = volume.planes;
  if (checkbox("image", &planes.shown) && planes.shown && !planes.window && histogram != nullptr)
    planes.window = default_window(*histogram);
  hint(
      "the values on each plane; Ctrl and a drag on it: right widens the window, up raises "
      "the level");
  const double lower = volume.image->lowest, upper = volume.image->highest;
  if (planes.shown) edit_window(volume);
  std::optional<std::size_t> gone;
  for (std::size_t i = 0; i < planes.contours.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    slider_scalar("##contour", ImGuiDataType_Double, &planes.contours[i], &lower, &upper, "%.5g");
    explain("contours", false);
    ImGui::SameLine();
    if (small_button("x")) gone = i;
    hint("remove this line");
    ImGui::SameLine();
    ImGui::TextUnformatted("line");
    ImGui::PopID();
  }
  if (gone) planes.contours.erase(planes.contours.begin() + static_cast<std::ptrdiff_t>(*gone));
  if (planes.contours.size() >= kMostContours) return;
  if (small_button("+ line of equal value")) planes.contours.push_back(window_of(volume).level);
  hint("on all planes, at the value of the slider");
}

void edit_notes(ProbeSession& session, VolumeView& volume, bool marking, TouchActions& actions) {
  AnnotationList& notes = session.notes();
  ImGui::Separator();
  const std::string now(name_of(notes.kind()));
  if (begin_combo("annotation", now.c_str())) {
    for (int i = 0; i < kAnnotationKindCount; ++i) {
      const auto kind = static_cast<AnnotationKind>(i);
      const std::string word(name_of(kind));
      if (selectable(word.c_str(), kind == notes.kind())) notes.choose(kind);
    }
    ImGui::EndCombo();
  }
  explain("annotation", false);
  actions.mark = button(marking ? "Stop marking" : "Mark by clicks");
  hint("on a cut, else on the surface between object and background");
  if (points_needed(notes.kind()).most == 0 && !notes.pending().empty()) {
    ImGui::SameLine();
    if (button("Done")) notes.finish();
    hint("the last point was placed");
  }
  std::optional<std::size_t> gone;
  for (std::size_t i = 0; i < notes.entries().size(); ++i) {
    const Annotation& each = notes.entries()[i];
    ImGui::PushID(static_cast<int>(i));
    const std::string word(name_of(each.kind));
    if (each.kind == AnnotationKind::kPoint) {
      const Vec3& x = each.points.front();
      ImGui::Text("point %.5g %.5g %.5g", x.x, x.y, x.z);
    } else {
      ImGui::Text("%s %.5g%s %s", word.c_str(), measure_of(each),
                  each.kind == AnnotationKind::kAngle ? " deg" : "", each.label.c_str());
    }
    offer_plane(each, session, volume.cuts);
    ImGui::SameLine();
    if (small_button("x")) gone = i;
    hint("delete (Ctrl+Z takes it back)");
    ImGui::PopID();
  }
  if (gone) notes.remove(*gone);
  if (notes.entries().empty()) return;
  if (small_button("Save .csv")) actions.save_notes = ".csv";
  hint("all annotations as a table, with what they measure");
  ImGui::SameLine();
  if (small_button("Save .vtp")) actions.save_notes = ".vtp";
  hint("all annotations as points and lines, for ParaView");
}

void edit_grid(TouchChoice& choice, std::string_view mode, const ProbeSession& session,
               std::vector<CuttingPlane>* cuts) {
  if (mode != kGridMode || !session.data().scalar()) return;
  GridAxisSettings& grid = choice.settings.grid_axis;
  if (const std::string note = grid_note(*session.data().scalar(), grid); !note.empty())
    ImGui::TextWrapped("%s", note.c_str());
  edit_setting("grid-pull", grid.threshold, kMillimetres);
  edit_setting("grid-notch", grid.notch, kMillimetres);
  edit_setting("grid-detents", grid.detents);
  edit_setting("grid-peaks", grid.peaks);
  bool marks_alone = grid.switch_at == GridSwitch::kMarks;
  if (checkbox("turn at landmarks alone", &marks_alone))
    grid.switch_at = marks_alone ? GridSwitch::kMarks : GridSwitch::kNodes;
  explain("grid-switch");
  const auto room_for = [&grid](std::size_t marks) {
    return as_size(grid.marks.count) + marks <= std::size_t{GridMarks::kMax};
  };
  const auto add = [&grid](const GridMark& mark) { grid.marks.mark[as_size(grid.marks.count++)] = mark; };
  const LocalFrame& local = session.data().scalar()->frame();
  const Vec3 at = session.readout().proxy;
  // They stay in their places without a hand, so that nothing below moves when it comes.
  ImGui::BeginDisabled(!session.readout().held || !room_for(3));
  if (small_button("landmarks here")) {
    for (const GridMark& mark : marks_at(grid.frame, local, at)) add(mark);
  }
  hint("on the three axes of the grid, where the probe is");
  ImGui::EndDisabled();
  if (cuts != nullptr && !cuts->empty() && room_for(cuts->size())) {
    const bool wanted = small_button("landmarks at cuts");
    hint("a haptic plane in the place of each cut");
    for (const CuttingPlane& cut : wanted ? *cuts : std::vector<CuttingPlane>())
      add({.axis = 3, .normal = cut.kept.outward, .at = cut.kept.offset});
  }
  if (cuts != nullptr) {
    const Mat3 axes = grid_axes(grid.frame, local);
    ImGui::BeginDisabled(!session.readout().held || cuts->size() >= kMostCuts);
    ImGui::TextUnformatted("cut across");
    for (int a = 0; a < 3; ++a) {
      ImGui::SameLine();
      ImGui::PushID(a);
      constexpr std::array<const char*, 3> kNames{"1st", "2nd", "3rd"};
      if (small_button(kNames[as_size(a)])) cuts->push_back({.kept = {axes[a], glm::dot(axes[a], at)}});
      hint("axis of the grid, at the proxy");
      ImGui::PopID();
    }
    ImGui::EndDisabled();
  }
  if (grid.marks.count > 0) {
    ImGui::TextWrapped("%s", text_of(grid.marks).c_str());
    if (small_button("no landmarks")) grid.marks = {};
    hint("takes all of them away");
  }
}

}  // namespace palpate
