#include "common/compose/volume_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/read_as.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/domain_outline.h"
#include "common/compose/label_volume.h"
#include "common/compose/line_view.h"
#include "common/compose/text/lens_text.h"
#include "common/compose/text/plane_image_text.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/compose/volume_fields.h"
#include "common/field/grid/sparse/sparse_statistics.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/field/value_histogram.h"
#include "common/load/volume_block.h"
#include "common/render/volume/voxels/sign_bit.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "common/scene/volume_source.h"

namespace palpate {
namespace {

/// What was read, and the image that is made of it.
struct Voxels {
  std::vector<DataSet> blocks;
  ScalarChoice choice;
  std::string file;
  std::shared_ptr<const VolumeImage> image;
  std::shared_ptr<const ScalarField> field;  ///< of data that were resampled, on their own grid
};

/// Has `voxels` lie on an image, where it is asked for and where they have to.
void take_resampled(Voxels& voxels, Resampling& resampling, Progress* progress) {
  if (is_one_lattice(voxels.blocks) && resampling.asked.empty()) return;
  if (resampling.asked.empty()) resampling.asked = resampling.otherwise;
  if (resampling.asked.empty()) {
    throw input_error(
        {voxels.file, "", "is not one grid along straight axes", "an image, or a rectilinear grid",
         "--resample 128 takes its values at so many points along the longest edge, and says how far "
         "that is from them"});
  }
  if (progress) progress->begin("preparing the field", 0);
  voxels.field = make_scalar_field(voxels.blocks, voxels.choice, voxels.file, resampling.threads);
  const ScalarSampler sampler = [field = voxels.field](const Vec3& x, CellHint& hint) {
    return field->sample(x, hint);
  };
  const UniformTopology lattice =
      lattice_over(voxels.field->bounds(), resample_points(voxels.field->bounds(), resampling.asked));
  if (progress) progress->begin("taking " + voxels.field->name() + " on an image", 0);
  DataSet block = take_scalar(sampler, voxels.choice.array, lattice, resampling.threads, progress);
  resampling.taken.push_back(
      {voxels.field->name(), lattice.points, lattice_error(sampler, block, resampling.threads, progress)});
  voxels.blocks = {std::move(block)};
  voxels.choice = {.array = voxels.choice.array, .association = Association::kPoint, .component = 0};
}

Voxels read_voxels(Input& input, Progress* progress, Resampling* resampling) {
  Voxels voxels{.choice = input.scalar_choice()};
  voxels.file = input.spec().files.empty() ? input.title() : input.spec().files.front().string();
  if (progress) progress->begin("reading " + input.title(), 0);
  voxels.blocks = input.read_timed({voxels.choice.array}, progress);
  take_lattices(voxels.blocks);
  if (resampling != nullptr) take_resampled(voxels, *resampling, progress);
  voxels.image = make_volume_image(volume_source(voxels.blocks, voxels.choice, voxels.file),
                                   voxels.choice.array, voxels.file);
  const bool whole =
      voxels.choice.array == kColorArray && voxels.choice.component == ScalarChoice::kMagnitude;
  if (whole && voxels.blocks.size() == 1)
    voxels.image = with_own_colors(voxels.image, voxels.blocks.front().arrays.front());
  voxels.image = with_labels(voxels.image, input);
  return voxels;
}

ValueHistogram counted_between(const VolumeImage& image, double lower, double upper, int threads) {
  constexpr std::size_t kBins = 1024;
  if (image.sparse) {
    return count_values(
        *image.sparse, [&image](double number) { return image.offset + image.scale * number; }, lower, upper,
        kBins, threads);
  }
  return count_values(
      image.point_count(), [&image](std::size_t i) { return image.value(i); }, lower, upper, kBins, threads);
}

/// How often each number of 8 or 16 bits occurs, by its bits in memory.
template <typename T>
std::vector<std::uint64_t> number_counts(const VolumeImage& image, int threads) {
  constexpr std::size_t kNumbers = std::size_t{1} << (8 * sizeof(T));
  std::vector<std::uint64_t> counts(kNumbers, 0);
  std::mutex joining;
  parallel_for(image.point_count(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<std::uint64_t> own(kNumbers, 0);
    for (std::size_t i = first; i < last; ++i) ++own[read_as<T>(image.bytes, i)];
    const std::lock_guard lock(joining);
    for (std::size_t n = 0; n < kNumbers; ++n) counts[n] += own[n];
  });
  return counts;
}

/// Counts the values between two bounds.
using CountBetween = std::function<ValueHistogram(double lower, double upper)>;

/// Of numbers of which there are few: the voxels are gone through once, whatever the bounds.
template <typename T>
CountBetween counter_of_numbers(const VolumeImage& image, int threads) {
  return [&image, counts = number_counts<T>(image, threads)](double lower, double upper) {
    constexpr std::size_t kBins = 1024;
    ValueHistogram histogram{.lower = lower, .upper = upper, .counts = std::vector<std::uint64_t>(kBins, 0)};
    const HistogramBins bins(lower, upper, kBins);
    for (std::size_t bits = 0; bits < counts.size(); ++bits) {
      const auto number = static_cast<T>(static_cast<T>(bits) ^ sign_bit<T>(image));
      const auto bin = bins.of(image.offset + image.scale * static_cast<double>(number));
      if (!bin) continue;
      histogram.counts[*bin] += counts[bits];
      histogram.total += counts[bits];
    }
    return histogram;
  };
}

/// @pre the image outlives what is returned.
CountBetween counter_of(const VolumeImage& image, int threads) {
  if (!image.sparse && image.type == ScalarType::kUint8)
    return counter_of_numbers<std::uint8_t>(image, threads);
  if (!image.sparse && image.type == ScalarType::kUint16)
    return counter_of_numbers<std::uint16_t>(image, threads);
  return
      [&image, threads](double lower, double upper) { return counted_between(image, lower, upper, threads); };
}

/// Where all values lie but a few far ones.
ValueHistogram histogram_of(const VolumeImage& image, int threads) {
  return bulk_histogram(counter_of(image, threads), image.lowest, image.highest);
}

/// The preset for densities from `lower` to the value that only the brightest of those from `threshold` on
/// pass.
ColorTransfer density_from(const ValueHistogram& histogram, double lower, double threshold) {
  constexpr double kBrightest = 0.995;
  const double upper = std::max(lower, value_below_which(histogram, kBrightest, threshold));
  return make_color_transfer(ColorPreset::kDensity, lower, upper);
}

/// None for another word.
std::optional<ColorPreset> preset_of(const std::string& name) {
  for (int i = 0; i < kColorPresetCount; ++i) {
    const auto preset = static_cast<ColorPreset>(i);
    if (name == name_of(preset)) return preset;
  }
  return std::nullopt;
}

[[noreturn]] void refuse_transfer(const std::string& name) {
  throw usage_error("unknown transfer function '" + name + "'; known: density, mr, ct, " + kBoundariesPreset +
                    ", or a file");
}

VolumeTransfer named_transfer(const std::string& name, const VolumeImage& image, int threads) {
  const DataRange range = [&] { return place_range(image, threads); };
  if (auto transfer = transfer_from_text(name)) return {*transfer, {}};
  if (auto regions = regions_from_text(name, range)) return {{}, std::move(regions)};
  if (name == kBoundariesPreset) return {{}, spread(boundary_regions(), range())};
  const bool values = image.lowest <= image.highest;
  const double lower = values ? image.lowest : 0.0;
  const double upper = values ? image.highest : 0.0;
  // Whatever lies about in the current folder under that name.
  if (const auto preset = preset_of(name)) return {make_color_transfer(*preset, lower, upper), {}};
  std::error_code ignored;
  if (std::filesystem::exists(name, ignored)) {
    if (is_region_file(name)) return {{}, read_regions(name, range)};
    return {read_color_transfer(name, lower, upper), {}};
  }
  refuse_transfer(name);
}

/// Whether the preset of Hounsfield units shows something: where all is air, it does not.
bool shows_tissue(const VolumeImage& image) {
  return !image.labels && make_color_transfer(ColorPreset::kCt, 0.0, 0.0).at(image.highest).opacity > 0.0;
}

void check_transfer(const std::string& name) {
  std::error_code ignored;
  const auto any_range = [] { return PlaceRange{{0.0, 0.0}, {1.0, 1.0}}; };
  if (name.empty() || name == kBoundariesPreset || preset_of(name) || transfer_from_text(name) ||
      regions_from_text(name, any_range) || std::filesystem::exists(name, ignored))
    return;
  // A word is a preset; what looks like a path was meant as one.
  if (name.find_first_of("./") != std::string::npos)
    throw input_error({name, "", "no such file", "a transfer function", ""});
  refuse_transfer(name);
}

}  // namespace

ValueWindow window_of_bulk(const VolumeImage& image, int threads) {
  if (!(image.lowest <= image.highest)) return {};
  const ValueHistogram bulk = histogram_of(image, threads);
  double lower = image.lowest, upper = image.highest;
  if (image.sparse) {
    lower = bulk.lower, upper = bulk.upper;
  } else if (lower < bulk.lower || bulk.upper < upper) {
    // Its ends are those of bins, up to 256 times as far apart as the values are.
    lower = HUGE_VAL, upper = -HUGE_VAL;
    std::mutex joining;
    parallel_for(image.point_count(), threads, [&](std::size_t first, std::size_t last) {
      double least = HUGE_VAL, most = -HUGE_VAL;
      for (std::size_t i = first; i < last; ++i) {
        const double value = image.value(i);
        if (!(value >= bulk.lower && value <= bulk.upper)) continue;
        least = std::min(least, value), most = std::max(most, value);
      }
      const std::lock_guard lock(joining);
      lower = std::min(lower, least), upper = std::max(upper, most);
    });
  }
  return {.width = lower < upper ? upper - lower : 1.0, .level = 0.5 * lower + 0.5 * upper};
}

ColorTransfer default_color_transfer(const VolumeImage& image, int threads) {
  if (image.lowest > image.highest) return {};  // no value is finite: nothing to be seen
  if (image.labels) return label_transfer(image);
  const ValueHistogram histogram = histogram_of(image, threads);
  const double threshold = otsu_threshold(histogram);
  // From halfway up to the threshold on, so that what lies just above it is not lost.
  return density_from(histogram, 0.5 * mean_below(histogram, threshold) + 0.5 * threshold, threshold);
}

ColorTransfer default_focus_transfer(const VolumeImage& image, int threads) {
  if (image.lowest > image.highest) return {};
  if (image.labels) return label_transfer(image);
  const CountBetween count = counter_of(image, threads);
  const ValueHistogram all = bulk_histogram(count, image.lowest, image.highest);
  const double threshold = otsu_threshold(all);
  const ValueHistogram dense = count(threshold, all.upper);
  const double denser = otsu_threshold(dense);
  return density_from(dense, denser, denser);
}

void take_transfer(VolumeTransfer transfer, Lens& lens) {
  lens.regions = std::move(transfer.regions);
  lens.transfer.reset();
  if (!lens.regions) lens.transfer = std::move(transfer.colors);
}

VolumeTransfer volume_transfer_of(const std::string& name, const VolumeImage& image, int threads) {
  if (name.empty()) return {default_color_transfer(image, threads), {}};
  return named_transfer(name, image, threads);
}

VolumeTransfer focus_transfer_of(const std::string& name, const VolumeImage& image, int threads) {
  if (name.empty()) return {default_focus_transfer(image, threads), {}};
  return named_transfer(name, image, threads);
}

void check_volume_options(const VolumeOptions& options) {
  constexpr double kMostSamples = 64.0;
  if (!(options.samples > 0.0 && options.samples <= kMostSamples))
    throw usage_error("--samples: a number above 0 and at most 64 is expected");
  constexpr double kSmallest = 0.05;
  if (!(options.context_viewport >= kSmallest && options.context_viewport <= 1.0))
    throw usage_error("--context-viewport: a number from 0.05 to 1 is expected");
  if (options.context_level < 0 || options.context_level > kCoarsestLevel)
    throw usage_error("--context-level: a whole number from 0 to " + std::to_string(kCoarsestLevel) +
                      " is expected");
  check_resample(options.resample);
  check_transfer(options.transfer);
  check_transfer(options.focus);
  for (const std::string& transfer : make_parts(options).transfers) check_transfer(transfer);
  (void)plane_images_of(options);
}

std::string color_note(const VolumeImage& image) {
  return image.colors && !image.labels ? std::string(kOwnColorsNote) : label_note(image);
}

std::shared_ptr<const VolumeImage> with_own_colors(std::shared_ptr<const VolumeImage> image,
                                                   const DataArray& colors) {
  const bool are_colors = colors.type == ScalarType::kUint8 && colors.components >= 3 &&
                          colors.components <= 4 && colors.tuples == image->point_count();
  if (!are_colors) return image;
  auto own = std::make_shared<std::vector<std::array<std::uint8_t, 4>>>(colors.tuples);
  const auto components = as_size(colors.components);
  for (std::size_t i = 0; i < colors.tuples; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      (*own)[i][c] = std::to_integer<std::uint8_t>(colors.bytes[components * i + c]);
  }
  auto colored = std::make_shared<VolumeImage>(*image);
  colored->colors = std::move(own);
  return colored;
}

std::vector<std::string> Resampling::notes() const {
  std::vector<std::string> out;
  for (const TakenScalar& one : taken) out.push_back(taken_text(one));
  return out;
}

std::shared_ptr<const VolumeImage> load_volume(Input& input, Progress* progress, Resampling* resampling) {
  return read_voxels(input, progress, resampling).image;
}

DataSet load_volume_block(Input& input, Progress* progress, Resampling* resampling) {
  const Voxels voxels = read_voxels(input, progress, resampling);  // which refuses what is no volume
  DataSet block = volume_source(voxels.blocks, voxels.choice, voxels.file);
  if (block.visible.empty()) return block;
  const DataArray& array = block.arrays.front();
  std::vector<double> values(array.tuples);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = block.visible[i] != 0 ? array.at(i) : std::numeric_limits<double>::quiet_NaN();
  }
  block.arrays = {make_array(array.name, Association::kPoint, 1, values)};
  block.visible.clear();
  return block;
}

