#include "apps/dtmri/tensor_scene.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/dtmri/bundle_text.h"
#include "apps/dtmri/region_text.h"
#include "apps/dtmri/slice_images.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/domain_outline.h"
#include "common/compose/line_view.h"
#include "common/compose/text/lens_text.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/compose/volume_scene.h"
#include "common/load/read_tractogram.h"

namespace palpate {
namespace {

constexpr std::string_view kLeftOut = "off:";  ///< before the place of a slice that is not shown

/// The middle of what shows, on the centre of a voxel.
Vec3 middle_of(const TensorVoxels& voxels) {
  const Index3 at = (voxels.first_shown + voxels.last_shown + 1) / 2;
  return voxels.position(Vec3(at));
}

}  // namespace

FileRole role_of(const Input& input) {
  if (!input.fields().empty()) return FileRole::kTensors;
  const FileInfo& file = *input.file();
  if (may_hold_lines(file)) return FileRole::kTracts;
  const bool volume = input.not_volume().empty() && file.blocks.size() == 1 && file.times.size() < 2;
  const bool scalar = input.arrays().size() == 1 && input.arrays().front().components == 1;
  return volume && scalar ? FileRole::kScalar : FileRole::kTensors;
}

Document with_input_role(Document options, const Input& input) {
  const auto refuse = [&input](const std::string& option) {
    throw usage_error(option + ": " + input.title() + " takes this place already; leave one of them out");
  };
  FileRole kind = role_of(input);
  if (kind == FileRole::kScalar && options.tract_appearance.file.empty()) kind = FileRole::kTensors;
  if (kind == FileRole::kTensors) {
    (void)input.tensor_source();  // what it lacks, and an unknown --field
    return options;
  }
  if (!options.tracts.seeds.empty())
    throw usage_error("--seeds: " + input.title() + " has no tensors to trace tracts through");
  const std::string file = input.spec().files.front().string();
  if (kind == FileRole::kTracts) {
    if (!options.tract_appearance.file.empty()) refuse("--tracts");
    if (!takes_file(options.tract_appearance.bundles, file)) options.tract_appearance.file = file;
  } else {
    if (!options.tensors.underlay.empty()) refuse("--underlay");
    options.tensors.underlay = file;
  }
  return options;
}

Underlay load_underlay(const Document& document, Progress* progress) {
  InputOptions spec = input_of({document.tensors.underlay}, FieldKind::kScalar);
  spec.tensor.handedness = document.input.tensor.handedness;
  Input input = Input::open(spec, progress);
  Underlay underlay{load_volume(input, progress), input.notes()};
  if (input.times().size() > 1)
    underlay.notes.push_back("has " + std::to_string(input.times().size()) +
                             " volumes; the first one is shown");
  if (!input.file()->anatomical)
    underlay.notes.emplace_back(
        "does not say where in a patient it lies; its coordinates are taken as they are");
  for (std::string& note : underlay.notes) note.insert(0, input.title() + ": ");
  return underlay;
}

void check_underlay_options(const TensorOptions& options) {
  (void)underlay_blend_from_name(options.blend);
  if (options.window && !(*options.window > 0.0 && std::isfinite(*options.window)))
    throw usage_error("--window: a finite number above zero is expected");
  if (options.level && !std::isfinite(*options.level))
    throw usage_error("--level: a finite number is expected");
}

UnderlayView make_underlay_view(std::shared_ptr<const VolumeImage> image, const TensorOptions& options,
                                int threads) {
  UnderlayView view;
  if (image->lowest <= image->highest) {
    constexpr std::size_t kBins = 1024;
    view.window = default_window(count_values(
        image->point_count(), [&image](std::size_t i) { return image->value(i); }, image->lowest,
        image->highest, kBins, threads));
  }
  if (options.window) {
    // Darkest at the same value, unless the middle is said, too.
    view.window.level += 0.5 * (*options.window - view.window.width);
    view.window.width = *options.window;
  }
  view.window.level = options.level.value_or(view.window.level);
  view.blend = underlay_blend_from_name(options.blend);
  view.image = std::move(image);
  return view;
}

SliceChoice parse_slices(const std::string& text) {
  if (text == "all") return {};
  if (text == "none") return {.shown = {false, false, false}};
  SliceChoice choice;
  const std::vector<std::string_view> parts = split(text, ',');
  bool good = parts.size() == 3;
  for (std::size_t axis = 0; good && axis < 3; ++axis) {
    std::string_view place = parts[axis];
    choice.shown[axis] = place != "-" && !place.starts_with(kLeftOut);
    if (place == "-") continue;
    if (!choice.shown[axis]) place.remove_prefix(kLeftOut.size());
    choice.position[axis] = number(place);
    good = choice.position[axis] && std::isfinite(*choice.position[axis]);
  }
  if (!good) {
    throw usage_error(
        "--slices " + text +
        ": all, none, or a place on each axis is expected, such as 0,-12.5,30, with '-' or off:30 for "
        "a slice that is left out");
  }
  return choice;
}

std::string slices_text(const TensorView& view) {
  const Vec3 middle = middle_of(*view.image);
  const bool none = std::none_of(view.slices.begin(), view.slices.end(), [](bool shown) { return shown; });
  if (none && view.position == middle) return "none";
  const std::array<int, 3> axes = slice_axes(view.image->axes);
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ',';
    const int a = static_cast<int>(axis);
    const bool shown = view.slices[static_cast<std::size_t>(axes[axis])];
    if (!shown && view.position[a] == middle[a]) {
      text += '-';
      continue;
    }
    if (!shown) text += kLeftOut;
    text += exact_number(view.position[a]);
  }
  return text;
}

