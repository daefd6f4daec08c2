#include "library/palpate/tensors.h"

#include <cmath>
#include <utility>
#include <variant>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/write/write_lines.h"
#include "common/load/write/write_tractogram.h"
#include "common/scene/tensor/fit_image.h"
#include "common/scene/tensor/tensor_image.h"
#include "common/trace/tract/trace_tracts.h"
#include "library/access.h"

namespace palpate::api {

struct TensorData {
  DataSet image;
  TensorChoice choice;
  VoxelGrid grid;
  std::vector<float> values;  ///< xx xy xz yy yz zz
  std::vector<std::string> notes;
  std::shared_ptr<const TensorField> field;
};

struct TractData {
  TractResult result;
  std::vector<std::array<float, 3>> points;
  std::vector<std::array<std::uint8_t, 2>> ends;
  std::vector<std::string> notes;
};

namespace {

VoxelGrid grid_of(const UniformTopology& image) {
  VoxelGrid grid;
  for (int k = 0; k < 3; ++k) {
    grid.voxels[as_size(k)] = image.points[k];
    grid.axes[as_size(k)] = point_of(image.axes[k]);
  }
  grid.origin = point_of(image.origin);
  return grid;
}

UniformTopology topology_of(const VoxelGrid& grid) {
  UniformTopology image;
  for (int k = 0; k < 3; ++k) {
    image.points[k] = grid.voxels[as_size(k)];
    image.axes[k] = vec_of(grid.axes[as_size(k)]);
  }
  image.origin = vec_of(grid.origin);
  return image;
}

/// Six numbers a voxel, whatever the order in which the image has them.
std::vector<float> six_of(const DataSet& image, const TensorChoice& choice) {
  const DataArray& array = *image.find(choice.array, Association::kPoint);
  std::vector<float> six;
  six.reserve(6 * array.tuples);
  for (std::size_t p = 0; p < array.tuples; ++p) {
    for (const double number : read_tensor(array, p, choice.order)) six.push_back(static_cast<float>(number));
  }
  return six;
}

std::shared_ptr<const TensorData> data_of(TensorImage made, const std::string& title, int threads) {
  TensorData data;
  const auto* const image = std::get_if<UniformTopology>(&made.image.topology);
  if (image == nullptr) throw input_error({title, "", "its tensors lie on no uniform grid", "an image", ""});
  data.grid = grid_of(*image);
  data.choice = made.choice;
  data.notes = std::move(made.notes);
  data.field = make_tensor_field(made.image, made.choice, title, threads);
  const std::vector<std::string>& found = data.field->notes().lines;
  data.notes.insert(data.notes.end(), found.begin(), found.end());
  data.values = six_of(made.image, made.choice);
  data.image = std::move(made.image);
  return std::make_shared<TensorData>(std::move(data));
}

void check_image(const WeightedImage& image) {
  std::size_t voxels = 1;
  for (const std::int64_t n : image.grid.voxels) {
    const bool fits = n > 0 && voxels <= image.signals.values.size() / as_size(n);
    voxels = fits ? voxels * as_size(n) : 0;
    if (voxels == 0) break;
  }
  const std::size_t volumes = image.weightings.size();
  if (volumes == 0 || volumes > kMostGradients || image.directions.size() != volumes) {
    throw input_error({.file = "gradients",
                       .place = {},
                       .found = std::to_string(volumes) + " weightings and " +
                                std::to_string(image.directions.size()) + " directions",
                       .expected = "one of each for every volume, at most " + std::to_string(kMostGradients),
                       .remedy = {}});
  }
  if (voxels == 0 || image.signals.values.size() % volumes != 0 ||
      image.signals.values.size() / volumes != voxels) {
    throw input_error({.file = "signals",
                       .place = {},
                       .found = std::to_string(image.signals.values.size()) + " numbers",
                       .expected = std::to_string(volumes) + " for each voxel",
                       .remedy = {}});
  }
  for (const double b : image.weightings) {
    if (std::isfinite(b) && b >= 0.0) continue;
    throw input_error({.file = "gradients",
                       .place = {},
                       .found = "a weighting of " + short_number(b),
                       .expected = "finite ones, not below zero",
                       .remedy = {}});
  }
}

std::vector<std::string> dropped_notes(const TractsDropped& d) {
  std::vector<std::string> notes;
  const auto add = [&notes](std::size_t count, const char* one, const char* what) {
    if (count > 0) notes.push_back(counted(count, one) + " " + what);
  };
  add(d.outside, "seed", "outside the image");
  add(d.bad_data, "seed", "without a tensor");
  add(d.below_cutoff, "seed", "where the FA is below the cut-off");
  add(d.too_short, "line", "too short");
  return notes;
}

}  // namespace

struct TensorAccess {
  static Tensors tensors(std::shared_ptr<const TensorData> made) {
    Tensors handle;
    handle.data_ = std::move(made);
    return handle;
  }
  static const TensorData& of(const Tensors& handle) { return *handle.data_; }
  static Tracts tracts(TractData made) {
    Tracts handle;
    handle.data_ = std::make_shared<TractData>(std::move(made));
    return handle;
  }
};

namespace {

Tensors opened(const InputOptions& spec, int threads, const Watcher& watch) {
  return watched(watch, [&](Progress& progress) {
    Input input = Input::open(spec, &progress);
    TensorImage image = input.load_tensor_image(threads, &progress);
    std::vector<std::string> notes = input.notes();
    image.notes.insert(image.notes.begin(), notes.begin(), notes.end());
    return TensorAccess::tensors(data_of(std::move(image), input.title(), threads));
  });
}

}  // namespace

Tensors Tensors::open(const std::string& file, const std::string& bval, const std::string& bvec, int threads,
                      const Watcher& watch) {
  InputOptions spec = input_of({file}, FieldKind::kTensor);
  spec.tensor.bval = bval;
  spec.tensor.bvec = bvec;
  return opened(spec, threads, watch);
}

Tensors Tensors::example(const std::string& name) {
  InputOptions spec;
  spec.kind = FieldKind::kTensor;
  spec.example = name;
  return opened(spec, 0, {});
}

const VoxelGrid& Tensors::grid() const noexcept { return data_->grid; }
std::span<const float> Tensors::values() const noexcept { return data_->values; }
const std::vector<std::string>& Tensors::notes() const noexcept { return data_->notes; }

std::vector<float> Tensors::measure(const std::string& name, int threads) const {
  return guarded(
      [&] { return measure_tensors(data_->image, data_->choice, measure_from_name(name), threads); });
}

Tensors fit_tensors(const WeightedImage& image, const FitOptions& options, const Watcher& watch) {
  return watched(watch, [&](Progress& progress) {
    check_image(image);
    const UniformTopology topology = topology_of(image.grid);
    const std::size_t volumes = image.weightings.size();
    const DataArray signals{.name = kSignalArray,
                            .association = Association::kPoint,
                            .components = static_cast<int>(volumes),
                            .type = ScalarType::kFloat32,
                            .tuples = image.signals.values.size() / volumes,
                            .bytes = std::as_bytes(image.signals.values),
                            .owner = image.signals.owner,
                            .sparse = nullptr};
    GradientTable table{.weightings = image.weightings, .directions = {}};
    for (const Point& direction : image.directions) table.directions.push_back(vec_of(direction));
    TensorReading reading;
    reading.masked = options.masked;
    reading.fit.weights = options.weighted ? FitWeights::kSignal : FitWeights::kOrdinary;
    TensorImage made;
    FittedImage fitted =
        fit_image(signals, topology, table, reading, "signals", options.threads, made.notes, &progress);
    made.choice = {.array = "tensors"};
    made.image.topology = topology;
    made.image.arrays = {make_array("tensors", Association::kPoint, 6, std::move(fitted.fit.tensors))};
    return TensorAccess::tensors(data_of(std::move(made), "signals", options.threads));
  });
}

Tracts tracts(const Tensors& tensors, std::span<const Point> seeds, const TractOptions& options,
              const Watcher& watch) {
  return watched(watch, [&](Progress& progress) {
    const palpate::TractOptions asked{.integrator = integrator_from_name(options.method),
                                      .tolerance = options.tolerance,
                                      .step = options.step,
                                      .cutoff = options.cutoff,
                                      .max_angle = options.max_angle,
                                      .min_length = options.min_length,
                                      .max_length = options.max_length,
                                      .include = {},
                                      .exclude = {},
                                      .stop = {},
                                      .threads = options.threads};
    std::vector<Vec3> from;
    for (const Point& x : seeds) from.push_back(vec_of(x));
    const TensorData& of = TensorAccess::of(tensors);
    TractData data;
    data.result = trace_tracts(*of.field, from, asked, &progress);
    const UniformTopology image = topology_of(of.grid);
    data.result.lines.image = {.voxels = image.points, .axes = image.axes, .origin = image.origin};
    for (const Vec3f& x : data.result.lines.points) data.points.push_back({x.x, x.y, x.z});
    for (const auto& ends : data.result.ends)
      data.ends.push_back({static_cast<std::uint8_t>(ends[0]), static_cast<std::uint8_t>(ends[1])});
    data.notes = dropped_notes(data.result.dropped);
    return TensorAccess::tracts(std::move(data));
  });
}

std::size_t Tracts::count() const noexcept { return data_->result.lines.line_count(); }
std::span<const std::uint64_t> Tracts::offsets() const noexcept { return data_->result.lines.starts; }
std::span<const std::array<float, 3>> Tracts::points() const noexcept { return data_->points; }
std::span<const float> Tracts::error() const noexcept { return data_->result.lines.of_points.front().values; }
std::span<const std::uint32_t> Tracts::seed() const noexcept { return data_->result.seeds; }
std::span<const std::array<std::uint8_t, 2>> Tracts::ends() const noexcept { return data_->ends; }
const std::vector<std::string>& Tracts::notes() const noexcept { return data_->notes; }

void Tracts::save(const std::string& path, bool overwrite) const {
  guarded([&] {
    check_line_output(path, overwrite);
    write_tractogram(path, data_->result.lines, overwrite);
  });
}

}  // namespace palpate::api