TangibleVolume load_tangible_volume(Input& input, int threads, Progress* progress, Resampling* resampling) {
  const Voxels voxels = read_voxels(input, progress, resampling);
  TangibleVolume volume{.image = voxels.image};
  const Index3& n = voxels.image->points;
  if (std::min({n.x, n.y, n.z}) < 2) return volume;
  volume.field = voxels.field;
  if (volume.field) return volume;
  if (progress) progress->begin("preparing the field", 0);
  volume.field = make_scalar_field(voxels.blocks, voxels.choice, voxels.file, threads);
  return volume;
}

ImageSpace space_of(const Input& input) {
  const FileInfo* file = input.file();
  return file != nullptr && file->anatomical ? ImageSpace::kPatient : ImageSpace::kUnknown;
}

std::optional<ValueWindow> stated_window(const Input& input) {
  const FileInfo* const file = input.file();
  if (file == nullptr || !file->window) return std::nullopt;
  const auto& [black, white] = *file->window;
  if (!(black < white)) return std::nullopt;
  return ValueWindow{white - black, 0.5 * (black + white)};
}

Projection projection_of(const VolumeOptions& options) {
  return options.projection == "orthographic" ? Projection::kOrthographic : Projection::kPerspective;
}

VolumeView make_volume_view(const TangibleVolume& shown, const Document& options) {
  const std::shared_ptr<const VolumeImage>& image = shown.image;
  VolumeView volume;
  volume.image = image;
  volume.fields = shown.secondary;
  volume.shown = options.volume.shown;
  volume.colored = image->colors != nullptr;
  VolumeTransfer transfer = volume_transfer_of(options.volume.transfer, *image, options.common.threads);
  volume.transfer = std::move(transfer.colors);
  volume.regions = std::move(transfer.regions);
  volume.samples_per_voxel = options.volume.samples;
  volume.far_sampling = options.volume.far_sampling;
  volume.context.viewport = options.volume.context_viewport;
  volume.context.level = options.volume.context_level;
  const auto maker = std::ranges::find(kTableMakerNames, options.volume.tables);
  PALPATE_CHECK(maker != kTableMakerNames.end());
  volume.table_maker = static_cast<TableMaker>(maker - kTableMakerNames.begin());
  volume.storage.memory = static_cast<std::uint64_t>(std::ldexp(options.volume.gpu_memory, 20));
  volume.shading = options.volume.shading;
  volume.shadows = options.volume.shadows;
  volume.illustrated = options.volume.illustration;
  volume.context_fade = options.volume.context_fade;
  if (!options.volume.lenses.empty() || !options.volume.clips.empty()) {
    const std::vector<Late<Lens>> appearances =
        lens_appearances(volume, options.volume.focus, options.common.threads);
    take_parts(volume, options.volume, appearances, options.common.threads);
    for (Lens& lens : volume.lenses) lens.colored = volume.colored && !lens.cut && lens.field == 0;
  }
  volume.planes = plane_images_of(options.volume);
  volume.panes = slice_panes_of(options.panes, image->bounds());
  const bool asked =
      volume.planes.shown || options.volume.window || options.volume.level || volume.panes.layout > 1;
  if (asked && !volume.planes.window && image->lowest <= image->highest)
    complete_window(volume.planes, options.volume, histogram_of(*image, options.common.threads));
  return volume;
}

