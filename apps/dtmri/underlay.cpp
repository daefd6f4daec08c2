#include "apps/dtmri/underlay.h"

#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/compose/volume_scene.h"
#include "common/load/read_tractogram.h"

namespace palpate {

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
    options.tract_appearance.file = file;
  } else {
    if (!options.tensors.underlay.empty()) refuse("--underlay");
    options.tensors.underlay = file;
  }
  return options;
}

Underlay load_underlay(const std::filesystem::path& file, Progress* progress) {
  InputOptions spec{.files = {file}};
  spec.kind = FieldKind::kScalar;
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

}  // namespace palpate
