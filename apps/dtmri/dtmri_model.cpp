#include "apps/dtmri/dtmri_model.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "apps/dtmri/bundle_text.h"
#include "apps/dtmri/bundles.h"
#include "apps/dtmri/region_text.h"
#include "apps/dtmri/slice_images.h"
#include "apps/dtmri/tensor_scene.h"
#include "apps/dtmri/tract_request.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/bundle_view.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/compose/view_keep.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"

namespace palpate {
namespace {

std::shared_ptr<const SceneInfo> info_of(const Input& input, const SceneView& view) {
  SceneInfo info = describe_open_input(input);
  info.bounds = view.bounds;
  info.outline = view.outline;
  info.anatomical = view.anatomical;
  return std::make_shared<const SceneInfo>(std::move(info));
}

/// Whether both trace or read the same tracts.
bool same_tracts(const Document& a, const Document& b) {
  return a.input.field == b.input.field && a.input.time == b.input.time && a.input.tensor == b.input.tensor &&
         a.tract_appearance.file == b.tract_appearance.file && a.tracts == b.tracts;
}

const DataArray* cones_of(const DtmriScene& content) { return content.cones ? &*content.cones : nullptr; }

/// Tracts of a file, or traced from seeds: those of `before` where these are the same.
/// @param document with the input in its role. @param shown that of `before`, likewise.
void show_tracts(const Document& document, const SceneState* before, const Document& shown,
                 const DtmriScene& content, Progress& progress, SceneState& state) {
  const auto show = [&](const std::shared_ptr<const TractBundle>& bundle) {
    state.tracts = make_tract_view(bundle, document.tract_appearance);
  };
  const auto shown_before = [&] {
    if (before == nullptr) return std::shared_ptr<const TractBundle>();
    if (before->bundles) return before->bundles->tracts;  // without the bundles beside them
    return before->tracts ? before->tracts->bundle : nullptr;
  };
  if (document.tracts.seeds.empty() && document.tract_appearance.file.empty()) return;
  if (const auto same = shown_before(); same && same_tracts(document, shown)) {
    show(same);
    state.seeds = before->seeds;
    state.seconds_trace = before->seconds_trace;
  } else if (document.tracts.seeds.empty()) {
    const TensorField* const field = state.tensors ? state.tensors->image->field.get() : nullptr;
    const ViewTracts read = content.tracts ? *content.tracts
                                           : read_view_tracts({.file = document.tract_appearance.file}, field,
                                                              document.common.threads, &progress);
    show(read.bundle);
    state.notes.insert(state.notes.end(), read.notes.begin(), read.notes.end());
    if (!read.left_out.empty()) state.notes.push_back(read.left_out);
  } else if (!state.tensors) {
    throw usage_error("there are no tensors to trace tracts through");
  } else {
    const ViewTracts traced =
        trace_view_tracts(document, *state.tensors->image, cones_of(content), &progress);
    show(traced.bundle);
    state.notes.insert(state.notes.end(), traced.notes.begin(), traced.notes.end());
    state.seeds = traced.seeds;
    state.seconds_trace = traced.seconds;
    if (traced.bundle->order.empty()) state.notes.push_back("no tract: " + traced.why_none);
    if (!traced.left_out.empty()) state.notes.push_back(traced.left_out);
  }
}

/// The bundles of the document beside the tracts that are shown. @pre state.tensors.
void show_bundles(const Document& document, const SceneState* before, const Document& shown,
                  const DataArray* cones, Progress& progress, SceneState& state) {
  const bool same = before != nullptr && before->tensors && before->tensors->image == state.tensors->image &&
                    document.common.seed == shown.common.seed;
  const std::vector<SliceImage> images = slice_images_in(state.volume, state.tensors);
  const auto set = make_bundles({.document = document,
                                 .voxels = *state.tensors->image,
                                 .cones = cones,
                                 .before = same ? before->bundles.get() : nullptr,
                                 .progress = &progress},
                                images, state.notes);
  if (!set) return;
  const auto beside = std::make_shared<BundleSet>(*set);
  if (state.tracts) beside->tracts = state.tracts->bundle;
  state.bundles = beside;
  const auto drawn = drawn_together(beside->tracts, *beside, images, state.notes);
  state.tracts = drawn ? std::optional(make_tract_view(drawn, document.tract_appearance)) : std::nullopt;
  if (!drawn) return;
  if (std::string note = tracts_left_out(*drawn); !note.empty()) state.notes.push_back(std::move(note));
}

/// Whether what is open is a tractogram.
bool holds_tracts(const Document& document, Progress* progress) {
  return !document.input.files.empty() && role_of(Input::open(document.input, progress)) == FileRole::kTracts;
}

/// What the verdict advises, where nothing was turned by hand yet: two turns together are none that a button can say.
void add_fix(const OrientationVerdict& verdict, const Document& document, SceneState& state) {
  const TensorSpec &asked = document.input.tensor, plain;
  if (!verdict.suspicious || verdict.rotated || asked.flip != plain.flip || asked.permute != plain.permute)
    return;
  const auto note = std::ranges::find_if(state.notes, [&](const std::string& one) {
    return one.find(verdict.advice) != std::string::npos && one.starts_with("WARNING");
  });
  if (note == state.notes.end()) return;
  SceneFix fix{.note = *note, .settings = {}};
  // "--vectors scanner --flip k"
  const std::vector<std::string_view> words = split(verdict.advice, ' ');
  for (std::size_t i = 0; i + 1 < words.size(); i += 2)
    fix.settings.emplace_back(words[i].substr(2), words[i + 1]);
  state.fixes.push_back(std::move(fix));
}

}  // namespace

DtmriModel::DtmriModel(Document document, std::string program)
    : InputModel(std::move(document), std::move(program), FieldKind::kTensor) {}

DtmriContent DtmriModel::read(Input& input, const Document& document, Progress& progress) const {
  if (role_of(input) != FileRole::kTensors || input.fields().empty()) {
    (void)with_input_role(document, input);  // refuses what cannot be shown
    SceneState state = begin_state(input, {});
    state.info = std::make_shared<const SceneInfo>(describe_open_input(input));
    DtmriScene scene{.state = std::move(state), .cones = {}, .tracts = {}, .lattice = {}};
    if (role_of(input) == FileRole::kTracts) {
      scene.tracts = read_view_tracts({.file = input.spec().files.front().string()}, nullptr,
                                      document.common.threads, &progress);
      scene.lattice = lattice_of_lines(*scene.tracts->bundle->lines);
    }
    return std::make_shared<const DtmriScene>(std::move(scene));
  }
  TensorImage made;
  auto field = input.load_tensor(document.common.threads, &progress, &made);
  progress.begin("colouring the voxels", 0);
  const auto voxels = make_tensor_voxels(field, input.title(), document.common.threads);
  SceneView view = make_tensor_scene(
      input, {.tensors = make_tensor_view(voxels, document.tensors), .tracts = {}, .made = &made}, document,
      1.0);
  SceneState state = begin_state(input, {});
  state.info = info_of(input, view);
  state.volume = std::move(view.volume);
  state.volume_label = view.volume_label;
  state.tensors = std::move(view.tensors);
  state.notes.insert(state.notes.end(), field->notes().lines.begin(), field->notes().lines.end());
  add_fix(made.orientation, document, state);
  const DataArray* const cones = made.image.find(std::string(kConeArray), Association::kPoint);
  return std::make_shared<const DtmriScene>(
      DtmriScene{.state = std::move(state),
                 .cones = cones != nullptr ? std::optional(*cones) : std::nullopt,
                 .tracts = {},
                 .lattice = {}});
}

SceneState DtmriModel::present(Input& input, const DtmriContent& content, const Document& document,
                               const SceneState* before, Progress& progress) const {
  const Document with = with_input_role(document, input);
  const Document shown = before != nullptr ? with_input_role(before->document, input) : Document();
  const SceneState& made = content->state;
  SceneState state = made;
  state.document = document;
  state.regions = region_views(document.tracts);
  if (made.tensors) {
    state.tensors = make_tensor_view(made.tensors->image, document.tensors);
    state.volume = make_tensor_volume(made.volume->image, document);
    state.volume->slice_images = made.volume->slice_images;
    state.appearances = {direction_lens(document.volume, *state.volume->image)};
  }
  show_tracts(with, before, shown, *content, progress, state);
  if (const std::string& file = with.tensors.underlay; !file.empty()) {
    const bool read = before != nullptr && before->tensors && before->tensors->underlay &&
                      shown.tensors.underlay == file &&
                      shown.input.tensor.handedness == with.input.tensor.handedness;
    Underlay underlay;
    if (read) {
      underlay.image = before->tensors->underlay->image;
    } else {
      underlay = load_underlay(with, &progress);
    }
    for (std::string& note : show_underlay(underlay, with, state.tensors))
      state.notes.push_back(std::move(note));
  }
  if (made.tensors) {
    complete_panes(document.panes, *state.tensors, *state.volume);
    show_bundles(with, before, shown, cones_of(*content), progress, state);
    if (state.volume->panes.layout > 1) {
      if (std::string note = panes_note(*state.volume); !note.empty()) state.notes.push_back(std::move(note));
    }
    return state;
  }
  // Where there are no tensors, the scene is as large as what the file holds in their place.
  std::optional<TractView> held = state.tracts;
  if (content->tracts) held = make_tract_view(content->tracts->bundle, document.tract_appearance);
  const SceneView view = make_tensor_scene(input, {.tensors = state.tensors, .tracts = held}, document, 1.0);
  state.info = info_of(input, view);
  // Slices of no image: the crosshair alone.
  if (content->lattice && !state.tensors)
    state.tensors = make_tensor_view(content->lattice, document.tensors);
  if (state.tensors) show_bundles(with, before, shown, nullptr, progress, state);
  return state;
}

std::optional<Document> DtmriModel::join(const InputFiles& files, const Document& now,
                                         Progress& progress) const {
  if (files.files.size() != 1 || files.solution) return std::nullopt;
  const Input input = Input::open(input_of(files.files, FieldKind::kTensor), &progress);
  Document with = now;
  switch (role_of(input)) {
    case FileRole::kTracts:
      if (const std::filesystem::path file = std::filesystem::absolute(files.files.front());
          now.tract_appearance.file.empty() && !holds_tracts(now, &progress)) {
        with.tract_appearance.file = file.string();
        with.tracts.seeds.clear();
      } else {
        std::vector<std::string>& bundles = with.tract_appearance.bundles;
        bundles.push_back(bundle_text({.name = file.stem().string(),
                                       .color = first_color(bundles.size()),
                                       .steps = {{"file", file.string()}}}));
      }
      return with;
    case FileRole::kScalar:
      with.tensors.underlay = std::filesystem::absolute(files.files.front()).string();
      with.tensors.window = with.tensors.level = {};  // as its own values have it
      return with;
    case FileRole::kTensors:
      break;
  }
  return std::nullopt;
}

void DtmriModel::keep(const SceneView& view, Document& document) const {
  keep_camera(view, document);
  keep_appearance(view, document);
  if (view.tracts) {
    document.tract_appearance.width = view.tracts->width;
    document.tract_appearance.opacity = view.tracts->opacity;
    document.tract_appearance.slab = view.tracts->slab_thickness;
  }
  if (view.tensors) {
    TensorOptions& kept = document.tensors;
    kept.slices = slices_text(*view.tensors);
    kept.color = name_of(view.tensors->color);
    kept.crosshair = view.tensors->crosshair;
    kept.glyphs = name_of(view.tensors->glyphs);
    kept.glyph_fa = view.tensors->glyph_least_fa;
    kept.glyph_spacing = view.tensors->glyph_spacing;
    kept.voxels = view.tensors->smooth ? "linear" : "nearest";
    if (view.tensors->underlay) {
      const UnderlayView& underlay = *view.tensors->underlay;
      kept.blend = name_of(underlay.blend);
      kept.window = underlay.window.width;
      kept.level = underlay.window.level;
    }
  }
  if (!view.volume) return;
  const VolumeView& volume = *view.volume;
  keep_volume(volume, document);
  document.tensors.volume = !volume.shown ? "none" : volume.colored ? "direction" : "fa";
  document.volume.transfer = volume.regions ? region_text(*volume.regions) : transfer_text(volume.transfer);
  const auto lens = std::find_if(volume.lenses.begin(), volume.lenses.end(),
                                 [](const Lens& one) { return (one.transfer || one.regions) && !one.cut; });
  if (lens != volume.lenses.end())
    document.volume.focus = lens->regions ? region_text(*lens->regions) : transfer_text(*lens->transfer);
}

}  // namespace palpate
