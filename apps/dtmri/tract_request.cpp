#include "apps/dtmri/tract_request.h"

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "apps/dtmri/bundle_text.h"
#include "apps/dtmri/region_text.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/read_tractogram.h"
#include "common/render/tract/tract_bundle.h"
#include "common/scene/seeds.h"
#include "common/scene/tensor/tensor_spec.h"
#include "common/scene/tensor/voxel_seeds.h"
#include "common/trace/tract/tract_orientation.h"

namespace palpate {
namespace {

constexpr const char* kRegionGrammar =
    "a region is mask:FILE, sphere:x,y,z,r, box:x,y,z,x,y,z, beyond:nx,ny,nz,d or brush:r,x,y,z,x,y,z,…";
constexpr const char* kSeedGrammar =
    "seeds are file.csv, file.vtp, point:x,y,z, line:x,y,z,x,y,z,n, plane:…, grid:nx,ny,nz, random:n, fa:T, "
    "cl:T, or a region (mask:, sphere:, box:, beyond:, brush:); peaks: before any of them";
constexpr std::size_t kMostSeeds = 100'000'000;

/// What stands behind "kind:", or empty where `text` is of another kind.
std::string_view after(std::string_view text, std::string_view kind) {
  return text.starts_with(kind) ? text.substr(kind.size()) : std::string_view();
}

/// Refuses a mask beside `image`, and says what it may have to be asked about.
void check_mask(const MaskFile& mask, const UniformTopology& image, std::vector<std::string>& notes) {
  check_overlap(mask, image);
  notes.insert(notes.end(), mask.notes.begin(), mask.notes.end());
  const std::size_t size = mask.mask->size(), beyond = size - mask.mask->size_in(image);
  if (beyond > 0) {
    notes.push_back(mask.file + ": " + counted(beyond, "voxel") + " of the mask's " + std::to_string(size) +
                    " lie outside the image");
  }
}

/// @throws Error (usage) where an image has no voxels of its own, such as a mesh.
const UniformTopology& voxels_of(const DataSet& image, const std::string& seeds) {
  const auto* const voxels = std::get_if<UniformTopology>(&image.topology);
  if (voxels == nullptr) throw usage_error("--seeds " + seeds + ": the file holds no image of equal voxels");
  return *voxels;
}

/// Whether the measure is above `least` at a place.
std::function<bool(const Vec3&)> above(const TensorField& field, TractMeasure measure, double least) {
  return
      [&field, measure, least, scale = power_of_two(-binary_exponent(field.largest_trace()))](const Vec3& x) {
        CellHint hint;
        const TensorSample sample = field.sample(x, hint);
        if (sample.status != SampleStatus::kOk) return false;
        const Mat3 d = sample.value * scale;
        return measure_of(measure, {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]}) >= least;
      };
}

TractSense sense_from_name(const std::string& name) {
  if (name == "both") return TractSense::kBoth;
  if (name == "forward") return TractSense::kForward;
  if (name == "backward") return TractSense::kBackward;
  throw usage_error("--direction " + name + ": both, forward, backward are known");
}

/// At (i + 1/2) / n of what lies between the outer centres of voxels, along the image's axes; x fastest.
std::vector<Vec3> grid_seeds(const Index3& n, const UniformTopology& image) {
  std::vector<Vec3> seeds;
  const Vec3 reach = Vec3(image.points) - 1.0;
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i)
        seeds.push_back(image.origin + image.axes * (reach * (Vec3(i, j, k) + 0.5) / Vec3(n)));
    }
  }
  return seeds;
}

/// Uniform between the outer centres of voxels. The same for the same `random_seed` and image.
std::vector<Vec3> random_seeds(std::size_t count, const UniformTopology& image, std::uint64_t random_seed) {
  std::mt19937_64 random{random_seed};
  std::vector<Vec3> seeds;
  for (std::size_t s = 0; s < count; ++s) {
    Vec3 index{0.0};
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = static_cast<double>(random() >> 11U) * 0x1p-53 * (image.points[axis] - 1);
    seeds.push_back(image.origin + image.axes * index);
  }
  return seeds;
}

}  // namespace

std::vector<TractRegion> read_regions(const std::vector<std::string>& texts, const std::string& option,
                                      bool left_handed, std::vector<MaskFile>& masks, Progress* progress) {
  std::vector<TractRegion> regions;
  for (const std::string& text : texts) {
    std::string refusal = option;
    refusal.append(" ").append(text).append(": ").append(kRegionGrammar);
    const RegionShape shape = parse_region(text, refusal);
    if (const auto* const file = std::get_if<std::string>(&shape)) {
      masks.push_back(read_mask(*file, progress, left_handed));
      regions.emplace_back(masks.back().mask);
    } else {
      regions.push_back(tract_region(shape));
    }
  }
  return regions;
}

