#include "apps/dtmri/bundle_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "apps/dtmri/csv_row.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/write/image_origin.h"
#include "common/load/write/write_image.h"
#include "common/scene/origin_of.h"
#include "common/trace/tract/bundle.h"

namespace palpate {
namespace {

bool has_one_number(const std::string& measure) { return component_count(measure_from_name(measure)) == 1; }

/// What the profile is of: of another image, or measured from the tensors.
std::shared_ptr<const ScalarField> profiled_field(const Document& options, const TensorImage* made,
                                                  const std::string& title, Progress& progress) {
  const int threads = options.common.threads;
  if (!options.output.profiled.empty()) {
    InputOptions image = input_of({options.output.profiled}, FieldKind::kScalar);
    image.tensor.handedness = options.input.tensor.handedness;
    return Input::open(image, &progress).load_scalar(threads, &progress);
  }
  if (made == nullptr)
    throw usage_error("--profile: there are no tensors to measure: name an image with --profile-image");
  std::vector<float> values =
      measure_tensors(made->image, made->choice, measure_from_name(options.output.measure), threads,
                      westin_from_name(options.output.westin));
  DataSet block;
  block.topology = made->image.topology;
  block.arrays.push_back(make_array(options.output.measure, Association::kPoint, 1, std::move(values)));
  return make_scalar_field({block}, {options.output.measure}, title, threads);
}

std::string profile_note(const OutputOptions& output, const BundleProfile& profile) {
  const std::string what = output.profiled.empty() ? output.measure : output.profiled.filename().string();
  double sum = 0.0;
  std::size_t values = 0, valueless = 0;
  for (const BundleNode& node : profile.nodes) {
    if (node.lines > 0) sum += node.mean * static_cast<double>(node.lines);
    values += node.lines;
    valueless += node.valueless;
  }
  std::string text = output.profile.string() + ": " + what + " along " + counted(profile.lines, "line");
  if (values > 0) text += ", mean " + short_number(sum / static_cast<double>(values));
  text += "; " + std::to_string(profile.turned) + " stored from the other end";
  if (profile.left_out > 0) text += ", " + counted(profile.left_out, "line") + " without a length left out";
  if (valueless > 0)
    text += ". WARNING: at " + counted(valueless, "place") + " of " + std::to_string(values + valueless) +
            " there is no value: the lines leave the image, or it has no number there";
  return text;
}

}  // namespace

void write_profile(const std::filesystem::path& path, const BundleProfile& profile, bool overwrite) {
  OutputFile file(path, overwrite);
  file.write("node,part,x,y,z,lines,valueless,mean,deviation,lower,median,upper\n");
  for (std::size_t n = 0; n < profile.nodes.size(); ++n) {
    const BundleNode& node = profile.nodes[n];
    std::string row = std::to_string(n);
    add_number(row, static_cast<double>(n) / static_cast<double>(profile.nodes.size() - 1));
    for (int axis = 0; axis < 3; ++axis) add_number(row, node.place[axis]);
    row += ',' + std::to_string(node.lines) + ',' + std::to_string(node.valueless);
    for (const double value : {node.mean, node.deviation, node.lower, node.median, node.upper})
      add_number(row, value);
    file.write(row += '\n');
  }
  file.finish();
}

void check_bundle_options(const Document& options) {
  const OutputOptions& output = options.output;
  if (output.profile.empty() && !output.profiled.empty())
    throw usage_error(
        "--profile-image needs a table that the profile is written to: try --profile profile.csv");
  if (!output.profile.empty()) {
    if (output.profile.extension() != ".csv")
      throw usage_error("--profile " + output.profile.string() + ": a table ends in .csv");
    if (output.profiled.empty() && !has_one_number(output.measure))
      throw usage_error("--measure " + output.measure +
                        ": a profile is of one number: fa, md, cl, cp, cs, mode or v1-cone");
    (void)westin_from_name(output.westin);
    OutputFile(output.profile, options.common.force);
  }
  for (const std::filesystem::path& image : {output.density, output.lines_mask}) {
    if (!image.empty()) check_image_output(image, options.common.force);
  }
}

void write_bundle(const Document& options, const VerbContext& context, Input& input, const TensorImage* made,
                  const UniformTopology& voxels, const Tractogram& lines, std::vector<std::string>& notes) {
  const OutputOptions& output = options.output;
  if (!output.profile.empty()) {
    const auto values = profiled_field(options, made, input.title(), context.progress);
    context.progress.begin("measuring along the bundle", 0);
    CellHint hint;
    const BundleProfile profile = bundle_profile(lines, output.nodes, [&](const Vec3& x) {
      const ScalarSample sample = values->sample(x, hint);
      return sample.status == SampleStatus::kOk ? sample.value : std::nan("");
    });
    if (profile.lines == 0)
      throw work_error("--profile: no line of " + output.tracts.string() + " has a length");
    write_profile(output.profile, profile, options.common.force);
    context.interrupt.keep(output.profile);
    notes.push_back(profile_note(output, profile));
  }
  if (output.density.empty() && output.lines_mask.empty()) return;
  context.progress.begin("counting lines", 0);
  const BundleDensity density = bundle_density(lines, {voxels.points, voxels.axes, voxels.origin});
  ImageOrigin origin;
  origin.space = ImageSpace::kPatient;  // as tracts are
  if (made != nullptr) origin = origin_of(input);
  if (origin.header) origin.header = origin.header->of_others();
  for (const auto& [file, is_mask] : {std::pair{output.density, false}, std::pair{output.lines_mask, true}}) {
    if (file.empty()) continue;
    const std::vector<std::string> lost =
        write_density(file, density, is_mask, voxels, origin, options.common.force);
    context.interrupt.keep(file);
    notes.push_back(file.string() + ": " + density_text(density, lines.line_count()));
    for (const std::string& line : lost) notes.push_back(file.string() + ": " + line);
  }
}

std::vector<std::string> write_density(const std::filesystem::path& file, const BundleDensity& density,
                                       bool mask, const UniformTopology& voxels, const ImageOrigin& origin,
                                       bool overwrite) {
  std::vector<float> values = density.lines;
  if (mask) std::ranges::transform(values, values.begin(), [](float v) { return v > 0.0F ? 1.0F : 0.0F; });
  return write_image(file, voxels, ImageContent::kScalar, values, ImageConvention::kMrtrix, overwrite,
                     origin);
}

std::string density_text(const BundleDensity& density, std::size_t lines) {
  const float most =
      density.lines.empty() ? 0.0F : *std::max_element(density.lines.begin(), density.lines.end());
  std::string text = counted(density.voxels, "voxel") + " with " +
                     (most == 1.0F ? "a line" : "1 to " + short_number(most) + " lines") + ", " +
                     short_number(density.volume) + " mm^3";
  if (density.outside > 0)
    text += ". WARNING: " + counted(density.outside, "line") + " of " + std::to_string(lines) +
            " leave the image; what lies outside is not counted";
  return text;
}

}  // namespace palpate
