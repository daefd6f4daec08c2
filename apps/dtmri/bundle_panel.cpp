#include "apps/dtmri/bundle_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <imgui.h>

#include "apps/dtmri/bundle_plot.h"
#include "apps/dtmri/bundle_tables.h"
#include "apps/dtmri/bundle_text.h"
#include "apps/dtmri/region_text.h"
#include "apps/dtmri/slice_images.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/bundle_view.h"
#include "common/load/write/write_tractogram.h"
#include "common/math/vec_text.h"
#include "common/scene/origin_of.h"
#include "common/trace/tract/tract_edit.h"
#include "common/window/files/saved_files.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

using Bundles = std::vector<BundleText>;

/// As the scene has made it; null while it is being made, or could not be.
const BundleView* made_of(const BundleText& bundle, std::size_t i, const SceneState& scene) {
  if (!scene.bundles || i >= scene.bundles->bundles.size()) return nullptr;
  const BundleView& view = scene.bundles->bundles[i];
  return view.text == steps_text(bundle.steps) ? &view : nullptr;
}

std::string name_of(const BundleText& bundle, std::size_t i) {
  return std::to_string(i + 1) + " " + (bundle.name.empty() ? "without a name" : bundle.name);
}

/// The first parts of a file's name and of an image's colour.
void add_bundle(std::string name, std::vector<BundleStep> steps, Bundles& bundles) {
  std::erase_if(name, [](char c) { return c == '|' || c == ';'; });
  bundles.push_back(
      {.name = std::move(name), .color = first_color(bundles.size()), .steps = std::move(steps)});
}

/// Lines that a hand has drawn, with a point at every half edge of a voxel.
std::vector<BundleStep> steps_of_drawn(const DrawnLines& drawn, double edge) {
  std::vector<BundleStep> steps;
  for (const DrawnLines::Entry& entry : drawn.entries()) {
    std::string text;
    Vec3 last{0.0};
    const auto& points = entry.line->points;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Vec3 x = points[p].position;
      const bool end = p == 0 || p + 1 == points.size();
      if (!end && glm::distance(x, last) < 0.5 * edge) continue;
      text += (text.empty() ? "" : ",") + exact_text(x);
      last = x;
    }
    if (points.size() > 1) steps.push_back({"line", text});
  }
  return steps;
}

/// Bundles of what is traced, opened or drawn.
void draw_sources(PanelContext& on, Bundles& bundles) {
  Document& document = on.state.document;
  std::filesystem::path file = document.tract_appearance.file;
  // A tractogram that is open alone is the input, until a bundle takes its tracts.
  const bool beside = on.scene.bundles ? on.scene.bundles->tracts != nullptr : on.scene.tracts.has_value();
  if (const auto& input = document.input.files;
      file.empty() && beside && !on.view.tensors->image->field && !input.empty())
    file = std::filesystem::absolute(input.front());
  const bool traced = !document.tracts.seeds.empty(), opened = !file.empty();
  ImGui::BeginDisabled(!traced && !opened);
  const bool keeps = button("Keep as bundle");
  ImGui::EndDisabled();
  hint("the tracts that are traced or opened, as a bundle of its own; the next Trace leaves it");
  ImGui::SameLine();
  const DrawnLines* const drawn =
      on.state.touch != nullptr ? &on.state.touch->trail().drawn_lines() : nullptr;
  ImGui::BeginDisabled(drawn == nullptr || drawn->entries().empty());
  const bool draws = button("Drawn as bundle");
  ImGui::EndDisabled();
  hint("the tracts that were drawn and kept, thinned to a point every half voxel");
  if (keeps && opened) {
    add_bundle(file.stem().string(), {{"file", file.string()}}, bundles);
    document.tract_appearance.file.clear();
  } else if (keeps && traced) {
    add_bundle("bundle " + std::to_string(bundles.size() + 1), steps_of(document.tracts), bundles);
    document.tracts.seeds.clear();
  }
  if (draws) add_bundle("drawn", steps_of_drawn(*drawn, on.view.tensors->image->shortest_edge()), bundles);
}

