#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <imgui.h>

#include "apps/dtmri/bundle_panel.h"
#include "apps/dtmri/dtmri_model.h"
#include "apps/dtmri/region_text.h"
#include "apps/dtmri/regions_panel.h"
#include "apps/dtmri/slice_images.h"
#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/panes_panel.h"
#include "common/window/panels/time_panel.h"
#include "common/window/panels/volume/lens_panel.h"
#include "common/window/panels/volume/region_transfer_editor.h"
#include "common/window/panels/volume/volume_panel.h"

namespace palpate {
namespace {

/// The words of a setting of tracts, whose name other settings of the program have as well.
void edit_word(const char* setting_name, const char* label, std::string& word) {
  const Setting* const row = find_setting(setting_name, FieldKind::kTensor);
  std::vector<std::string> words;
  for (const std::string_view one : row->word_list()) words.emplace_back(one);
  choose_word(label, word, words);
  explain(*row);
}

/// A text that counts when its field is left: each one is read and fitted anew.
struct TypedText {
  std::string text;
  bool typing = false;
};
struct ReadingTexts {
  TypedText mask, leave_out;
};

void edit_text(const char* label, const char* setting_name, TypedText& typed, std::string& text) {
  if (!typed.typing) typed.text = text;
  input_text(label, &typed.text);
  if (ImGui::IsItemDeactivatedAfterEdit()) text = typed.text;
  typed.typing = ImGui::IsItemActive();
  explain(*find_setting(setting_name, FieldKind::kTensor));
}

/// Along which axes directions are, and which volumes and voxels are fitted: a change reads the image again.
void draw_reading(ReadingTexts& texts, TensorSpec& reading) {
  const bool plain = reading == TensorSpec{};
  if (!section("AXES AND FIT", plain, {"vectors", "flip", "permute", "mask", "leave-out"})) return;
  edit_word("vectors", "axes of directions", reading.vectors);
  const auto choose_turn = [](const char* label, const char* name, std::string& turn,
                              const std::vector<std::string>& words) {
    std::string word = turn.empty() ? "none" : turn;
    if (choose_word(label, word, words)) turn = word == "none" ? std::string() : word;
    explain(*find_setting(name, FieldKind::kTensor));
  };
  choose_turn("flip axes", "flip", reading.flip, {"none", "i", "j", "k", "ij", "ik", "jk", "ijk"});
  choose_turn("permute axes", "permute", reading.permute, {"none", "ikj", "jik", "jki", "kij", "kji"});
  edit_text("mask of the fit", "mask", texts.mask, reading.mask);
  edit_text("leave out volumes", "leave-out", texts.leave_out, reading.leave_out);
}

/// Where tracts start, as the panel edits it.
struct TractSeedChoice {
  bool at_crosshair = true;      ///< in a ball about it; else wherever FA is above `least_fa`
  std::optional<double> radius;  ///< of the ball [data units]; none: three voxels
  double least_fa = 0.4;
  bool every_peak = false;  ///< of images with several directions a voxel
};

// A drop-down of an enumeration with `count` members.
template <typename Enum>
void choose(const char* label, Enum& chosen, int count) {
  if (!begin_combo(label, std::string(name_of(chosen)).c_str())) return;
  for (int i = 0; i < count; ++i) {
    const auto member = static_cast<Enum>(i);
    if (selectable(std::string(name_of(member)).c_str(), member == chosen)) chosen = member;
  }
  ImGui::EndCombo();
}

// Where the slice across axis 0, 1 or 2 of the data lies, voxel by voxel.
void draw_slice(TensorView& view, std::size_t axis, const char* name) {
  const TensorVoxels& voxels = *view.image;
  const int own = slice_axes(voxels.axes)[axis];
  ImGui::PushID(static_cast<int>(axis));
  checkbox("##shown", &view.slices[static_cast<std::size_t>(own)]);
  explain("slices", false);
  ImGui::SameLine();
  const int last = voxels.points[own] - 1;
  // Sliders rise with the data's coordinate, whichever way the voxels are counted.
  const bool forwards = voxels.axes[own][static_cast<int>(axis)] > 0.0;
  const int now = static_cast<int>(std::lround(voxels.grid_coordinates(view.position)[own]));
  int place = forwards ? now : last - now;
  const std::string text = short_number(std::round(10.0 * view.position[static_cast<int>(axis)]) / 10.0);
  const bool moved = slider_int(name, &place, 0, last, text.c_str(), ImGuiSliderFlags_AlwaysClamp);
  hint("where the slice lies, by the data's coordinate; what is typed is the voxel, from 0");
  if (moved) {
    const int wanted = forwards ? place : last - place;
    view.position = moved_position(voxels, view.position, own, wanted - now);
  }
  ImGui::PopID();
}

void draw_tensor_panel(TensorView& view, bool anatomical) {
  static constexpr std::array<const char*, 3> kPatient{"sagittal", "coronal", "axial"};
  static constexpr std::array<const char*, 3> kPlain{"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) draw_slice(view, axis, (anatomical ? kPatient : kPlain)[axis]);
  edit_setting("crosshair", view.crosshair);
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  checkbox("smooth", &view.smooth);
  explain("voxels", false);
  if (!view.image->field) return;  // a lattice alone
  choose("colour", view.color, kTensorColorCount);
  hint("of the voxels of a slice: the direction of the fastest diffusion, or a measure");
  edit_setting("glyphs", view.glyphs);
  if (view.glyphs == GlyphShape::kNone) return;
  edit_setting("glyph-fa", view.glyph_least_fa);
  edit_setting("glyph-spacing", view.glyph_spacing);
}

bool draw_underlay_panel(TensorView& view, const std::string& file) {
  if (!view.underlay) {
    ImGui::TextDisabled("none: drop an image on the window");
    return false;
  }
  UnderlayView& underlay = *view.underlay;
  ImGui::TextWrapped("%s", std::filesystem::path(file).filename().string().c_str());
  const double span = underlay.image->highest - underlay.image->lowest;
  if (span > 0.0) {
    constexpr double kNarrowest = 1e-3, kWidest = 2.0;  // of the values
    const double narrow = kNarrowest * span, wide = kWidest * span;
    slider_scalar("window", ImGuiDataType_Double, &underlay.window.width, &narrow, &wide, "%.4g",
                  ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    explain("window", false);
    slider_scalar("level", ImGuiDataType_Double, &underlay.window.level, &underlay.image->lowest,
                  &underlay.image->highest, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    explain("level", false);
  }
  if (!view.image->field) return false;  // there is nothing to blend with, and no slice without it
  edit_setting("blend", underlay.blend);
  const bool removed = button("Remove underlay");
  hint("the image below the slices; its file stays");
  return removed;
}

double radius_of(const TractSeedChoice& choice, const TensorVoxels& voxels) {
  constexpr double kVoxels = 3.0;
  return choice.radius.value_or(kVoxels * voxels.shortest_edge());
}

/// `choice` as --seeds says it.
std::string tract_seed_text(const TractSeedChoice& choice, const TensorView& tensors) {
  const Vec3& x = tensors.position;
  const std::string places = choice.at_crosshair ? "sphere:" + short_number(x.x) + "," + short_number(x.y) +
                                                       "," + short_number(x.z) + "," +
                                                       short_number(radius_of(choice, *tensors.image))
                                                 : "fa:" + short_number(choice.least_fa);
  return seeds_text(places, choice.every_peak);
}

void draw_tract_appearance(TractView& appearance) {
  edit_setting("tract-width", appearance.width);
  edit_setting("tract-opacity", appearance.opacity);
}

/// A length that may stand for a choice by the program, which zero does.
void edit_length(const char* setting_name, double& value, double most) {
  slider(label_of(setting(setting_name)).c_str(), value, 0.0, most, value > 0.0 ? "%.4g" : "auto");
  explain(setting_name);
}

/// Tracts that are shown are traced again with these, in the background.
void edit_tracing(TractTracingOptions& tracts, const TensorView& tensors) {
  constexpr double kVoxels = 4.0;
  const double edge = tensors.image->shortest_edge(), diagonal = tensors.image->bounds().diagonal();
  edit_setting("seeds-per-voxel", tracts.seeds_per_voxel);
  edit_word("measure", "cutoff measure", tracts.measure);
  edit_setting("cutoff", tracts.cutoff);
  slider("max angle", tracts.max_angle, 0.0, 90.0, tracts.max_angle > 0.0 ? "%.3g" : "by radius");
  explain("max-angle");
  edit_length("min-radius", tracts.min_radius, kVoxels * edge);
  if (tensors.image->field && tracts.max_cone) {
    slider("max cone", *tracts.max_cone, 0.1, 90.0, "%.3g");
    explain("max-cone");
  }
  bool by_cone = tracts.max_cone.has_value();
  if (checkbox("end where directions are unsure", &by_cone)) {
    constexpr double kUsual = 20.0;
    tracts.max_cone = by_cone ? std::optional(kUsual) : std::nullopt;
  }
  explain("max-cone", false);
  edit_length("min-length", tracts.min_length, diagonal);
  edit_length("max-length", tracts.max_length, 2.0 * diagonal);
  edit_setting("direction", tracts.direction);
  edit_word("integrator", "steps", tracts.integrator);
  if (tracts.integrator == "dp54") {
    constexpr int kFine = -8, kCoarse = -1;  // decades
    (void)decade_slider("tolerance", tracts.tolerance, kFine, kCoarse);
    explain("tolerance");
  }
  edit_length("step", tracts.step, kVoxels * edge);
  auto steps = static_cast<int>(std::min<std::int64_t>(tracts.max_steps, 1'000'000));
  if (slider_int("max steps", &steps, 1, 1'000'000, "%d", ImGuiSliderFlags_Logarithmic))
    tracts.max_steps = steps;
  explain("max-steps");
}

void draw_tract_panel(TractSeedChoice& choice, Document& document, const TensorView& tensors,
                      std::optional<TractView>& appearance) {
  constexpr std::array<const char*, 2> kWhere{"a ball at the crosshair", "all of high FA"};
  int where = choice.at_crosshair ? 0 : 1;
  if (combo("start in", &where, kWhere.data(), static_cast<int>(kWhere.size())))
    choice.at_crosshair = where == 0;
  hint("where tracts begin; Trace takes it");
  if (choice.at_crosshair) {
    constexpr double kLeast = 0.5, kMost = 30.0;  // voxels
    const double edge = tensors.image->shortest_edge();
    double radius = radius_of(choice, *tensors.image);
    const bool resized =
        slider("radius", radius, kLeast * edge, kMost * edge, "%.3g", ImGuiSliderFlags_Logarithmic);
    hint("of the ball, in units of the data");
    if (resized) choice.radius = radius;
  } else {
    slider("FA above", choice.least_fa, 0.0, 1.0, "%.2f");
    hint("fractional anisotropy of the voxels at which tracts begin");
  }
  if (tensors.image->field && tensors.image->field->peaks() != nullptr) {
    std::string& seeds = document.tracts.seeds;
    if (!seeds.empty()) choice.every_peak = from_every_peak(seeds);
    if (checkbox("from every peak", &choice.every_peak) && !seeds.empty())
      seeds = seeds_text(seed_places(seeds), choice.every_peak);
    hint("of a seed's voxel; else from the longest. Tracts go on along the peak nearest to their way");
  }
  edit_tracing(document.tracts, tensors);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{0.5F * (ImGui::GetContentRegionAvail().x - gap), 0.0F};
  const bool traces = button("Trace", size);
  hint("tracts from there, in place of those that are shown");
  if (traces) {
    document.tracts.seeds = tract_seed_text(choice, tensors);
    document.tract_appearance.file.clear();
  }
  ImGui::SameLine();
  const bool removes = button("Remove", size);
  hint("the tracts that are shown");
  if (removes) {
    document.tracts.seeds.clear();
    document.tract_appearance.file.clear();
  }
  // Always there, so that nothing below moves when tracts come and go.
  TractView none;
  ImGui::BeginDisabled(!appearance);
  draw_tract_appearance(appearance ? *appearance : none);
  ImGui::EndDisabled();
}

/// Which tracts are drawn over slices, and with one slice of the scene.
void draw_tract_slab(TractView& look, const TensorVoxels& voxels) {
  constexpr double kUsual = 2.0;  // voxels, where none is said
  double thickness = look.slab_thickness.value_or(kUsual * voxels.shortest_edge());
  if (slider("slab of tracts", thickness, 0.0, voxels.bounds().diagonal(), "%.3g",
             ImGuiSliderFlags_Logarithmic))
    look.slab_thickness = thickness;
  explain("tract-slab", false);
}

/// Which lengths are drawn, of all tracts.
struct ShownLengths {
  LengthFilter filter;
  double least = 0.0;
  std::optional<double> most;  ///< none: the longest
};

void draw_lengths(ShownLengths& lengths, const TractView& all, TractView& shown) {
  (void)lengths.filter.of(all.bundle, 0.0, HUGE_VAL);
  const double longest = std::max(lengths.filter.longest(), 1e-6);
  double most = std::min(lengths.most.value_or(longest), longest);
  slider("shown from", lengths.least, 0.0, longest, "%.4g");
  hint(
      "shorter tracts are hidden, in the scene and over slices; nothing is deleted, and a session shows all of them");
  if (slider("shown to", most, 0.0, longest, "%.4g")) lengths.most = most;
  hint(
      "longer tracts are hidden, in the scene and over slices; nothing is deleted, and a session shows all of them");
  shown.bundle = lengths.filter.of(all.bundle, lengths.least, lengths.most.value_or(HUGE_VAL));
  if (shown.bundle != all.bundle)
    ImGui::TextDisabled("%zu of %zu tracts are shown", shown.bundle->order.size(), all.bundle->order.size());
}

/// How sure the fit is of the direction at the hand.
void draw_cone(const PanelState& state, const SceneView& view) {
  if (state.touch == nullptr || !state.touch->readout().held || !view.volume) return;
  const SliceImage* const cones = find_slice_image(view.volume->slice_images, "cone");
  if (cones == nullptr) return;
  const double degrees = cones->image->value_at(state.touch->readout().proxy);
  ReadoutRows rows("cone");
  rows.add("95 % cone", std::isfinite(degrees) ? "%.1f degrees" : "not known here", degrees);
  rows.finish();
}

void draw_tensors(PanelState& state, const SceneState& scene, TractSeedChoice& choice, SceneView& view) {
  TensorView& tensors = *view.tensors;
  std::optional<TractView>& tracts = view.tracts;
  const bool field = tensors.image->field != nullptr;
  if (section(field ? "TENSORS" : "SLICES")) {
    if (field) {
      choose_word("field", state.document.input.field, scene.info->fields);
      explain("field", false);
      draw_time(state, scene.info->times);
      draw_cone(state, view);
    }
    draw_tensor_panel(tensors, scene.info->anatomical);
  }
  if (section("UNDERLAY") && draw_underlay_panel(tensors, state.document.tensors.underlay))
    state.document.tensors.underlay.clear();
  if (!section("TRACTS")) return;
  if (field) {
    draw_tract_panel(choice, state.document, tensors, tracts);
  } else if (tracts) {
    draw_tract_appearance(*tracts);
  }
}

void draw_anisotropy(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions) {
  if (!section("ANISOTROPY AS A VOLUME")) return;
  checkbox("volume", &volume.shown);
  hint("of anisotropy around the lenses (V)");
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  checkbox("in colour", &volume.colored);
  hint("by the direction of the fastest diffusion");
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  constexpr ValueSpan kAnisotropies{0.0, 1.0};
  if (volume.regions) {
    (void)draw_region_editor("anisotropy", state.histogram.places_of(volume.image), *volume.regions);
  } else {
    (void)draw_transfer_editor("anisotropy", kAnisotropies, histogram, volume.transfer);
  }
  draw_rays(volume);
  actions.lens = draw_lens_panel(volume, scene.appearances, "FA", scene.info->bounds, state.histogram);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  ImGui::TextDisabled("inside lenses");
  const bool changed =
      focus.regions ? draw_region_editor("focus", state.histogram.places_of(volume.image), *focus.regions)
                    : draw_transfer_editor("focus", kAnisotropies, histogram, focus.colors);
  if (changed) set_focus(volume, focus);
}

}  // namespace

std::vector<PanelPart> dtmri_panels() {
  return {[choice = TractSeedChoice(), regions = RegionsPanel(), bundles = BundlePanel(),
           texts = ReadingTexts(), lengths = ShownLengths()](PanelContext& on) mutable {
    if (on.scene.tensors && on.view.tensors) {
      draw_tensors(on.state, on.scene, choice, on.view);
      if (on.view.tensors->image->field) draw_reading(texts, on.state.document.input.tensor);
      if (on.view.volume) edit_panes(*on.view.volume, nullptr, on.view.anatomical);
      if (on.view.tracts) draw_tract_slab(*on.view.tracts, *on.view.tensors->image);
      if (on.view.tracts && on.scene.tracts) draw_lengths(lengths, *on.scene.tracts, *on.view.tracts);
      if (on.view.volume) draw_anisotropy(on.state, on.scene, *on.view.volume, on.actions);
      const bool lines = on.view.tracts || !on.state.document.tract_appearance.bundles.empty();
      if (on.view.tensors->image->field || lines) {
        draw_regions(regions, on);
        draw_bundles(bundles, on);
      }
    } else if (on.view.tracts) {
      if (section("TRACTS")) draw_tract_appearance(*on.view.tracts);
    }
  }};
}

}  // namespace palpate
