#include "apps/dtmri/regions_panel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include <imgui.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/scene/origin_of.h"
#include "common/window/files/saved_files.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

void choose_role(const char* label, RegionRole& role) {
  int chosen = static_cast<int>(role);
  if (combo(label, &chosen, kRegionRoleNames.data(), static_cast<int>(kRegionRoleNames.size())))
    role = static_cast<RegionRole>(chosen);
}

/// @return whether it is another one, or the place is.
bool edit_place(const char* label, Vec3& place) {
  std::array<double, 3> numbers{place.x, place.y, place.z};
  input_numbers(label, numbers.data(), 3, "%.4g");  // three in a row
  if (!ImGui::IsItemDeactivatedAfterEdit()) return false;
  place = {numbers[0], numbers[1], numbers[2]};
  return true;
}

bool edit_length(const char* label, double& length) {
  double edited = length;
  input_numbers(label, &edited, 1, "%.6g");
  if (!ImGui::IsItemDeactivatedAfterEdit() || edited == length) return false;
  length = edited;
  return true;
}

/// The side of a plane that a region takes: that to which the plane's normal points, where that lies along an axis of
/// the data. Another axis lays the plane through the crosshair, the other way along the same one leaves its place.
/// @return whether it changed.
bool choose_side(const std::string& label, const PanelContext& on, HalfSpace& beyond) {
  static const std::vector<std::string> kPatient{"right", "left", "front", "back", "up", "down", "tilted"};
  static const std::vector<std::string> kPlain{"x above", "x below", "y above", "y below",
                                               "z above", "z below", "tilted"};
  const std::vector<std::string>& words = on.view.anatomical ? kPatient : kPlain;
  const auto normal_of = [](std::size_t side) {
    Vec3 normal{0.0};
    normal[static_cast<int>(side / 2)] = side % 2 == 0 ? 1.0 : -1.0;
    return normal;
  };
  std::size_t now = 0;
  while (now < 6 && normal_of(now) != beyond.normal) ++now;
  std::string word = words[now];
  // What is tilted is typed: it can be left, not chosen.
  const bool chosen = choose_word(label.c_str(), word, {words.begin(), words.end() - (now < 6 ? 1 : 0)});
  hint("of the plane, which the region takes; another axis lays the plane through the crosshair");
  const auto side = as_size(std::ranges::find(words, word) - words.begin());
  if (!chosen || side == now || side >= 6) return false;
  const bool around = now < 6 && side / 2 == now / 2;
  beyond.normal = normal_of(side);
  beyond.offset = around ? 0.0 - beyond.offset : glm::dot(beyond.normal, on.view.tensors->position);
  return true;
}

/// @return whether the shape changed.
bool edit_shape(const std::string& number, const PanelContext& on, RegionShape& shape) {
  if (auto* const ball = std::get_if<Sphere>(&shape)) {
    const bool moved = edit_place("centre", ball->center);
    hint("of the ball, data coordinates");
    Sphere sized = *ball;
    const bool resized = edit_length("radius", sized.radius) && sized.radius > 0.0;
    hint("of the ball, in units of the data");
    if (resized) *ball = sized;
    return moved || resized;
  }
  if (auto* const box = std::get_if<Box>(&shape)) {
    Box edited = *box;
    const bool lower = edit_place("from", edited.lower), upper = edit_place("to", edited.upper);
    if (!lower && !upper) return false;
    *box = Box();
    box->include(edited.lower);
    box->include(edited.upper);
    return true;
  }
  if (auto* const beyond = std::get_if<HalfSpace>(&shape)) {
    const bool sided = choose_side("side " + number, on, *beyond);
    Vec3 normal = beyond->normal;
    const bool turned = edit_place("normal", normal) && glm::length(normal) > 0.0;
    hint("of the plane; the region lies on the side to which it points");
    if (turned) beyond->normal = glm::normalize(normal);
    const bool moved = edit_length("offset", beyond->offset);
    hint("of the plane from the origin, along its normal");
    return sided || turned || moved;
  }
  if (auto* const stroke = std::get_if<BrushStroke>(&shape)) {
    ImGui::TextDisabled("painted, %zu balls", stroke->centers.size());
    BrushStroke sized = *stroke;
    const bool resized = edit_length("radius", sized.radius) && sized.radius > 0.0;
    if (resized) *stroke = sized;
    return resized;
  }
  ImGui::TextWrapped("mask %s", std::get<std::string>(shape).c_str());
  return false;
}

const char* name_of(const RegionShape& shape) {
  constexpr std::array<const char*, 5> kNames{"ball", "box", "beyond plane", "painted", "mask"};
  return kNames[shape.index()];
}