void edit_color(const std::string& number, const SceneView& view, std::size_t i, BundleText& bundle) {
  const std::vector<SliceImage> images = slice_images_in(view.volume, view.tensors);
  const auto own = color_of_text(bundle.color);
  std::vector<std::string> words{"direction", "its own"};
  for (const SliceImage& image : images) {
    if (image.name != "direction") words.push_back(image.name);
  }
  std::string word = own ? "its own" : bundle.color;
  if (choose_word(("colour " + number).c_str(), word, words))
    bundle.color = word == "its own" ? first_color(i) : word;
  if (own) {
    std::array<float, 3> color{own->x, own->y, own->z};
    if (color_edit(("paint " + number).c_str(), color.data(), ImGuiColorEditFlags_NoInputs))
      bundle.color = text_of_color({color[0], color[1], color[2]});
  } else if (const SliceImage* const image = find_slice_image(images, bundle.color);
             image != nullptr && bundle.color != "direction") {
    ImGui::TextDisabled("dark %s to bright %s",
                        short_number(image->window.level - 0.5 * image->window.width).c_str(),
                        short_number(image->window.level + 0.5 * image->window.width).c_str());
  }
}

void edit_name(BundlePanel& panel, const std::string& number, std::size_t i, BundleText& bundle) {
  std::string typed = panel.named == i ? panel.name : bundle.name;
  input_text(("name " + number).c_str(), &typed);
  if (ImGui::IsItemActive()) {
    panel.named = i;
    panel.name = typed;
  }
  if (!ImGui::IsItemDeactivatedAfterEdit()) return;
  std::erase_if(typed, [](char c) { return c == '|' || c == ';'; });
  bundle.name = typed;
  panel.named.reset();
}

void show_figures(const BundleText& bundle, const BundleView* made) {
  if (made == nullptr) {
    ImGui::TextDisabled("not made yet");
    return;
  }
  std::string text = counted(made->lines->line_count(), "tract");
  if (made->lines->line_count() > 0)
    text += ", " + short_number(std::round(10.0 * made->shortest) / 10.0) + " to " +
            short_number(std::round(10.0 * made->longest) / 10.0) + " mm, median " +
            short_number(std::round(10.0 * made->median) / 10.0) + "; " +
            short_number(std::round(made->volume) / 1000.0) + " cm^3";
  if (made->mean) text += "; mean " + made->measure + " " + short_number(*made->mean);
  if (made->outside > 0)
    text += ". WARNING: " + counted(made->outside, "tract") + " leave the image; volume without that";
  if (!bundle.shown) text += "; hidden";
  ImGui::TextWrapped("%s", text.c_str());
}

void draw_list(BundlePanel& panel, const PanelContext& on, Bundles& bundles) {
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const std::string number = std::to_string(i + 1);
    checkbox(("bundle " + number).c_str(), &bundles[i].shown);
    hint("shown or hidden");
    ImGui::SameLine();
    if (small_button(("Remove bundle " + number).c_str())) removed = i;
    hint("the bundle; Ctrl+Z brings it back");
    edit_name(panel, number, i, bundles[i]);
    edit_color(number, on.view, i, bundles[i]);
    show_figures(bundles[i], made_of(bundles[i], i, on.scene));
    ImGui::PopID();
  }
  if (removed) bundles.erase(bundles.begin() + static_cast<std::ptrdiff_t>(*removed));
}

std::optional<std::size_t> choose_bundle(const char* label, std::size_t chosen, const Bundles& bundles) {
  std::optional<std::size_t> other;
  if (!begin_combo(label, chosen < bundles.size() ? name_of(bundles[chosen], chosen).c_str() : ""))
    return other;
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    if (selectable(name_of(bundles[i], i).c_str(), i == chosen)) other = i;
  }
  ImGui::EndCombo();
  return other;
}

/// A length that begins as `usual`, and a button that does something with it.
bool length_and_button(const char* label, std::optional<double>& length, double usual, double most,
                       const char* act) {
  double value = length.value_or(usual);
  if (slider(label, value, 0.01 * most, most, "%.3g mm", ImGuiSliderFlags_Logarithmic)) length = value;
  return button(act);
}

void edit_lengths(BundlePanel& panel, const BundleView* made, std::vector<BundleStep>& steps) {
  const double longest = made != nullptr ? std::max(made->longest, 1.0) : 1.0;
  double least = panel.shortest.value_or(0.0), most = panel.longest.value_or(longest);
  if (slider("shortest", least, 0.0, longest, "%.4g mm")) panel.shortest = least;
  hint("tracts that are shorter go");
  if (slider("longest", most, 0.0, longest, "%.4g mm")) panel.longest = most;
  hint("tracts that are longer go");
  const bool keeps = button("Keep lengths");
  hint("tracts from the shortest to the longest length");
  if (!keeps || most < least) return;
  steps.push_back({"length", exact_number(least) + "," + exact_number(most)});
  panel.shortest.reset();
  panel.longest.reset();
}

