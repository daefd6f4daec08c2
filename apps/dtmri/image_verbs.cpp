#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "apps/dtmri/dtmri_verbs.h"
#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/write/write_image.h"

namespace palpate {
namespace {

ImageConvention convention_of(const Document& options) {
  if (options.output.convention == "mrtrix") return ImageConvention::kMrtrix;
  if (options.output.convention == "fsl") return ImageConvention::kFsl;
  throw usage_error("--convention " + options.output.convention + ": mrtrix, fsl are known");
}

WestinScale westin_of(const Document& options) {
  for (const WestinScale scale : {WestinScale::kTrace, WestinScale::kLargest}) {
    if (options.output.westin == name_of(scale)) return scale;
  }
  throw usage_error("--westin " + options.output.westin + ": trace, largest are known");
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

/// Writes `values`, says what was done, and returns.
ExitCode finish(const Document& options, const VerbContext& context, const Input& input,
                const TensorImage& made, ImageContent content, const std::vector<float>& values,
                ImageSummary summary) {
  context.progress.begin("writing " + options.output.file.filename().string(), 0);
  context.progress.check();
  const Stopwatch watch;
  write_image(options.output.file, grid_of(made, input), content, values, convention_of(options),
              options.common.force);
  summary.seconds_write = watch.seconds();
  summary.input = input.title();
  summary.field = input.field_label();
  summary.output = options.output.file.string();
  summary.voxels = values.size() / static_cast<std::size_t>(component_count(content));
  const auto components = static_cast<std::size_t>(component_count(content));
  for (std::size_t v = 0; v < values.size(); v += components)
    summary.with_tensor += std::isfinite(values[v]) ? 1 : 0;
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

ExitCode run_measure(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  const TensorMeasure measure = measure_from_name(options.output.measure);
  const WestinScale westin = westin_of(options);
  check_request(options, "measure", options.output.measure + ".nii.gz");
  Input input = open_input(options, context);
  const TensorImage made = input.load_tensor_image(options.common.threads, &context.progress);
  const Stopwatch watch;
  const std::vector<float> values =
      measure_tensors(made.image, made.choice, measure, options.common.threads, westin);
  ImageSummary summary;
  summary.what = std::string(name_of(measure));
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
  return finish(options, context, input, made, content, values, std::move(summary));
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