/// @return whether some region changed.
bool edit_regions(const PanelContext& on, std::vector<RegionEntry>& regions) {
  bool changed = false;
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    RegionShape shape = parse_region(regions[i].text, regions[i].text + ": no region of tracts");
    const std::string number = std::to_string(i + 1);
    ImGui::Text("%s %s", number.c_str(), name_of(shape));
    ImGui::SameLine();
    if (small_button(("Remove " + number).c_str())) removed = i;
    hint("the region; Ctrl+Z brings it back");
    const RegionRole before = regions[i].role;
    choose_role(("role " + number).c_str(), regions[i].role);
    hint("seed: tracts begin in it; include: they enter it; exclude: they do not; stop: they end there");
    changed |= regions[i].role != before;
    if (edit_shape(number, on, shape)) {
      regions[i].text = region_text(shape);
      changed = true;
    }
    ImGui::PopID();
  }
  if (removed) regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(*removed));
  return changed || removed.has_value();
}

/// Tracts begin in one region: another one takes its place.
void add_region(RegionRole role, const RegionShape& shape, std::vector<RegionEntry>& regions) {
  if (role == RegionRole::kSeed)
    std::erase_if(regions, [](const RegionEntry& one) { return one.role == RegionRole::kSeed; });
  regions.push_back({role, region_text(shape)});
}

/// @return the shape that was asked for, about the crosshair.
std::optional<RegionShape> draw_shapes(const TensorView& tensors) {
  constexpr double kVoxels = 3.0;
  const double reach = kVoxels * tensors.image->shortest_edge();
  const Vec3& x = tensors.position;
  std::optional<RegionShape> shape;
  if (button("Ball")) shape = Sphere{.center = x, .radius = reach};
  hint("about the crosshair, three voxels in radius");
  ImGui::SameLine();
  if (button("Box")) {
    Box box;
    box.include(x - reach);
    box.include(x + reach);
    shape = box;
  }
  hint("about the crosshair, six voxels wide");
  ImGui::SameLine();
  if (button("Beyond plane")) shape = HalfSpace{.normal = {1.0, 0.0, 0.0}, .offset = x.x};
  hint("all that lies to the right of the crosshair (x above); its side can be chosen");
  return shape;
}

void draw_brush(BrushControl& brush, const TensorVoxels& voxels) {
  constexpr double kLeast = 0.5, kMost = 10.0, kUsual = 1.5;  // voxels
  const double edge = voxels.shortest_edge();
  if (brush.radius < kLeast * edge || brush.radius > kMost * edge) brush.radius = kUsual * edge;
  checkbox("brush", &brush.on);
  hint("a left drag over a slice paints a region there; slices are shown by S");
  slider("brush radius", brush.radius, kLeast * edge, kMost * edge, "%.3g");
  hint("in units of the data");
}

/// Writes them as their file says, under the next free name. @throws Error.
std::string save_regions(const RegionsPanel& panel, const PanelContext& on) {
  const TensorVoxels& voxels = *on.view.tensors->image;
  const std::filesystem::path asked(panel.file);
  std::string ending = asked.extension().string(), stem = asked.stem().string();
  if (const std::filesystem::path inner(stem); ending == ".gz") {
    ending = inner.extension().string() + ending;
    stem = inner.stem().string();
  }
  const std::filesystem::path file = free_place(asked.parent_path(), stem, ending);
  ImageOrigin origin;
  origin.space = on.view.anatomical ? ImageSpace::kPatient : ImageSpace::kUnknown;
  const auto notes =
      write_regions(file, on.state.document.tracts, on.state.document.input.tensor.handedness == "left",
                    {voxels.points, voxels.origin, voxels.axes}, origin, false);
  std::string said = "saved " + file.string();
  for (const std::string& note : notes) said += "; " + note;
  return said;
}

}  // namespace

void draw_regions(RegionsPanel& panel, PanelContext& on) {
  const TensorView& tensors = *on.view.tensors;
  TractTracingOptions& options = on.state.document.tracts;
  std::vector<RegionEntry> regions = regions_of(options);
  bool changed = false;
  BrushControl* const brush = on.state.brush;
  if (brush != nullptr) {
    on.view.regions = on.scene.regions;
    if (!brush->stroke().empty() && brush->painting())
      on.view.regions.push_back(
          region_view(panel.role, BrushStroke{.radius = brush->radius, .centers = brush->stroke()}));
    if (std::vector<Vec3> stroke = brush->take_stroke(); !stroke.empty()) {
      add_region(panel.role, BrushStroke{.radius = brush->radius, .centers = std::move(stroke)}, regions);
      changed = true;
    }
  }
  if (section("REGIONS")) {
    choose_role("new region", panel.role);
    hint("seed: tracts begin in it; include: they enter it; exclude: they do not; stop: they end there");
    if (const auto shape = draw_shapes(tensors)) {
      add_region(panel.role, *shape, regions);
      changed = true;
    }
    if (brush != nullptr) draw_brush(*brush, *tensors.image);
    changed |= edit_regions(on, regions);
    if (!regions.empty()) {
      input_text("regions file", &panel.file);
      hint(".csv: a row each; .nii.gz, .nrrd: an image with the sum of 1 seed, 2 include, 4 exclude, 8 stop");
      if (button("Save regions")) {
        try {
          on.state.say(save_regions(panel, on));
        } catch (const Error& error) {
          on.state.fail(error.what());
        }
      }
      hint("to that file, in place of what stands there");
    }
  }
  if (changed) set_regions(regions, options);
}

}  // namespace palpate
