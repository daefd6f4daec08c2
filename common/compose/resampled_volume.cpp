#include "common/compose/resampled_volume.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/compose/line_color.h"
#include "common/compose/volume_fields.h"
#include "common/field/field_grid.h"
#include "common/field/grid/lattice_lines.h"
#include "common/scene/volume_source.h"

namespace palpate {
namespace {

constexpr const char* kSpeed = "speed";

std::string file_of(const Input& input) {
  return input.spec().files.empty() ? input.title() : input.spec().files.front().string();
}

std::optional<ScalarChoice> array_of(const Input& input, const std::string& name) {
  for (const ScalarChoice& choice : scalar_choices(input.arrays())) {
    const bool whole = choice.component == ScalarChoice::kMagnitude && name == choice.array;
    if (whole || name == label_of(choice, input.arrays())) return choice;
  }
  return std::nullopt;
}

bool is_derived(const std::string& name) { return name == kSpeed || measure_of(name).has_value(); }

/// The grid of an image or a rectilinear one, in the order of the field's own points; nothing for another grid.
std::optional<UnevenLattice> own_lattice(const VectorField& field) {
  const BoxGrid* const grid = field.box_grid();
  if (grid == nullptr) return std::nullopt;
  UnevenLattice lattice;
  if (!grid->uniform()) {
    RectilinearTopology lines;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < grid->points()[axis]; ++i)
        lines.coordinates[as_size(axis)].push_back(grid->coordinate(axis, i));
    }
    lattice.lines = uneven_lattice(lines).lines;
  }
  const LocalFrame& frame = field.frame();
  const Box box = grid->bounds();
  lattice.mean.points = grid->points();
  lattice.mean.origin = frame.data_from_local(grid->in_frame(box.lower));
  const Vec3 step = box.size() / Vec3(lattice.mean.points - 1);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 along{0.0};
    along[axis] = step[axis];
    lattice.mean.axes[axis] = frame.data_from_local(grid->in_frame(along));
  }
  return lattice;
}

/// `sampler` at the points of the lattice, asked for at those of its mean one.
ScalarSampler at_lines(ScalarSampler sampler, const UnevenLattice& lattice) {
  if (!lattice.lines) return sampler;
  return [sampler = std::move(sampler), lattice, back = glm::inverse(lattice.mean.axes)](const Vec3& x,
                                                                                         CellHint& hint) {
    const UniformTopology& mean = lattice.mean;
    return sampler(mean.origin + mean.axes * lattice.lines->mean(back * (x - mean.origin)), hint);
  };
}

/// An array on an image or a rectilinear grid, in the type of its file.
std::shared_ptr<const VolumeImage> own_voxels(Input& input, const ScalarChoice& choice, Progress* progress) {
  if (progress) progress->begin("reading " + choice.array, 0);
  return make_volume_image(volume_source(input.read({choice.array}, progress), choice, file_of(input)),
                           choice.array, file_of(input));
}

UnevenLattice lattice_for(const VectorField& field, const std::string& name, const std::string& resample) {
  if (!resample.empty())
    return {lattice_over(field.bounds(), resample_points(field.bounds(), resample)), nullptr};
  if (const std::optional<UnevenLattice> own = own_lattice(field)) return *own;
  throw usage_error("--volume " + name +
                    ": the data lies on no grid along straight axes; --resample 128 draws it from a grid "
                    "of 128 points along its longest edge, and says how far that is from it");
}

}  // namespace

std::vector<std::string> flow_scalars(const Input& input) {
  std::vector<std::string> names{kSpeed};
  for (const std::string& measure : measure_names()) names.push_back(measure);
  for (const ScalarChoice& choice : scalar_choices(input.arrays())) {
    const std::string label = label_of(choice, input.arrays());
    if (std::find(names.begin(), names.end(), label) == names.end()) names.push_back(label);
  }
  return names;
}

bool needs_resampling(const VectorField& field) { return field.box_grid() == nullptr; }

std::vector<std::string> flow_volume_names(const Input& input, const VolumeOptions& options) {
  std::vector<std::string> asked;
  for (const std::string_view part : split(options.scalar, ',')) asked.emplace_back(part);
  if (options.scalar.empty()) return {};
  const std::vector<std::string> shown{asked.front()};
  const auto check = [&input](const std::string& name) {
    if (is_derived(name) || array_of(input, name)) return;
    check_file_field(name, "--volume", flow_scalars(input), input.title());
  };
  check(asked.front());
  std::vector<std::string> names = shown;
  for (std::string& name : secondary_names(shown, {asked.begin() + 1, asked.end()}, options, check))
    names.push_back(std::move(name));
  return names;
}

std::vector<std::string> flow_volume_arrays(const Input& input, const VolumeOptions& options) {
  std::vector<std::string> arrays;
  for (const std::string& name : flow_volume_names(input, options)) {
    if (is_derived(name)) continue;
    if (const auto choice = array_of(input, name)) arrays.push_back(choice->array);
  }
  return arrays;
}

void check_flow_volume(const VolumeOptions& options) {
  check_volume_options(options);
  if (!options.scalar.empty()) return;
  const char* const said = !options.lenses.empty()     ? "--lens"
                           : !options.clips.empty()    ? "--clip"
                           : !options.resample.empty() ? "--resample"
                           : !options.transfer.empty() ? "--transfer-function"
                                                       : nullptr;
  if (said != nullptr)
    throw usage_error(std::string(said) + ": there is no volume; --volume speed shows that of the flow");
}

ScalarSampler flow_sampler(const std::string& name, Input& input,
                           const std::shared_ptr<const VectorField>& field, int threads, Progress* progress) {
  if (const std::optional<Measure> measure = measure_of(name)) {
    return
        [field, measure](const Vec3& x, CellHint& hint) { return sample_measure(*field, *measure, x, hint); };
  }
  std::shared_ptr<const ScalarField> scalar;
  if (name == kSpeed) {
    scalar = make_speed_field(field);
  } else {
    const ScalarChoice choice = *array_of(input, name);
    if (progress) progress->begin("reading " + name, 0);
    scalar = make_scalar_field(*field, input.read({choice.array}, progress), choice, file_of(input), threads);
  }
  return [scalar](const Vec3& x, CellHint& hint) { return scalar->sample(x, hint); };
}

FlowVolume load_flow_volume(Input& input, const std::shared_ptr<const VectorField>& field,
                            const std::vector<std::string>& names, const std::string& resample, int threads,
                            Progress* progress) {
  FlowVolume volume;
  for (const std::string& name : names) {
    std::shared_ptr<const VolumeImage> image;
    const std::optional<ScalarChoice> array = is_derived(name) ? std::nullopt : array_of(input, name);
    if (!is_derived(name) && !array) {
      image = load_file_field(name, progress);
    } else if (array && resample.empty() && !needs_resampling(*field)) {
      image = own_voxels(input, *array, progress);
    } else {
      const UnevenLattice lattice = lattice_for(*field, name, resample);
      const ScalarSampler sampler = at_lines(flow_sampler(name, input, field, threads, progress), lattice);
      const DataSet block = take_scalar(sampler, name, lattice.mean, threads, progress);
      volume.taken.push_back({name, lattice.mean.points, lattice_error(sampler, block, threads, progress)});
      auto taken = std::make_shared<VolumeImage>(*make_volume_image(block, name, input.title()));
      taken->lines = lattice.lines;
      image = std::move(taken);
    }
    if (name == names.front()) {
      volume.voxels.image = std::move(image);
    } else {
      volume.voxels.secondary.push_back(volume_field(std::move(image), name));
    }
  }
  return volume;
}

}  // namespace palpate