/// Steps by the regions of the part above: include keeps, exclude drops.
void edit_by_regions(const TractTracingOptions& options, std::vector<BundleStep>& steps) {
  ImGui::BeginDisabled(options.include.empty() && options.exclude.empty());
  const bool cleans = button("Clean by regions");
  ImGui::EndDisabled();
  hint("keeps tracts that pass all regions to include and none to exclude, as REGIONS lists them");
  ImGui::SameLine();
  ImGui::BeginDisabled(options.include.size() != 1);
  const bool crops = button("Crop to region");
  ImGui::EndDisabled();
  hint("keeps the parts of tracts that lie in the one region to include");
  if (cleans) {
    for (const std::string& region : options.include) steps.push_back({"keep", region});
    for (const std::string& region : options.exclude) steps.push_back({"drop", region});
  }
  if (crops) steps.push_back({"crop", options.include.front()});
}

void edit_at_crosshair(BundlePanel& panel, const TensorView& tensors, const BundleView* made,
                       std::vector<BundleStep>& steps) {
  constexpr std::array<const char*, 3> kPlanes{"sagittal", "coronal", "axial"};
  combo("plane", &panel.axis, kPlanes.data(), static_cast<int>(kPlanes.size()));
  hint("through the crosshair, at which tracts are parted");
  Vec3 normal{0.0};
  normal[panel.axis] = 1.0;
  const Vec3& x = tensors.position;
  const bool parts = button("Part all here");
  hint("cuts all tracts where they cross that plane");
  ImGui::SameLine();
  ImGui::BeginDisabled(made == nullptr || made->lines->line_count() == 0);
  const bool cuts = button("Cut nearest");
  ImGui::EndDisabled();
  hint("cuts the tract that is nearest to the crosshair, there");
  if (parts) steps.push_back({"part", exact_text(normal) + "," + exact_number(x[panel.axis])});
  if (!cuts) return;
  if (const auto at = nearest_place(*made->lines, x))
    steps.push_back({"cut", std::to_string(at->line + 1) + "," + exact_text(at->place)});
}

/// What was asked for by the mouse.
void take_pick(BundlePanel& panel, const TractPick& pick, const Bundles& bundles, PanelContext& on) {
  std::optional<PickedTract> found;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    const BundleView* const made = made_of(bundles[i], i, on.scene);
    if (made == nullptr || !bundles[i].shown) continue;
    const auto at = pick.place ? nearest_place(*made->lines, *pick.place)
                               : place_along_ray(*made->lines, pick.beam.origin, pick.beam.direction,
                                                 pick.beam.radius, pick.beam.spread);
    if (!at || at->distance >= least) continue;
    least = at->distance;
    found = PickedTract{.bundle = i, .line = at->line, .place = at->place, .text = made->text};
  }
  if (!found) {
    on.state.say("no tract of a bundle is there");
    return;
  }
  if (panel.picked != found) panel.before = std::exchange(panel.picked, found);
  panel.chosen = found->bundle;
}

/// Whether the bundle is still what it was when the tract was picked.
bool holds(const std::optional<PickedTract>& picked, const Bundles& bundles, const SceneState& scene) {
  if (!picked || picked->bundle >= bundles.size()) return false;
  const BundleView* const made = made_of(bundles[picked->bundle], picked->bundle, scene);
  return made != nullptr && made->text == picked->text;
}

void mark(const PickedTract& picked, const Bundles& bundles, PanelContext& on) {
  const BundleView& made = *made_of(bundles[picked.bundle], picked.bundle, on.scene);
  NoteView note{.points = {picked.place}, .outline = {}, .words = "tract " + std::to_string(picked.line + 1)};
  for (const Vec3f& x : made.lines->line(picked.line)) note.outline.emplace_back(x);
  on.state.marks.push_back(std::move(note));
}

