#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "apps/dtmri/dtmri_verbs.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/scene/origin_of.h"

namespace palpate {
namespace {

ImageConvention convention_of(const Document& options) {
  if (options.output.convention == "mrtrix") return ImageConvention::kMrtrix;
  if (options.output.convention == "fsl") return ImageConvention::kFsl;
  throw usage_error("--convention " + options.output.convention + ": mrtrix, fsl are known");
}

/// What can be refused before any work is done.
void check_request(const Document& options, const std::string& verb, const std::string& example) {
  if (options.output.file.empty()) throw usage_error(verb + " needs an output: try --out " + example);
  (void)convention_of(options);
  check_image_output(options.output.file, options.common.force);
}

/// The grid of the image, which has to be one.
const UniformTopology& grid_of(const TensorImage& made, const Input& input) {
  const auto* topology = std::get_if<UniformTopology>(&made.image.topology);
  if (topology == nullptr) {
    throw input_error({input.title(), "", "is no image with even steps", "an image",
                       "its tensors can be traced, but not written as an image"});
  }
  return *topology;
}

/// Of each point whether a number of the file there is not finite, so that it has no tensor; empty where all are.
std::vector<bool> damaged_points(Input& input, Progress* progress) {
  std::vector<bool> damaged;
  const auto look = [&]<typename T>(T, const DataArray& array) {
    const std::span numbers(reinterpret_cast<const T*>(array.bytes.data()), array.bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (std::isfinite(numbers[i])) continue;
      damaged.resize(array.tuples, false);
      damaged[i / static_cast<std::size_t>(array.components)] = true;
    }
  };
  if (input.file() == nullptr) return damaged;
  for (const DataSet& block : input.read(input.tensor_source().arrays, progress)) {
    for (const DataArray& array : block.arrays) {
      if (array.sparse) continue;
      if (array.type == ScalarType::kFloat32) look(float{}, array);
      if (array.type == ScalarType::kFloat64) look(double{}, array);
    }
  }
  return damaged;
}

/// Writes `values`, says what was done, and returns.
ExitCode finish(const Document& options, const VerbContext& context, Input& input, const TensorImage& made,
                ImageContent content, std::vector<float> values, ImageSummary summary) {
  context.progress.begin("writing " + options.output.file.filename().string(), 0);
  context.progress.check();
  const Stopwatch watch;
  ImageOrigin origin = origin_of(input);
  if (origin.header) origin.header = origin.header->of_others();
  const auto components = static_cast<std::size_t>(component_count(content));
  const UniformTopology& grid = grid_of(made, input);
  const bool all =
      std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
  const std::vector<bool> unknown = all ? std::vector<bool>() : damaged_points(input, &context.progress);
  std::size_t zeros = 0, damaged = 0;
  for (std::size_t v = 0; v * components < values.size(); ++v) {
    float* const voxel = values.data() + v * components;
    if (std::isfinite(*voxel)) {
      ++summary.with_tensor;
    } else if (v < unknown.size() && unknown[v]) {
      ++damaged;
    } else {
      std::fill_n(voxel, components, 0.0F);
      ++zeros;
    }
  }
  if (zeros > 0)
    context.console.note(options.output.file.string() + ": " + counted(zeros, "voxel") +
                         " without a tensor, 0 there");
  if (damaged > 0)
    context.console.note(options.output.file.string() + ": " + counted(damaged, "voxel") +
                         " with numbers that are not finite in " + input.title() + ": " +
                         (content == ImageContent::kColor ? "black" : "NaN") + " there");
  const std::vector<std::string> lost = write_image(options.output.file, grid, content, values,
                                                    convention_of(options), options.common.force, origin);
  for (const std::string& line : lost) context.console.note(options.output.file.string() + ": " + line);
  summary.seconds_write = watch.seconds();
  summary.input = input.title();
  summary.field = input.field_label();
  summary.output = options.output.file.string();
  summary.voxels = values.size() / components;
  summary.turn = made.orientation.advice;
  summary.gain = made.orientation.gain;
  summary.notes = input.notes();
  summary.notes.insert(summary.notes.end(), made.notes.begin(), made.notes.end());
  for (const std::string& note : made.notes) context.console.note(input.title() + ": " + note);
  context.console.print(summary.output + ": " + summary.what + " of " +
                        counted(summary.with_tensor, "voxel") + " of " + std::to_string(summary.voxels) +
                        "\n");
  context.console.print_json(image_json(summary));
  return ExitCode::kDone;
}

/// The tensors as TensorOrder::kRows.
std::vector<float> rows_of(const TensorImage& made) {
  const DataArray& array = *made.image.find(made.choice.array, made.choice.association);
  std::vector<float> values(6 * array.tuples);
  for (std::size_t p = 0; p < array.tuples; ++p) {
    const auto tensor = read_tensor(array, p, made.choice.order);
    std::transform(tensor.begin(), tensor.end(), values.begin() + static_cast<std::ptrdiff_t>(6 * p),
                   [](double value) { return static_cast<float>(value); });
  }
  return values;
}

ExitCode run_fit(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  check_request(options, "fit", "tensor.nii.gz");
  Input input = open_input(options, context);
  const TensorImage made = input.load_tensor_image(options.common.threads, &context.progress);
  ImageSummary summary;
  summary.what = made.fit ? "fitted tensors" : "tensors (the file holds them; nothing was fitted)";
  if (made.fit) {
    summary.lifted = made.fit->lifted;
    summary.unusable = made.fit->unusable;
    summary.negative = made.fit->negative;
  }
  summary.seconds_load = input.seconds_open() + input.seconds_read();
  summary.seconds_made = input.seconds_field();
  return finish(options, context, input, made, ImageContent::kTensor, rows_of(made), std::move(summary));
}

/// Zero would be a direction that is known for sure: where there is no cone, it is open.
void open_unknown_cones(std::vector<float>& degrees, const std::string& input, Console& console) {
  constexpr float kOpen = 90.0F;
  const auto unknown =
      static_cast<std::size_t>(std::ranges::count_if(degrees, [](float cone) { return std::isnan(cone); }));
  if (unknown == degrees.size())
    throw work_error(
        input +
        ": seven volumes determine a tensor and nothing of its noise: no cone is known, more are needed");
  for (float& cone : degrees) cone = std::isnan(cone) ? kOpen : cone;
  if (unknown > 0)
    console.note(input + ": " + counted(unknown, "voxel") + " without a tensor, 90 degrees there");
}

ExitCode run_measure(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  const TensorMeasure measure = measure_from_name(options.output.measure);
  const WestinScale westin = westin_from_name(options.output.westin);
  check_request(options, "measure", options.output.measure + ".nii.gz");
  Input input = open_input(options, context);
  const TensorImage made =
      input.load_tensor_image(options.common.threads, &context.progress, measure == TensorMeasure::kCone);
  const Stopwatch watch;
  std::vector<float> values =
      measure_tensors(made.image, made.choice, measure, options.common.threads, westin);
  if (measure == TensorMeasure::kCone) open_unknown_cones(values, input.title(), context.console);
  ImageSummary summary;
  summary.what = std::string(name_of(measure));
  if (measure == TensorMeasure::kCone) summary.what += " [degrees]";
  const bool shape = measure == TensorMeasure::kLinear || measure == TensorMeasure::kPlanar ||
                     measure == TensorMeasure::kSpherical;
  if (shape)
    summary.what += westin == WestinScale::kTrace ? " as a part of the trace (--westin)"
                                                  : " as a part of the largest eigenvalue (--westin)";
  summary.seconds_load = input.seconds_open() + input.seconds_read();
  summary.seconds_made = input.seconds_field() + watch.seconds();
  ImageContent content = ImageContent::kScalar;
  if (measure == TensorMeasure::kMainDirection) content = ImageContent::kVector;
  if (measure == TensorMeasure::kColor) content = ImageContent::kColor;
  return finish(options, context, input, made, content, std::move(values), std::move(summary));
}

}  // namespace

Verb fit_verb(std::vector<UsageExample> examples) {
  return {.name = "fit",
          .summary = "fit tensors to diffusion-weighted volumes and write them as an image",
          .groups = {Group::kInput, Group::kOut, Group::kImage},
          .examples = std::move(examples),
          .run = run_fit};
}

Verb measure_verb(std::vector<UsageExample> examples) {
  return {.name = "measure",
          .summary = "write what tensors measure as an image: anisotropies, diffusivity, directions",
          .groups = {Group::kInput, Group::kOut, Group::kImage, Group::kMeasure},
          .examples = std::move(examples),
          .run = run_measure};
}

}  // namespace palpate