void check_view_tracts(const TractTracingOptions& options, const TractAppearance& appearance) {
  if (!appearance.file.empty() && !options.seeds.empty())
    throw usage_error("give either --tracts, a file, or --seeds, to trace some; not both");
  for (const std::string& text : appearance.bundles) (void)parse_bundle(text);
  // Regions name files, which are read when they are needed.
  TractTracingOptions numbers = options;
  numbers.include.clear();
  numbers.exclude.clear();
  numbers.stop.clear();
  (void)tract_request(numbers, false, 1);
}

ViewTracts read_view_tracts(const TractAppearance& appearance, const TensorField* field, int threads,
                            Progress* progress) {
  TractogramFile file = read_tractogram(appearance.file, progress);
  ViewTracts tracts;
  tracts.bundle = make_tract_bundle(std::make_shared<const Tractogram>(std::move(file.lines)));
  if (tracts.bundle->order.empty())
    throw input_error({appearance.file, "", "holds no line of two points and more", "tracts", ""});
  tracts.left_out = tracts_left_out(*tracts.bundle);
  tracts.notes = file.info.notes;
  if (field != nullptr && field->voxels()) {
    const TractFit fit = fit_of_tracts(*field, *tracts.bundle->lines, threads);
    if (fit.suspicious || fit.strays()) tracts.notes.push_back(fit_sentence(fit, "dtmri tracts --turn"));
  }
  for (std::string& note : tracts.notes) note.insert(0, appearance.file + ": ");
  return tracts;
}

ViewTracts trace_view_tracts(const Document& document, const TensorVoxels& voxels, const DataArray* cones,
                             Progress* progress) {
  const TractTracingOptions& options = document.tracts;
  const bool left_handed = parse_tensor_spec(document.input.tensor).left_handed;
  TractRequest request = tract_request(options, left_handed, document.common.threads, progress);
  const TractOptions& how = request.options;
  // Seeds are laid over the voxels; what these hold is asked of the field.
  DataSet lattice;
  lattice.topology = UniformTopology{voxels.points, voxels.origin, voxels.axes};
  std::vector<std::string> notes = check_regions(request, lattice);
  std::vector<Vec3> seeds =
      tract_seeds(options, left_handed, document.common.seed, *voxels.field, lattice, notes, progress);
  stop_where_unsure(options, std::get<UniformTopology>(lattice.topology), cones, request, seeds, notes);
  TractResult result = trace_tracts(*voxels.field, seeds, how, progress);
  ViewTracts tracts;
  tracts.seeds = seeds.size();
  tracts.seconds = result.seconds;
  tracts.notes = std::move(notes);
  if (result.lines.line_count() == 0) tracts.why_none = why_no_tract(result, how);
  tracts.bundle = make_tract_bundle(std::make_shared<const Tractogram>(std::move(result.lines)));
  tracts.left_out = tracts_left_out(*tracts.bundle);
  return tracts;
}

void stop_where_unsure(const TractTracingOptions& options, const UniformTopology& image,
                       const DataArray* cones, TractRequest& request, std::vector<Vec3>& seeds,
                       std::vector<std::string>& notes) {
  if (!options.max_cone) return;
  if (cones == nullptr)
    throw usage_error(
        "--max-cone: how sure directions are follows from a fit: it needs the diffusion-weighted volumes, not tensors");
  std::vector<float> unsure(cones->tuples);
  std::size_t unknown = 0;
  for (std::size_t p = 0; p < unsure.size(); ++p) {
    const double cone = cones->at(p);
    unsure[p] = cone > *options.max_cone ? 1.0F : 0.0F;
    unknown += std::isnan(cone) ? 1 : 0;
  }
  if (unknown == unsure.size())
    throw usage_error(
        "--max-cone: seven volumes determine a tensor and nothing of its noise: no cone is known, more are needed");
  const auto mask = std::make_shared<const VoxelMask>(
      image, make_array("unsure", Association::kPoint, 1, std::move(unsure)));
  request.options.stop.emplace_back(mask);
  const std::size_t left_out = std::erase_if(seeds, [&](const Vec3& x) { return mask->contains(x); });
  if (left_out > 0)
    notes.push_back(counted(left_out, "seed") + " left out where the cone is wider than --max-cone " +
                    short_number(*options.max_cone));
}