void check_tensor_options(const Document& options) {
  (void)parse_slices(options.tensors.slices);
  (void)tensor_color_from_name(options.tensors.color);
  (void)glyph_shape_from_name(options.tensors.glyphs);
  check_underlay_options(options.tensors);
  check_volume_options(options.volume);
}

Lens direction_lens(const VolumeOptions& options, const VolumeImage& image) {
  Lens lens;
  if (options.focus.empty()) {
    lens.transfer = anisotropy_body();
  } else {
    take_transfer(focus_transfer_of(options.focus, image, 0), lens);
  }
  lens.samples_per_voxel = options.samples;
  lens.shading = options.shading;
  lens.colored = true;
  return lens;
}

VolumeView make_tensor_volume(std::shared_ptr<const VolumeImage> anisotropy, const Document& options) {
  const VolumeOptions& with = options.volume;
  VolumeView volume;
  volume.image = std::move(anisotropy);
  volume.colored = options.tensors.volume == "direction";
  volume.transfer = volume.colored ? anisotropy_body() : anisotropy_veil();
  if (!with.transfer.empty()) {
    VolumeTransfer transfer = volume_transfer_of(with.transfer, *volume.image, 0);
    volume.transfer = std::move(transfer.colors);
    volume.regions = std::move(transfer.regions);
  }
  volume.samples_per_voxel = with.samples;
  volume.far_sampling = with.far_sampling;
  volume.context.viewport = with.context_viewport;
  volume.context.level = with.context_level;
  volume.shading = with.shading;
  volume.shadows = with.shadows;
  volume.illustrated = with.illustration;
  volume.context_fade = with.context_fade;
  volume.panes = slice_panes_of(options.panes, volume.image->bounds());
  const Lens model = direction_lens(with, *volume.image);
  VolumeParts parts = make_parts(with, model);
  const auto said = [](const std::string& one) { return !one.empty(); };
  if (std::any_of(parts.fields.begin(), parts.fields.end(), said) ||
      std::any_of(parts.transfers.begin(), parts.transfers.end(), said)) {
    throw usage_error("--lens: lenses of a tensor image show its directions; leave out ',field' and ',tf'");
  }
  volume.lenses = std::move(parts.lenses);
  volume.cuts = std::move(parts.cuts);
  for (Lens& lens : volume.lenses) lens.colored = !lens.cut;
  volume.shown = options.tensors.volume == "auto" ? !volume.lenses.empty() || is_cut(volume)
                                                  : options.tensors.volume != "none";
  return volume;
}

TractView make_tract_view(std::shared_ptr<const TractBundle> bundle, const TractAppearance& look) {
  return {
      .bundle = std::move(bundle), .width = look.width, .opacity = look.opacity, .slab_thickness = look.slab};
}

void complete_panes(const PanesOptions& options, TensorView& tensors, VolumeView& volume) {
  if (tensors.underlay) volume.slice_images.push_back(slice_image_of(*tensors.underlay));
  if (volume.panes.layout == 1) return;
  const Vec3& cross = volume.panes.cross;
  if (!options.cross.empty() && tensors.image->contains(tensors.image->grid_coordinates(cross))) {
    tensors.position = cross;
  } else if (options.cross.empty()) {
    volume.panes.cross = tensors.position;
  }
}

