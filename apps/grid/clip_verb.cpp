#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "apps/grid/color_block.h"
#include "apps/grid/grid_verbs.h"
#include "apps/grid/written_type.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/picture.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/compose/slice_plane.h"
#include "common/compose/text/lens_text.h"
#include "common/compose/volume_scene.h"
#include "common/field/grid/image_resample.h"
#include "common/load/volume_block.h"
#include "common/scene/origin_of.h"
#include "common/scene/volume_source.h"

namespace palpate {
namespace {

void check_clip(const Document& options) {
  check_volume_options(options.volume);
  check_type(options.slice);
  if (!options.slice.box.empty()) (void)parse_box(options.slice.box, "--box");
  if (options.slice.box.empty() && options.volume.clips.empty() && options.volume.lenses.empty())
    throw usage_error("clip needs something to cut with: try --plane nx,ny,nz,d or --box x,y,z,x,y,z");
}

/// The voxels in `--box`, all of them without one, in their type.
DataSet cropped(const DataSet& block, const Document& options) {
  const auto* uneven = std::get_if<RectilinearTopology>(&block.topology);
  const UnevenLattice lattice = uneven != nullptr
                                    ? uneven_lattice(*uneven)
                                    : UnevenLattice{std::get<UniformTopology>(block.topology), nullptr};
  const UniformTopology& grid = lattice.mean;
  IndexBox part{Index3(0), grid.points - 1};
  if (!options.slice.box.empty()) {
    const auto found = points_in(grid, parse_box(options.slice.box, "--box"), lattice.lines.get());
    if (!found) throw usage_error("--box " + options.slice.box + ": no voxel of the volume lies in it");
    part = *found;
  }
  DataSet result = block;
  if (uneven != nullptr) {
    RectilinearTopology kept;
    for (int a = 0; a < 3; ++a) {
      const std::vector<double>& x = uneven->coordinates[as_size(a)];
      kept.coordinates[as_size(a)].assign(x.begin() + part.first[a], x.begin() + part.last[a] + 1);
    }
    result.topology = std::move(kept);
  } else {
    result.topology = part_of(grid, part);
  }
  result.visible.clear();
  result.arrays = {values_of(grid, block.arrays.front(), part)};
  std::vector<DataSet> results;
  results.push_back(std::move(result));
  take_lattices(results);
  return std::move(results.front());
}

/// What `--clip` and `--lens` cut away of voxels, as pictures of them do: lenses that cut nothing are left
/// aside, and those on the screen.
std::vector<ConvexShape> shapes_that_cut(const VolumeOptions& options, const Console& console) {
  std::vector<ConvexShape> shapes;
  for (const std::string& plane : options.clips) shapes.push_back(parse_beyond(plane, "--plane " + plane));
  std::size_t aside = 0;
  for (const std::string& text : options.lenses) {
    const LensSpec words = parse_lens(text);
    const bool cuts = words.lens.cut && !words.off && !words.lens.screen;
    if (cuts) shapes.push_back(words.lens.shape);
    if (!cuts) ++aside;
  }
  if (aside > 0)
    console.note(std::to_string(aside) + (aside == 1 ? " lens" : " lenses") +
                 " left aside: voxels are cut by planes, and by shapes with ',cut'");
  return shapes;
}

/// Writes the part of the volume; what planes and shapes cut away gets its lowest value.
ExitCode write_part(const Document& options, const VerbContext& context) {
  check_image_output(options.output.file, options.common.force);
  const std::vector<ConvexShape> beyond = shapes_that_cut(options.volume, context.console);
  if (options.slice.box.empty() && beyond.empty())
    throw usage_error("clip needs something to cut voxels with: try --plane nx,ny,nz,d or --box x,y,z,x,y,z");
  Input input = open_input(options, context);
  context.console.note(input.choice_sentence());
  const std::optional<DataSet> colors = color_block(input, &context.progress);
  Resampling resampling{.asked = options.volume.resample, .threads = options.common.threads};
  const DataSet block =
      cropped(colors ? *colors : load_volume_block(input, &context.progress, &resampling), options);
  for (const std::string& note : resampling.notes()) context.console.note(note);
  if (std::holds_alternative<RectilinearTopology>(block.topology)) {
    throw input_error(
        {input.title(), "", "has voxels at uneven steps there",
         "a part whose steps are even: files of images have one step an axis",
         "--box chooses one; --resample 128 takes values at so many points along the longest edge, and "
         "says how far that is from them"});
  }
  const Stopwatch watch;
  LatticeSummary summary;
  summary.lattice = std::get<UniformTopology>(block.topology);
  DataArray array = block.arrays.front();
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  std::vector<std::byte> filler(array.bytes.size() /
                                std::max<std::size_t>(1, array.tuples));  // a voxel: black, or
  for (std::size_t i = 0; i < array.tuples; ++i) {                        // the lowest value
    const double value = array.at(i);
    if (!std::isfinite(value)) continue;
    highest = std::max(highest, value);
    if (value >= lowest) continue;
    lowest = value;
    const auto voxel = array.bytes.subspan(i * filler.size(), filler.size());
    if (array.components == 1) std::copy(voxel.begin(), voxel.end(), filler.begin());
  }
  if (lowest > highest) lowest = highest = 0.0;
  const Index3 n = summary.lattice.points;
  const auto bytes = std::make_shared<std::vector<std::byte>>(array.bytes.begin(), array.bytes.end());
  std::size_t i = 0;
  for (int z = 0; z < n.z && !beyond.empty(); ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x, ++i) {
        const Vec3 at = summary.lattice.origin + summary.lattice.axes * Vec3(x, y, z);
        const bool cut = std::any_of(beyond.begin(), beyond.end(),
                                     [&](const ConvexShape& shape) { return shape.contains(at); });
        if (!cut) continue;
        std::copy(filler.begin(), filler.end(),
                  bytes->begin() + static_cast<std::ptrdiff_t>(i * filler.size()));
        ++summary.outside;
      }
    }
  }
  array.bytes = std::as_const(*bytes);
  array.owner = bytes;
  context.progress.begin("writing " + options.output.file.filename().string(), 0);
  context.progress.check();
  ImageOrigin origin = origin_of(input);
  const std::string cost = take_type(options.slice, array, origin);
  if (!cost.empty()) context.console.note(options.output.file.string() + ": " + cost);
  const auto lost = write_image(options.output.file, summary.lattice, array, options.common.force, origin);
  for (const std::string& line : lost) context.console.note(options.output.file.string() + ": " + line);
  context.interrupt.keep(options.output.file);
  summary.input = input.title();
  summary.field = input.field_label();
  summary.output = options.output.file.string();
  summary.lowest = lowest;
  summary.highest = highest;
  summary.seconds_load = input.seconds_open() + input.seconds_read();
  summary.seconds_made = watch.seconds();
  context.console.print(summary.input + ": " + std::to_string(n.x) + " x " + std::to_string(n.y) + " x " +
                        std::to_string(n.z) + " voxels -> " + summary.output +
                        (summary.outside > 0
                             ? "; " + counted(summary.outside, "voxel") + " cut away, at the lowest value"
                             : std::string()) +
                        "\n");
  constexpr int kVtkComponents = 10;
  if (options.output.file.extension() == ".nrrd" && n.x < kVtkComponents) {
    context.console.note(summary.output + ": VTK's NRRD reader takes a first axis of fewer than " +
                         std::to_string(kVtkComponents) +
                         " samples for components of vectors, whatever the header says; write .vti for VTK");
  }
  context.console.print_json(lattice_json(summary));
  return ExitCode::kDone;
}