TractRequest tract_request(const TractTracingOptions& options, bool left_handed, int threads,
                           Progress* progress) {
  TractRequest request;
  TractOptions& tracts = request.options;
  tracts.integrator = integrator_from_name(options.integrator);
  tracts.tolerance = options.tolerance;
  tracts.step = options.step;
  tracts.measure = tract_measure_from_name(options.measure);
  tracts.cutoff = options.cutoff;
  tracts.max_angle = options.max_angle;
  tracts.min_radius = options.min_radius;
  tracts.min_length = options.min_length;
  tracts.max_length = options.max_length;
  tracts.sense = sense_from_name(options.direction);
  tracts.max_steps = options.max_steps;
  tracts.every_peak = from_every_peak(options.seeds);
  check_tract_options(tracts);
  tracts.include = read_regions(options.include, "--include", left_handed, request.masks, progress);
  tracts.exclude = read_regions(options.exclude, "--exclude", left_handed, request.masks, progress);
  tracts.stop = read_regions(options.stop, "--stop", left_handed, request.masks, progress);
  tracts.threads = threads;
  return request;
}

std::vector<std::string> check_regions(const TractRequest& request, const DataSet& image) {
  std::vector<std::string> notes;
  const auto* const voxels = std::get_if<UniformTopology>(&image.topology);
  for (const MaskFile& mask : request.masks) {
    if (voxels != nullptr) check_mask(mask, *voxels, notes);
  }
  return notes;
}

std::string why_no_tract(const TractResult& result, const TractOptions& options) {
  const TractsDropped& d = result.dropped;
  std::string why;
  const auto add = [&why](std::size_t count, const std::string& what) {
    if (count > 0) why += (why.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(d.outside, "seeds outside the image");
  add(d.bad_data, "seeds without a tensor");
  add(d.below_cutoff, "seeds where " + std::string(name_of(options.measure)) + " is below --cutoff " +
                          short_number(options.cutoff));
  add(d.too_short, "lines shorter than --min-length");
  add(d.not_included, "lines that miss an --include region");
  add(d.excluded, "lines that enter an --exclude region");
  return why;
}

std::vector<Vec3> tract_seeds(const TractTracingOptions& options, bool left_handed, std::uint64_t random_seed,
                              const TensorField& field, const DataSet& image, std::vector<std::string>& notes,
                              Progress* progress) {
  const std::string text(seed_places(options.seeds));
  if (from_every_peak(options.seeds) && field.peaks() == nullptr)
    throw usage_error("--seeds " + options.seeds +
                      ": the image has one direction a voxel, no peaks: leave \"peaks:\" out");
  const auto seeds_in = [&](const UniformTopology& voxels, const std::function<bool(const Vec3&)>& wanted) {
    auto seeds = voxel_seeds(voxels, wanted, options.seeds_per_voxel, random_seed, kMostSeeds);
    if (seeds.empty()) throw usage_error("--seeds " + text + ": takes no voxel");
    return seeds;
  };
  for (const auto& [kind, measure] :
       {std::pair{"fa:", TractMeasure::kFa}, std::pair{"cl:", TractMeasure::kLinear}}) {
    const auto number = after(text, kind);
    if (number.empty()) continue;
    const double least = parse_numbers(number, 1, "--seeds " + text + ": " + kSeedGrammar)[0];
    return seeds_in(voxels_of(image, text), above(field, measure, least));
  }
  if (is_region(text) && !text.starts_with("mask:")) {
    const TractRegion region = tract_region(parse_region(text, "--seeds " + text + ": " + kSeedGrammar));
    return seeds_in(voxels_of(image, text), [&](const Vec3& x) { return region.contains(x); });
  }
  if (const auto file = after(text, "mask:"); !file.empty()) {
    const MaskFile mask = read_mask(file, progress, left_handed);
    if (const auto* const voxels = std::get_if<UniformTopology>(&image.topology))
      check_mask(mask, *voxels, notes);
    return seeds_in(mask.mask->voxels(), [&](const Vec3& x) { return mask.mask->contains(x); });
  }
  const SeedSpec spec = parse_seeds(text, kSeedGrammar);
  if (seed_count(spec) > kMostSeeds)
    throw usage_error("--seeds " + text + ": more than " + std::to_string(kMostSeeds) + " seeds");
  if (const auto* const list = std::get_if<SeedList>(&spec)) return list->points;
  if (const auto* const grid = std::get_if<SeedGrid>(&spec))
    return grid_seeds(grid->n, voxels_of(image, text));
  const SeedRandom& drawn = std::get<SeedRandom>(spec);
  if (drawn.by_speed) throw usage_error("--seeds " + text + ": " + kSeedGrammar);
  return random_seeds(drawn.count, voxels_of(image, text), random_seed);
}

}  // namespace palpate