void draw_picks(BundlePanel& panel, PanelContext& on, Bundles& bundles) {
  TractPickControl& control = *on.state.tract_pick;
  checkbox("pick tracts", &control.on);
  hint(
      "a left click in the picture or on a slice picks the tract of a bundle there; until it is off, the left button turns nothing");
  if (const auto pick = control.take()) take_pick(panel, *pick, bundles, on);
  if (!holds(panel.before, bundles, on.scene)) panel.before.reset();
  if (!holds(panel.picked, bundles, on.scene)) panel.picked.reset();
  if (panel.before) mark(*panel.before, bundles, on);
  if (panel.picked) mark(*panel.picked, bundles, on);
  const bool two = panel.picked && panel.before && panel.picked->bundle == panel.before->bundle &&
                   panel.picked->line != panel.before->line;
  ImGui::BeginDisabled(!panel.picked);
  const bool deletes = button("Delete tract");
  hint("the one that was picked");
  ImGui::SameLine();
  const bool cuts = button("Cut tract");
  hint("in two, where it was picked");
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!two);
  const bool joins = button("Join tracts");
  ImGui::EndDisabled();
  hint("the two that were picked last, of one bundle: the nearest of their ends meet");
  if (!panel.picked) return;
  std::vector<BundleStep>& steps = bundles[panel.picked->bundle].steps;
  const std::string number = std::to_string(panel.picked->line + 1);
  if (deletes) {
    steps.push_back({"delete", number});
  } else if (cuts) {
    steps.push_back({"cut", number + "," + exact_text(panel.picked->place)});
  } else if (joins) {
    steps.push_back({"join", std::to_string(panel.before->line + 1) + "," + number});
  }
}

void edit_chosen(BundlePanel& panel, const PanelContext& on, Bundles& bundles) {
  panel.chosen = std::min(panel.chosen, bundles.size() - 1);
  if (const auto other = choose_bundle("edit", panel.chosen, bundles)) panel.chosen = *other;
  hint("the bundle that what follows is done to; every edit can be taken back by Ctrl+Z");
  std::vector<BundleStep>& steps = bundles[panel.chosen].steps;
  const BundleView* const made = made_of(bundles[panel.chosen], panel.chosen, on.scene);
  const double edge = on.view.tensors->image->shortest_edge();
  constexpr double kMostEdges = 10.0;
  if (length_and_button("smoothing", panel.smooth, edge, kMostEdges * edge, "Smooth"))
    steps.push_back({"smooth", exact_number(panel.smooth.value_or(edge))});
  hint("each point becomes a mean along its tract; the standard deviation of its weights");
  if (length_and_button("spacing", panel.resample, edge, kMostEdges * edge, "Resample"))
    steps.push_back({"resample", exact_number(panel.resample.value_or(edge))});
  hint("points at equal distances along each tract, none farther apart than that");
  edit_lengths(panel, made, steps);
  edit_by_regions(on.state.document.tracts, steps);
  edit_at_crosshair(panel, *on.view.tensors, made, steps);
}

/// Another bundle behind the chosen one, as one.
void join_bundles(BundlePanel& panel, Bundles& bundles) {
  if (bundles.size() < 2) return;
  panel.with = std::min(panel.with, bundles.size() - 1);
  if (const auto other = choose_bundle("with", panel.with, bundles)) panel.with = *other;
  ImGui::BeginDisabled(panel.with == panel.chosen);
  const bool joins = button("Join bundles");
  ImGui::EndDisabled();
  hint("both become one, in the place of the one that is edited");
  if (!joins) return;
  bundles[panel.chosen] = merged(bundles[panel.chosen], bundles[panel.with]);
  bundles.erase(bundles.begin() + static_cast<std::ptrdiff_t>(panel.with));
  if (panel.with < panel.chosen) --panel.chosen;
}

/// "left_fa.csv" of "left.trx", or the next name that no file has.
std::filesystem::path place_of(const std::string& file, const std::string& ending) {
  const std::filesystem::path path(file);
  return free_place(path.parent_path(), path.stem().string(), ending);
}