bool values_in_hounsfield(const Input& input) {
  const FileInfo* const file = input.file();
  return file != nullptr && file->units.ends_with("values in HU");
}

SceneView make_volume_scene(const Input& input, const TangibleVolume& shown, const Document& options,
                            double aspect) {
  const std::shared_ptr<const VolumeImage>& image = shown.image;
  SceneView view;
  view.bounds = image->bounds();
  view.outline = image_outline(image->origin, image->axes, image->lower(), image->upper());
  view.title = input.title();
  const FileInfo* file = input.file();
  view.anatomical = file != nullptr && file->anatomical;
  view.volume_label = input.field_label();
  view.subtitle = view.volume_label + ", " + std::to_string(image->points.x) + " x " +
                  std::to_string(image->points.y) + " x " + std::to_string(image->points.z) + " voxels";
  if (input.times().size() > 1) view.subtitle += ", time " + short_number(input.times()[input.time().step]);
  view.camera = camera_of(options.view, view.bounds, aspect, projection_of(options.volume));
  apply_appearance(options, view);
  Document stated = options;
  if (const auto window = stated_window(input); window && !options.volume.window && !options.volume.level) {
    stated.volume.window = window->width;
    stated.volume.level = window->level;
  }
  if (stated.volume.transfer.empty() && values_in_hounsfield(input) && shows_tissue(*image))
    stated.volume.transfer = name_of(ColorPreset::kCt);
  view.volume = make_volume_view(shown, stated);
  return view;
}

}  // namespace palpate