DrawnScene make_scene(Input& input, const Document& options, const VerbContext& context, double aspect) {
  Resampling resampling{.asked = options.volume.resample, .threads = options.common.threads};
  const DataSet block = cropped(load_volume_block(input, &context.progress, &resampling), options);
  for (const std::string& note : resampling.notes()) context.console.note(note);
  auto image = make_volume_image(block, block.arrays.front().name, input.title());
  if (const std::optional<DataSet> colors = color_block(input, &context.progress)) {
    image = with_own_colors(std::move(image), cropped(*colors, options).arrays.front());
    context.console.note(kOwnColorsNote);
  }
  DrawnScene drawn;
  drawn.volumes = std::move(resampling.taken);
  drawn.field = input.field_label();
  drawn.voxels = image->point_count();
  drawn.what = counted(drawn.voxels, "voxel");
  drawn.view = make_volume_scene(input, {.image = image}, options, aspect);
  return drawn;
}

ExitCode run_clip(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.output.file.empty())
    throw usage_error("clip needs an output: try --out part.png or --out part.nii.gz");
  check_clip(options);
  if (!is_picture(options.output.file)) return write_part(options, context);
  if (!options.slice.type.empty()) throw usage_error("--type is for voxels: write a .nii.gz, .nrrd or .vti");
  const PictureMaker maker{
      .check = check_clip,
      .check_input = [](const Document&, const Input& input) { (void)input.scalar_choice(); },
      .make = make_scene};
  return draw_picture(maker, options, context);
}

}  // namespace

Verb clip_verb(std::vector<UsageExample> examples) {
  return {
      .name = "clip",
      .summary = "cut the volume by planes and a box: a picture, or an image of what is left",
      .groups = {Group::kInput, Group::kView, Group::kOut, Group::kPicture, Group::kPart, Group::kVoxelType},
      .examples = std::move(examples),
      .run = run_clip};
}

}  // namespace palpate
