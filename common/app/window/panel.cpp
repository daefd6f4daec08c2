#include "common/app/window/panel.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "common/app/window/lens_panel.h"
#include "common/app/window/panel_parts.h"
#include "common/app/window/picture_panels.h"
#include "common/app/window/plane_panel.h"
#include "common/app/window/readout_rows.h"
#include "common/app/window/region_transfer_editor.h"
#include "common/app/window/tensor_panel.h"
#include "common/base/text.h"

namespace palpate {
namespace {

void section(const char* name) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", name);
  ImGui::Separator();
}

// A drop-down of words; true when another one was chosen.
bool choose(const char* label, std::string& chosen, const std::vector<std::string>& words) {
  bool changed = false;
  if (ImGui::BeginCombo(label, chosen.c_str())) {
    for (const std::string& word : words) {
      if (ImGui::Selectable(word.c_str(), word == chosen) && word != chosen) {
        chosen = word;
        changed = true;
      }
    }
    ImGui::EndCombo();
  }
  return changed;
}

// A slider over whole decades; a value between them stays until the slider is moved.
bool decade_slider(const char* label, double& value, int lower, int upper) {
  int decade = static_cast<int>(std::lround(std::log10(value)));
  if (!ImGui::SliderInt(label, &decade, lower, upper, short_number(value).c_str(),
                        ImGuiSliderFlags_AlwaysClamp)) {
    return false;
  }
  value = std::pow(10.0, decade);
  return true;
}

std::string name_of(const InputFiles& input) {
  std::string name;
  for (const auto& file : input.files) name += (name.empty() ? "" : " ") + file.filename().string();
  return input.solution ? name + " " + input.solution->filename().string() : name;
}

// What was open before; the line above says what is open now.
void draw_recent(const PanelState& state, PanelActions& actions) {
  const InputFiles& now = state.scene->info->files;
  const auto other = [&](const InputFiles& input) { return !(input == now); };
  if (std::none_of(state.recent.begin(), state.recent.end(), other)) return;
  if (!ImGui::BeginCombo("##recent", "open recent")) return;
  for (const InputFiles& input : state.recent) {
    if (!other(input)) continue;
    ImGui::PushID(&input);
    if (ImGui::Selectable(name_of(input).c_str())) actions.open = input;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", input.files.front().string().c_str());
    ImGui::PopID();
  }
  ImGui::EndCombo();
}

void draw_input(const SceneState& scene) {
  section("INPUT");
  ImGui::TextWrapped("%s", scene.info->name.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  for (const std::string& fact : scene.info->facts) ImGui::TextWrapped("%s", fact.c_str());
  ImGui::PopStyleColor();
}

void draw_time(PanelState& state, const std::vector<double>& times) {
  if (times.size() < 2) return;
  int step = static_cast<int>(state.settings.time_step);
  const int last = static_cast<int>(times.size()) - 1;
  const std::string text = "t = " + short_number(times[state.settings.time_step]);
  if (ImGui::SliderInt("time step", &step, 0, last, text.c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    state.settings.time_step = static_cast<std::size_t>(step);
  }
  if (ImGui::SmallButton(state.playing ? "Stop###play" : "Play###play")) state.playing = !state.playing;
  ImGui::SameLine();
  constexpr double kSlowest = 0.2, kFastest = 60.0;
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetCursorPosX() +
                          ImGui::GetStyle().WindowPadding.x);
  (void)slider("steps a second", state.play_rate, kSlowest, kFastest, "%.1f", ImGuiSliderFlags_Logarithmic);
}

/// Which scalar is plotted over time at the probe.
void choose_plotted(PanelState& state, const SceneInfo& info) {
  if (info.plotted.empty()) return;
  const char* kNothing = "nothing";
  if (ImGui::BeginCombo("plot at the probe", state.plotted.empty() ? kNothing : state.plotted.c_str())) {
    if (ImGui::Selectable(kNothing, state.plotted.empty())) state.plotted.clear();
    for (const std::string& name : info.plotted)
      if (ImGui::Selectable(name.c_str(), name == state.plotted)) state.plotted = name;
    ImGui::EndCombo();
  }
  if (state.plotted.empty()) return;
  ImGui::Checkbox("keep all steps in memory", &state.keep_steps);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("read once, then the curve follows the hand at once; else step by step");
}

/// @param speed whether the field has one.
void draw_seeds(PanelState& state, bool speed) {
  static const std::vector<std::string> kKinds{"grid", "random", "speed", "other"};
  static const std::vector<std::string> kWithoutSpeed{"grid", "random", "other"};
  std::string kind = kKinds[static_cast<std::size_t>(state.seeds.kind)];
  if (choose("seeds", kind, speed ? kKinds : kWithoutSpeed)) {
    // `other` starts from the text of what was chosen before.
    state.seeds.text = seeds_text(state.seeds);
    state.seeds.kind =
        static_cast<SeedChoice::Kind>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
  }
  constexpr int kMost = 1'000'000, kMostAcross = 200;
  switch (state.seeds.kind) {
    case SeedChoice::Kind::kGrid:
      ImGui::DragInt3("along x y z", state.seeds.grid.data(), 0.1F, 1, kMostAcross, "%d",
                      ImGuiSliderFlags_AlwaysClamp);
      break;
    case SeedChoice::Kind::kRandom:
    case SeedChoice::Kind::kSpeed:
      ImGui::DragInt("number", &state.seeds.count, 2.0F, 1, kMost, "%d",
                     ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
      break;
    case SeedChoice::Kind::kText:
      // Half a word is no seeds: taken when it is complete.
      ImGui::InputText("as --seeds", &state.seeds.text);
      if (ImGui::IsItemActive()) return;
      break;
  }
  state.settings.seeds = seeds_text(state.seeds);
}

void draw_lines(PanelState& state, const SceneState& scene) {
  section("LINES");
  SceneSettings& settings = state.settings;
  const SceneInfo& info = *scene.info;
  choose("field", settings.field, info.fields);
  draw_time(state, info.times);
  draw_seeds(state, true);
  static const std::vector<std::string> kDirections{"forward", "backward", "both"};
  choose("direction", settings.direction, kDirections);
  choose("integrator", settings.integrator, info.integrators);
  const double diagonal = info.bounds.diagonal();
  constexpr double kDefaultStep = 1e-3, kDefaultLength = 10.0;  // diagonals
  if (settings.integrator == "euler" || settings.integrator == "rk4") {
    constexpr int kFinest = -6, kCoarsest = -1;
    double step = diagonal > 0.0 && settings.step > 0.0 ? settings.step / diagonal : kDefaultStep;
    if (decade_slider("step / diagonal", step, kFinest, kCoarsest)) settings.step = step * diagonal;
  } else {
    constexpr int kTightest = -12, kLoosest = -2;
    decade_slider("tolerance", settings.tolerance, kTightest, kLoosest);
  }
  if (diagonal > 0.0) {
    constexpr double kShortest = 0.01, kLongest = 100.0;
    double length = settings.max_length > 0.0 ? settings.max_length / diagonal : kDefaultLength;
    if (ImGui::SliderScalar("max length", ImGuiDataType_Double, &length, &kShortest, &kLongest,
                            "%.2f diagonals", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
      settings.max_length = length * diagonal;
    }
  }
}

/// Of a heart: which layer is shown, and where its fibres start.
void draw_layer(PanelState& state, const SceneState& scene) {
  section("LAYER");
  SceneSettings& settings = state.settings;
  const SceneInfo& info = *scene.info;
  choose("field", settings.field, info.fields);
  draw_time(state, info.times);
  (void)slider("depth", settings.layer, info.layers->lower, info.layers->upper, "%.2f");
  draw_seeds(state, false);
  choose_plotted(state, info);
  double spacing = settings.contours;
  if (ImGui::InputDouble("contour spacing", &spacing, 0.0, 0.0, "%.4g",
                         ImGuiInputTextFlags_EnterReturnsTrue) &&
      std::isfinite(spacing)) {
    settings.contours = std::max(spacing, 0.0);
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("lines where what colours the layer is a multiple of this: isochrones; 0: none");
  const char* kNothing = "nothing";
  if (ImGui::BeginCombo("inside lens (L)",
                        settings.lens_array.empty() ? kNothing : settings.lens_array.c_str())) {
    if (ImGui::Selectable(kNothing, settings.lens_array.empty())) settings.lens_array.clear();
    for (const std::string& name : info.color_arrays)
      if (ImGui::Selectable(name.c_str(), name == settings.lens_array)) settings.lens_array = name;
    ImGui::EndCombo();
  }
}

void draw_color(PanelState& state, const SceneState& scene, SceneView& view) {
  section("COLOUR");
  LineStyle& style = view.style;
  std::string& array = state.settings.color_array;
  const std::string now = array.empty() ? std::string(name_of(style.color_by)) : array;
  if (ImGui::BeginCombo("by", now.c_str())) {
    const auto list_quantities = [&] {
      for (int i = 0; i < kColorByCount; ++i) {
        const auto by = static_cast<ColorBy>(i);
        if (by == ColorBy::kArray) continue;
        if (ImGui::Selectable(std::string(name_of(by)).c_str(), array.empty() && by == style.color_by)) {
          style.color_by = by;
          style.range.reset();
          style.logarithmic.reset();
          array.clear();
        }
      }
    };
    // These have to be sampled first: the colours follow when that is done.
    const auto list_arrays = [&] {
      for (const std::string& name : scene.info->color_arrays) {
        if (ImGui::Selectable(name.c_str(), name == array)) array = name;
      }
    };
    // A heart is looked at for what its muscle does, a flow for its lines.
    if (scene.info->layers) {
      list_arrays();
      ImGui::Separator();
      list_quantities();
    } else {
      list_quantities();
      list_arrays();
    }
    ImGui::EndCombo();
  }
  const bool mapped = style.color_by != ColorBy::kDirection && style.color_by != ColorBy::kTermination &&
                      style.color_by != ColorBy::kUniform;
  if (!mapped) return;
  const ColorMap map = color_map_of(style);
  if (ImGui::BeginCombo("map", std::string(name_of(map)).c_str())) {
    for (const ColorMap choice : {ColorMap::kSequential, ColorMap::kHeat, ColorMap::kDiverging}) {
      if (ImGui::Selectable(std::string(name_of(choice)).c_str(), choice == map)) style.color_map = choice;
    }
    ImGui::EndCombo();
  }
  bool automatic = !style.range.has_value();
  if (ImGui::Checkbox("automatic range", &automatic)) {
    style.range =
        automatic ? std::nullopt : std::optional(state.picture.automatic_range.value_or(ValueRange{}));
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("of the usual values; of a scalar that changes in time the same at all its steps");
  if (style.range) {
    ValueRange range = *style.range;
    std::array<double, 2> ends{range.lower, range.upper};
    if (ImGui::InputScalarN("range", ImGuiDataType_Double, ends.data(), 2, nullptr, nullptr, "%.4g") &&
        ends[0] < ends[1]) {
      style.range = ValueRange{ends[0], ends[1]};
    }
  }
  if (style.color_by != ColorBy::kSeed) {
    bool logarithmic = is_logarithmic(style);
    if (ImGui::Checkbox("logarithmic", &logarithmic)) style.logarithmic = logarithmic;
  }
}

void draw_rays(VolumeView& volume) {
  constexpr double kFewest = 0.5, kMost = 16.0;
  ImGui::SliderScalar("samples a voxel", ImGuiDataType_Double, &volume.samples_per_voxel, &kFewest, &kMost,
                      "%.1f", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  constexpr double kEven = 1.0, kFarthest = 8.0;
  ImGui::SliderScalar("fewer far off", ImGuiDataType_Double, &volume.far_sampling, &kEven, &kFarthest, "%.0f",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  ImGui::Checkbox("shading", &volume.shading);
}

/// Whether a lens shows what the editor of all lenses edits.
bool shows_shared(const Lens& lens) { return !lens.cut && !lens.own_transfer && lens.field == 0; }

/// What such lenses show; that of new ones where there are none.
EditedTransfer focus_of(const VolumeView& volume, const SceneState& scene) {
  const auto of = [](const Lens& lens) {
    return EditedTransfer{lens.transfer.value_or(ColorTransfer()), lens.regions};
  };
  for (const Lens& lens : volume.lenses) {
    if (shows_shared(lens) && (lens.transfer || lens.regions)) return of(lens);
  }
  return of(scene.look(0));
}

void set_focus(VolumeView& volume, const EditedTransfer& focus) {
  for (Lens& lens : volume.lenses) {
    if (!shows_shared(lens)) continue;
    lens.transfer = focus.colors;
    lens.regions = focus.regions;
  }
}

/// Which other scalars are there for lenses.
void choose_beside(SceneSettings& settings, const SceneInfo& info) {
  std::vector<std::string>& beside = settings.beside;
  if (info.fields.size() < 2 && beside.empty()) return;
  if (!ImGui::BeginCombo("fields for lenses",
                         beside.empty() ? "none" : counted(beside.size(), "field").c_str()))
    return;
  std::vector<std::string> names = info.fields;
  for (const std::string& name : beside) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);  // of other files
  }
  for (const std::string& name : names) {
    if (name == settings.field) continue;
    const auto there = std::find(beside.begin(), beside.end(), name);
    if (!ImGui::Selectable(name.c_str(), there != beside.end(), ImGuiSelectableFlags_DontClosePopups))
      continue;
    if (there != beside.end()) {
      beside.erase(there);
      break;
    }
    if (beside.size() + 1 < kMostFields) beside.push_back(name);
  }
  ImGui::EndCombo();
}

/// Of the volume that is shown, which is what grid's hand feels.
std::optional<double> value_at_probe(const PanelState& state) {
  if (state.touch == nullptr || !state.touch->readout().held) return std::nullopt;
  return state.touch->readout().scalar;
}

/// All scalars of the scene where the probe is.
void draw_values_at_probe(const PanelState& state, const VolumeView& volume) {
  if (volume.fields.empty() || state.touch == nullptr || !state.touch->readout().held) return;
  const Vec3 place = state.touch->readout().proxy;
  ReadoutRows rows("values");
  rows.add(state.settings.field.c_str(), "%s", short_number(volume.image->value_at(place)).c_str());
  for (const VolumeField& field : volume.fields)
    rows.add(field.name.c_str(), "%s", short_number(field.image->value_at(place)).c_str());
  rows.finish();
}

void draw_volume(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions) {
  section("VOLUME");
  choose("field", state.settings.field, scene.info->fields);
  draw_values_at_probe(state, volume);
  draw_time(state, scene.info->times);
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  EditedTransfer colors{volume.transfer, volume.regions};
  actions.save_transfer |=
      choose_transfer("colours", "from the histogram", state.settings.transfer, colors, volume.image,
                      state.histogram, state.transfer_file, value_at_probe(state));
  volume.transfer = std::move(colors.colors);
  volume.regions = std::move(colors.regions);
  draw_rays(volume);
  const bool has_planes = state.touch != nullptr && state.touch->planes();
  const auto of_hand = has_planes ? static_cast<std::size_t>(state.touch->planes()->poses.count) : 0;
  if (of_hand < volume.cuts.size()) {
    section("CUTS");
    edit_cuts(volume.cuts, of_hand);
  }
  if (!volume.cuts.empty()) {
    section("ON PLANES");
    edit_plane_images(volume, histogram);
  }
  if (state.region != nullptr) {
    section("REGION");
    actions.region = edit_region(*state.region, *volume.image);
  }
  section("LENSES");
  actions.lens =
      draw_lens_panel(volume, scene.looks, state.settings.field, scene.info->bounds, state.histogram);
  choose_beside(state.settings, *scene.info);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  const EditedTransfer before = focus;
  actions.save_focus |= choose_transfer("inside", "denser half", state.settings.focus, focus, volume.image,
                                        state.histogram, state.focus_file);
  if (!(focus == before)) set_focus(volume, focus);
}

void draw_tensors(PanelState& state, const SceneState& scene, TensorView& tensors,
                  std::optional<TractView>& tracts) {
  const bool field = tensors.image->field != nullptr;
  section(field ? "TENSORS" : "SLICES");
  if (field) {
    choose("field", state.settings.field, scene.info->fields);
    draw_time(state, scene.info->times);
  }
  draw_tensor_panel(tensors, scene.info->anatomical);
  section("UNDERLAY");
  if (draw_underlay_panel(tensors, state.settings.underlay)) state.settings.underlay.clear();
  section("TRACTS");
  if (field) {
    draw_tract_panel(state.tract_seeds, state.settings, tensors, tracts);
  } else if (tracts) {
    draw_tract_look(*tracts);
  }
}

void draw_anisotropy(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions) {
  section("ANISOTROPY AS A VOLUME");
  ImGui::Checkbox("volume", &volume.shown);
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  ImGui::Checkbox("in colour", &volume.colored);
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  constexpr ValueSpan kAnisotropies{0.0, 1.0};
  if (volume.regions) {
    (void)draw_region_editor("anisotropy", state.histogram.places_of(volume.image), *volume.regions);
  } else {
    (void)draw_transfer_editor("anisotropy", kAnisotropies, histogram, volume.transfer);
  }
  draw_rays(volume);
  actions.lens = draw_lens_panel(volume, scene.looks, "FA", scene.info->bounds, state.histogram);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  ImGui::TextDisabled("inside lenses");
  const bool changed =
      focus.regions ? draw_region_editor("focus", state.histogram.places_of(volume.image), *focus.regions)
                    : draw_transfer_editor("focus", kAnisotropies, histogram, focus.colors);
  if (changed) set_focus(volume, focus);
}

void draw_line_look(LineStyle& style) {
  constexpr double kThin = 0.5, kThick = 20.0, kFaint = 0.05, kFull = 1.0;
  ImGui::SliderScalar("width", ImGuiDataType_Double, &style.width, &kThin, &kThick, "%.1f",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  ImGui::SliderScalar("opacity", ImGuiDataType_Double, &style.opacity, &kFaint, &kFull, "%.2f",
                      ImGuiSliderFlags_AlwaysClamp);
  ImGui::Checkbox("halos", &style.halo);
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  ImGui::Checkbox("fade with depth", &style.depth_cue);
}

void draw_look(SceneView& view, PanelActions& actions) {
  section("LOOK");
  if (!view.volume && !view.tensors && !view.tracts) draw_line_look(view.style);
  const float half = 0.5F * ImGui::GetContentRegionAvail().x;
  bool light = view.background == Background::kLight;
  bool perspective = view.camera.projection == Projection::kPerspective;
  ImGui::Checkbox("outline", &view.show_outline);
  ImGui::SameLine(half);
  ImGui::Checkbox("axes", &view.show_axes);
  ImGui::Checkbox("colour bar", &view.show_color_bar);
  ImGui::SameLine(half);
  if (ImGui::Checkbox("light", &light)) view.background = light ? Background::kLight : Background::kDark;
  if (ImGui::Checkbox("perspective", &perspective)) {
    view.camera.projection = perspective ? Projection::kPerspective : Projection::kOrthographic;
  }
  ImGui::Spacing();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{0.5F * (ImGui::GetContentRegionAvail().x - gap), 0.0F};
  constexpr std::array kLooks{std::pair{"x", Command::kLookAlongX}, std::pair{"y", Command::kLookAlongY},
                              std::pair{"z", Command::kLookAlongZ}};
  for (const auto& [axis, command] : kLooks) {
    if (ImGui::Button(axis, ImVec2{(size.x - 2.0F * gap) / 3.0F, 0.0F})) actions.look = command;
    ImGui::SameLine();
  }
  ImGui::TextUnformatted("look along");
  actions.reset_camera |= ImGui::Button("Reset view", size);
  ImGui::SameLine();
  actions.save_picture |= ImGui::Button("Save picture", size);
  actions.save_session |= ImGui::Button("Save session", size);
}

void draw_job(const Progress& job, PanelActions& actions) {
  const double fraction = job.fraction();
  const std::string stage = job.stage().empty() ? "working" : job.stage();
  if (fraction < 0.0) {
    // Unknown length: a bar that fills up with time and starts again.
    const auto seconds = static_cast<float>(job.seconds_in_stage());
    ImGui::ProgressBar(seconds - std::floor(seconds), {-FLT_MIN, 0.0F}, stage.c_str());
  } else {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%s %.0f %%", stage.c_str(), 100.0 * fraction);
    ImGui::ProgressBar(static_cast<float>(fraction), {-FLT_MIN, 0.0F}, text.data());
  }
  actions.cancel |= ImGui::Button("Cancel", {-FLT_MIN, 0.0F});
}

}  // namespace

WindowLayout layout(int width, int height, float text_height) {
  WindowLayout result;
  // A narrow window keeps at least half of its width for the picture.
  result.panel_width = std::min(std::round(21.0 * text_height), std::floor(0.5 * width));
  result.status_height = std::round(2.4 * text_height);
  result.picture = {result.panel_width, 0.0, std::max(1.0, width - result.panel_width),
                    std::max(1.0, height - result.status_height)};
  return result;
}

PanelActions draw_panels(PanelState& state, SceneView& view, const WindowLayout& layout) {
  PanelActions actions;
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize({static_cast<float>(layout.panel_width),
                            static_cast<float>(layout.picture.height + layout.status_height)});
  ImGui::Begin("panel", nullptr, kFixedPanel);
  ImGui::PushItemWidth(0.62F * ImGui::GetContentRegionAvail().x);
  if (state.job != nullptr) draw_job(*state.job, actions);
  if (state.scene != nullptr) {
    draw_input(*state.scene);
    draw_recent(state, actions);
    if (state.touch != nullptr && state.touch->available()) {
      section("TOUCH");
      actions.touch = draw_touch_panel(*state.touch, state.grabbed, state.lines_file, view, state.marking);
    }
    if (state.scene->tensors && view.tensors) {
      draw_tensors(state, *state.scene, *view.tensors, view.tracts);
      if (view.volume) draw_anisotropy(state, *state.scene, *view.volume, actions);
    } else if (view.tracts) {
      section("TRACTS");
      draw_tract_look(*view.tracts);
    } else if (state.scene->volume && view.volume) {
      draw_volume(state, *state.scene, *view.volume, actions);
    } else {
      if (state.scene->info->layers) {
        draw_layer(state, *state.scene);
      } else {
        draw_lines(state, *state.scene);
      }
      draw_color(state, *state.scene, view);
    }
    draw_look(view, actions);
    for (const std::string& note : state.scene->notes) {
      ImGui::Spacing();
      ImGui::TextWrapped("%s", note.c_str());
    }
  }
  ImGui::Spacing();
  ImGui::TextDisabled("H  keys and mouse");
  ImGui::PopItemWidth();
  ImGui::End();
  if (state.series && state.scene != nullptr) {
    actions.time = draw_series_plot(*state.series, series_plot_area(layout.picture, ImGui::GetFontSize()),
                                    state.scene->info->units);
  }
  draw_picture_panels(state, layout);
  return actions;
}

}  // namespace palpate