/// @throws Error.
std::string write_chosen(const BundlePanel& panel, const PanelContext& on, const BundleView& made,
                         std::string_view what) {
  if (what == "bundle") {
    const std::filesystem::path tracts =
        place_of(panel.file, std::filesystem::path(panel.file).extension().string());
    write_tractogram(tracts, *made.lines, false);
    return "saved " + tracts.string() + ": " + counted(made.lines->line_count(), "tract");
  }
  if (what == "profile") {
    const std::filesystem::path table = place_of(panel.file, "_" + made.measure + ".csv");
    write_profile(table, *made.profile, false);
    return "saved " + table.string() + ": " + made.measure + " along " +
           counted(made.profile->lines, "tract");
  }
  const bool mask = what == "mask";
  const TensorVoxels& voxels = *on.view.tensors->image;
  const BundleDensity density = bundle_density(*made.lines, *made.lines->image);
  ImageOrigin origin;
  origin.space = on.view.anatomical ? ImageSpace::kPatient : ImageSpace::kUnknown;
  const std::filesystem::path image = place_of(panel.file, mask ? "_mask.nii.gz" : "_density.nii.gz");
  const auto lost =
      write_density(image, density, mask, {voxels.points, voxels.origin, voxels.axes}, origin, false);
  std::string said = "saved " + image.string() + ": " + density_text(density, made.lines->line_count());
  for (const std::string& note : lost) said += "; " + note;
  return said;
}

void draw_files(BundlePanel& panel, const PanelContext& on, const Bundles& bundles) {
  input_text("bundle file", &panel.file);
  hint(".trx, .trk, .tck, .vtp or .csv; image and table get its name and an ending of their own");
  std::filesystem::path path(panel.file);
  std::string ending = lower_ending(path);
  if (choose_word("format", ending, {".trx", ".trk", ".tck", ".vtp", ".csv"}))
    panel.file = path.replace_extension(ending).string();
  hint("of the file: .trx holds everything, .tck places alone");
  const BundleView* const made = made_of(bundles[panel.chosen], panel.chosen, on.scene);
  const bool some = made != nullptr && made->lines->line_count() > 0;
  ImGui::BeginDisabled(!some);
  std::string asked;
  if (button("Save bundle")) asked = "bundle";
  hint("the one that is edited, under the next free name");
  ImGui::SameLine();
  if (button("Save density")) asked = "density";
  hint("how many of its tracts pass each voxel, an image");
  if (button("Save mask")) asked = "mask";
  hint("an image that is 1 where its tracts pass");
  ImGui::SameLine();
  ImGui::EndDisabled();
  ImGui::BeginDisabled(!some || !made->profile);
  if (button("Save profile")) asked = "profile";
  ImGui::EndDisabled();
  hint("what is plotted, as a table");
  if (asked.empty()) return;
  try {
    on.state.say(write_chosen(panel, on, *made, asked));
  } catch (const Error& error) {
    on.state.fail(error.what());
  }
}

void draw_profiles(PanelContext& on, const Bundles& bundles) {
  std::string& measure = on.state.document.tract_appearance.bundle_profile;
  std::vector<std::string> words{"nothing"};
  for (const SliceImage& image : slice_images_in(on.view.volume, on.view.tensors)) {
    if (image.name != "direction") words.push_back(image.name);
  }
  std::string word = measure.empty() ? "nothing" : measure;
  if (choose_word("profile of", word, words)) measure = word == "nothing" ? std::string() : word;
  explain("bundle-profile");
  if (measure.empty()) return;
  std::vector<BundleCurve> curves;
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    const BundleView* const made = made_of(bundles[i], i, on.scene);
    if (made == nullptr || !bundles[i].shown || !made->profile || made->measure != measure) continue;
    const Rgb color = color_of_text(bundles[i].color).value_or(*color_of_text(first_color(i)));
    curves.push_back({.profile = &*made->profile, .color = color});
  }
  draw_bundle_plot(measure, curves);
}

}  // namespace

void draw_bundles(BundlePanel& panel, PanelContext& on) {
  on.state.marks.clear();
  std::vector<std::string>& texts = on.state.document.tract_appearance.bundles;
  Bundles bundles;
  for (const std::string& text : texts) bundles.push_back(parse_bundle(text));
  if (section("BUNDLES", false, {"bundle-profile"})) {
    draw_sources(on, bundles);
    draw_list(panel, on, bundles);
    if (!bundles.empty()) {
      if (on.state.tract_pick != nullptr) draw_picks(panel, on, bundles);
      edit_chosen(panel, on, bundles);
      join_bundles(panel, bundles);
      draw_profiles(on, bundles);
      draw_files(panel, on, bundles);
    }
  }
  if (bundles.empty() && on.state.tract_pick != nullptr) on.state.tract_pick->on = false;
  try {
    std::vector<std::string> edited;
    for (const BundleText& bundle : bundles) edited.push_back(bundle_text(bundle));
    if (edited != texts) texts = std::move(edited);
  } catch (const Error& error) {
    on.state.fail(error.what());
  }
}

}  // namespace palpate