TensorView make_tensor_view(std::shared_ptr<const TensorVoxels> voxels, const TensorOptions& options) {
  const SliceChoice choice = parse_slices(options.slices);
  TensorView view;
  view.position = middle_of(*voxels);
  const std::array<int, 3> axes = slice_axes(voxels->axes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    view.slices[static_cast<std::size_t>(axes[axis])] = choice.shown[axis];
    if (choice.position[axis]) view.position[static_cast<int>(axis)] = *choice.position[axis];
  }
  if (!voxels->contains(voxels->grid_coordinates(view.position))) {
    const Box box = voxels->bounds();
    const auto corner = [](const Vec3& x) {
      return short_number(x.x) + "," + short_number(x.y) + "," + short_number(x.z);
    };
    throw usage_error("--slices " + options.slices + ": lies outside the image, which reaches from " +
                      corner(box.lower) + " to " + corner(box.upper));
  }
  view.color = tensor_color_from_name(options.color);
  view.glyphs = glyph_shape_from_name(options.glyphs);
  view.glyph_least_fa = options.glyph_fa;
  view.glyph_spacing = options.glyph_spacing;
  view.crosshair = options.crosshair;
  view.smooth = options.voxels == "linear";
  view.image = std::move(voxels);
  return view;
}

SceneView make_tensor_scene(const Input& input, TensorSceneParts parts, const Document& options,
                            double aspect) {
  SceneView view;
  view.title = input.title();
  const FileInfo* file = input.file();
  view.anatomical = file != nullptr && file->anatomical;
  apply_appearance(options, view);
  view.style.color_by = ColorBy::kDirection;
  if (parts.tensors) {
    const TensorVoxels& voxels = *parts.tensors->image;
    view.bounds = voxels.shown_bounds();  // a head fills a part of its image
    view.outline = image_outline(voxels.origin, voxels.axes, Vec3(voxels.first_shown) - 0.5,
                                 Vec3(voxels.last_shown) + 0.5);
    view.subtitle = std::to_string(voxels.points.x) + " x " + std::to_string(voxels.points.y) + " x " +
                    std::to_string(voxels.points.z) + " voxels";
    if (voxels.field) {
      view.subtitle.insert(0, input.field_label() + ", ");
      view.volume = make_tensor_volume(make_anisotropy_volume(parts.tensors->image), options);
      if (parts.made != nullptr)
        view.volume->slice_images =
            slice_images_of(*parts.made, view.volume->image, input.title(), options.common.threads);
      complete_panes(options.panes, *parts.tensors, *view.volume);
      view.volume_label = "FA";
    }
  } else if (parts.tracts) {
    view.bounds = parts.tracts->bundle->bounds;
  }
  if (parts.tracts && !(parts.tensors && parts.tensors->image->field)) {
    view.bounds.include(parts.tracts->bundle->bounds.lower);
    view.bounds.include(parts.tracts->bundle->bounds.upper);
    const std::string count = counted(parts.tracts->bundle->order.size(), "tract");
    view.subtitle = view.subtitle.empty() ? count : count + ", " + view.subtitle;
  }
  if (input.times().size() > 1) view.subtitle += ", time " + short_number(input.times()[input.time().step]);
  view.camera = camera_of(options.view, view.bounds, aspect, projection_of(options.volume));
  view.tensors = std::move(parts.tensors);
  view.tracts = std::move(parts.tracts);
  view.regions = region_views(options.tracts);
  return view;
}

std::vector<std::string> show_underlay(const Underlay& underlay, const Document& options,
                                       std::optional<TensorView>& tensors) {
  std::vector<std::string> notes = underlay.notes;
  if (!tensors) tensors = make_tensor_view(make_slice_lattice(*underlay.image), options.tensors);
  tensors->underlay = make_underlay_view(underlay.image, options.tensors, options.common.threads);
  const Box slices = tensors->image->bounds(), below = underlay.image->bounds();
  for (int axis = 0; axis < 3; ++axis) {
    if (below.upper[axis] >= slices.lower[axis] && below.lower[axis] <= slices.upper[axis]) continue;
    notes.emplace_back(
        "WARNING: the underlay lies beside the image: nothing of it can be seen on the slices");
    break;
  }
  return notes;
}

}  // namespace palpate
