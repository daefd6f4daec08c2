#include "common/compose/volume_fields.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/compose/text/lens_text.h"

namespace palpate {
namespace {

bool is_file(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::exists(name, ignored);
}

// A file, and which of its scalars; nothing where there is no such file.
struct FileField {
  std::string file, scalar;
};
std::optional<FileField> file_field(const std::string& name) {
  if (is_file(name)) return FileField{name, ""};
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos || !is_file(name.substr(0, colon))) return std::nullopt;
  return FileField{name.substr(0, colon), name.substr(colon + 1)};
}

std::shared_ptr<const VolumeImage> load_named(Input& input, const std::string& name, Progress* progress,
                                              Resampling* resampling) {
  if (!input.names_field(name)) return load_file_field(name, progress);
  const std::string shown = input.spec().field;
  try {
    input.set_field(name);
    auto image = load_volume(input, progress, resampling);
    input.set_field(shown);
    return image;
  } catch (...) {
    input.set_field(shown);
    throw;
  }
}

}  // namespace

void check_file_field(const std::string& name, const std::string& option,
                      const std::vector<std::string>& known, const std::string& input) {
  if (file_field(name)) return;
  std::string list;
  for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
  throw usage_error(option + " '" + name + "' is no scalar of " + input + " and no file; known: " + list);
}

std::shared_ptr<const VolumeImage> load_file_field(const std::string& name, Progress* progress) {
  const std::optional<FileField> from = file_field(name);
  if (!from) throw input_error({name, "", "no such file", "a volume", ""});
  InputOptions options = input_of({from->file}, FieldKind::kScalar);
  options.field = from->scalar;
  Input input = Input::open(options, progress);
  return load_volume(input, progress);
}

std::vector<std::string> secondary_names(const std::vector<std::string>& shown,
                                         const std::vector<std::string>& secondary,
                                         const VolumeOptions& options,
                                         const std::function<void(const std::string&)>& check) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (name.empty() || std::find(shown.begin(), shown.end(), name) != shown.end()) return;
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    check(name);
    names.push_back(name);
  };
  for (const std::string& name : secondary) add(name);
  for (const std::string& text : options.lenses) add(parse_lens(text).field);
  if (names.size() >= kMostFields) {
    throw usage_error(std::to_string(names.size() + 1) + " fields are named; at most " +
                      std::to_string(kMostFields) + " are possible");
  }
  return names;
}

std::vector<std::string> secondary_names(const Input& input, const VolumeOptions& options) {
  return secondary_names({input.spec().field, input.field_label()}, input.spec().secondary, options,
                         [&input](const std::string& name) {
                           if (!input.names_field(name))
                             check_file_field(name, "field", input.fields(), input.title());
                         });
}

VolumeField volume_field(std::shared_ptr<const VolumeImage> image, std::string name) {
  auto window = Late<ValueWindow>::by([image] { return window_of_bulk(*image, 0); });
  return {.image = std::move(image), .name = std::move(name), .window = std::move(window)};
}

std::vector<VolumeField> load_secondary(Input& input, const VolumeOptions& options, Progress* progress,
                                        Resampling* resampling) {
  std::vector<VolumeField> fields;
  for (const std::string& name : secondary_names(input, options)) {
    fields.push_back(volume_field(load_named(input, name, progress, resampling), name));
  }
  return fields;
}

TangibleVolume load_seen_volume(Input& input, const VolumeOptions& options, Progress* progress,
                                Resampling* resampling) {
  return {.image = load_volume(input, progress, resampling),
          .field = nullptr,
          .secondary = load_secondary(input, options, progress, resampling)};
}

std::vector<Late<Lens>> lens_appearances(const VolumeView& volume, const std::string& focus, int threads) {
  std::vector<Late<Lens>> appearances;
  for (std::size_t field = 0; field <= volume.fields.size(); ++field) {
    Lens appearance;
    appearance.field = field;
    appearance.samples_per_voxel = volume.samples_per_voxel;
    appearance.shading = volume.shading;
    const std::shared_ptr<const VolumeImage>& image = image_of(volume, field);
    if (!focus.empty()) {  // which may be refused
      take_transfer(focus_transfer_of(focus, *image, threads), appearance);
      appearances.emplace_back(std::move(appearance));
      continue;
    }
    appearances.push_back(Late<Lens>::by([appearance, image, threads] {
      Lens lens = appearance;
      take_transfer(
          lens.field == 0 ? focus_transfer_of("", *image, threads) : volume_transfer_of("", *image, threads),
          lens);
      return lens;
    }));
  }
  return appearances;
}

void take_parts(VolumeView& volume, const VolumeOptions& options, const std::vector<Late<Lens>>& appearances,
                int threads) {
  VolumeParts parts = make_parts(options, appearances.front().get());
  volume.lenses = std::move(parts.lenses);
  volume.cuts = std::move(parts.cuts);
  for (std::size_t i = 0; i < volume.lenses.size(); ++i) {
    Lens& lens = volume.lenses[i];
    const auto found = std::find_if(volume.fields.begin(), volume.fields.end(),
                                    [&](const VolumeField& field) { return field.name == parts.fields[i]; });
    if (!lens.cut && found != volume.fields.end()) {
      lens.field = as_size(found - volume.fields.begin()) + 1;
      lens.transfer = appearances[lens.field].get().transfer;
      lens.regions = appearances[lens.field].get().regions;
    }
    if (parts.transfers[i].empty()) continue;
    take_transfer(volume_transfer_of(parts.transfers[i], *image_of(volume, lens.field), threads), lens);
    lens.own_transfer = true;
  }
  if (transfers_of(volume).size() > kMostTransfers) {
    throw usage_error("--lens: " + std::to_string(transfers_of(volume).size()) +
                      " transfer functions; at most " + std::to_string(kMostTransfers) + " are possible");
  }
}

}  // namespace palpate
