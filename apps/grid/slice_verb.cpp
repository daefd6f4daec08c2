#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <variant>

#include "apps/grid/color_block.h"
#include "apps/grid/grid_verbs.h"
#include "apps/grid/written_type.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/compose/slice_plane.h"
#include "common/compose/text/plane_image_text.h"
#include "common/compose/volume_scene.h"
#include "common/field/array_type.h"
#include "common/field/grid/image_contours.h"
#include "common/field/grid/lattice_values.h"
#include "common/field/grid/sparse/sparse_statistics.h"
#include "common/field/value_histogram.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/load/write/write_lines.h"
#include "common/math/lattice.h"
#include "common/render/png.h"
#include "common/scene/document/tables.h"
#include "common/scene/origin_of.h"

namespace palpate {
namespace {

constexpr int kMostPixels = 16384;  // an edge: more is a spacing that was not meant

void check_slices(const Document& options) {
  if (options.output.file.empty()) throw usage_error("slice needs an output: try --out slice.png");
  if (!parse_contours(options.slice.contours).empty()) {
    check_line_output(options.output.file, options.common.force);
  } else if (is_picture(options.output.file)) {
    check_output(options.output.file, options.common.force);
  } else {
    check_image_output(options.output.file, options.common.force);
  }
  Box unit;
  unit.include(Vec3(0.0));
  (void)parse_plane(options.slice.plane, unit);
  const SliceOptions& slice = options.slice;
  check_type(slice);
  if (!slice.type.empty() && (is_picture(options.output.file) || !slice.contours.empty()))
    throw usage_error("--type is for voxels: write a .nii.gz, .nrrd or .vti");
  if (!(slice.spacing >= 0.0) || !std::isfinite(slice.spacing))
    throw usage_error("--spacing: a finite number, not below zero, is expected");
  if (slice.window && !(*slice.window > 0.0 && std::isfinite(*slice.window)))
    throw usage_error("--window: a finite number above zero is expected");
  if (slice.level && !std::isfinite(*slice.level)) throw usage_error("--level: a finite number is expected");
}

/// What the file states of black and white, where the options name neither.
SliceOptions with_window_of(const Input& input, SliceOptions slice) {
  const auto stated = stated_window(input);
  if (!stated || slice.window || slice.level) return slice;
  slice.window = stated->width;
  slice.level = stated->level;
  return slice;
}

/// Lowest and highest of the finite values, and where black and white lie.
struct Greys {
  double lowest = 0.0, highest = 0.0;
  double window = 1.0, level = 0.5;
};

Greys greys_of(const DataArray& values, const SliceOptions& slice, int threads) {
  Greys greys{HUGE_VAL, -HUGE_VAL, 1.0, 0.0};
  if (values.sparse) {
    const SparseRange range = range_of(*values.sparse, threads);
    greys.lowest = range.lowest;
    greys.highest = range.highest;
  } else {
    for (std::size_t i = 0; i < values.tuples; ++i) {
      const double v = values.at(i);
      if (!std::isfinite(v)) continue;
      greys.lowest = std::min(greys.lowest, v);
      greys.highest = std::max(greys.highest, v);
    }
  }
  if (greys.lowest > greys.highest) greys.lowest = greys.highest = 0.0;
  ValueHistogram histogram{greys.lowest, greys.highest, {}, 0};
  constexpr std::size_t kBins = 1024;
  if (greys.lowest < greys.highest) {
    const auto between = [&](double lower, double upper) {
      return values.sparse
                 ? count_values(
                       *values.sparse, [](double number) { return number; }, lower, upper, kBins, threads)
                 : count_values(
                       values.tuples, [&values](std::size_t i) { return values.at(i); }, lower, upper, kBins,
                       threads);
    };
    histogram = bulk_histogram(between, greys.lowest, greys.highest);
  }
  const ValueWindow window = default_window(histogram);
  greys.window = slice.window.value_or(window.width);
  greys.level = slice.level.value_or(histogram.lower + 0.5 * greys.window);
  return greys;
}

/// Rows of a lattice run up, those of a picture down.
Image grey_image(const UniformTopology& lattice, const std::vector<float>& values, const Greys& greys) {
  Image image{lattice.points.x, lattice.points.y, {}};
  image.rgba.reserve(4 * values.size());
  const double black = greys.level - 0.5 * greys.window;
  for (int y = image.height - 1; y >= 0; --y) {
    for (int x = 0; x < image.width; ++x) {
      const auto at = as_size(y) * as_size(image.width) + as_size(x);
      const double part = std::clamp((static_cast<double>(values[at]) - black) / greys.window, 0.0, 1.0);
      const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * part));
      image.rgba.insert(image.rgba.end(), {grey, grey, grey, 255});
    }
  }
  return image;
}

UniformTopology lattice_of(const UniformTopology& grid, const Document& options, const Box& bounds) {
  const ImagePlane plane = parse_plane(options.slice.plane, bounds);
  std::optional<double> spacing;
  if (options.slice.spacing > 0.0) spacing = options.slice.spacing;
  auto lattice = plane_lattice(grid, plane, spacing);
  // Pixels of a picture are square.
  if (lattice && !spacing && is_picture(options.output.file)) {
    const double u = glm::length(lattice->axes[0]), v = glm::length(lattice->axes[1]);
    constexpr double kEqual = 1e-6;
    if (std::abs(u - v) > kEqual * std::max(u, v)) lattice = plane_lattice(grid, plane, std::min(u, v));
  }
  if (!lattice) {
    const auto corner = [](const Vec3& x) {
      return short_number(x.x) + "," + short_number(x.y) + "," + short_number(x.z);
    };
    throw usage_error("--plane " + options.slice.plane + ": passes by the volume, which reaches from " +
                      corner(bounds.lower) + " to " + corner(bounds.upper));
  }
  if (std::max(lattice->points.x, lattice->points.y) > kMostPixels) {
    throw usage_error("the slice would have " + std::to_string(lattice->points.x) + " x " +
                      std::to_string(lattice->points.y) + " pixels, more than " +
                      std::to_string(kMostPixels) + " along an edge; a larger --spacing makes fewer");
  }
  return *lattice;
}

/// Lines of equal value with their values: one column of all points.
struct Contours {
  std::vector<Line> lines;
  PointColumn values{.name = "value", .values = {}};
};

Contours contours_of(const UniformTopology& lattice, const std::vector<float>& slice,
                     const std::vector<double>& values) {
  Contours contours;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const ContourLine& contour : contour_lines(lattice, slice, values[i])) {
      const Vec3 &first = contour.front().position, &last = contour.back().position;
      Line line{.end = first == last ? End::kLoop : End::kLeftDomain, .seed = static_cast<std::uint32_t>(i)};
      double arc = 0.0;
      for (const ContourPoint& point : contour) {
        if (!line.points.empty()) arc += glm::distance(line.points.back().position, point.position);
        line.points.push_back({.position = point.position, .arc = arc, .error = point.error});
      }
      contours.values.values.insert(contours.values.values.end(), line.points.size(), values[i]);
      contours.lines.push_back(std::move(line));
    }
  }
  return contours;
}

Box bounds_of(const UniformTopology& grid) {
  Box box;
  for (unsigned i = 0; i < 8; ++i) {
    box.include(grid.origin + grid.axes * Vec3((i & 1U) != 0 ? grid.points.x - 1 : 0,
                                               (i & 2U) != 0 ? grid.points.y - 1 : 0,
                                               (i & 4U) != 0 ? grid.points.z - 1 : 0));
  }
  return box;
}

/// Of an image that was written: where it has no value, and what stands there.
struct WrittenSlice {
  std::size_t outside = 0, missing = 0;
  bool lowest = false;  ///< outside: the lowest value of the data, else NaN
};

/// Writes a slice as voxels in the type of the data. Where it lies on the data's own voxels, and where these name
/// parts of the image, it takes their numbers; elsewhere it interpolates, and rounds where the type is of whole numbers.
WrittenSlice write_slice(const Document& options, const VerbContext& context, Input& input,
                         const UnevenLattice& grid, const DataArray& values, double lowest,
                         const UniformTopology& lattice) {
  ImageOrigin origin = origin_of(input);
  constexpr int kLabelIntent = 1002;  // of nifti1.h
  const bool whole = is_whole(values.type), colors = values.components > 1;
  const double none = whole ? lowest : std::numeric_limits<double>::quiet_NaN();
  const NearestPoints nearest = nearest_points(grid.mean, lattice, grid.lines.get());
  const bool labels = whole && !colors && !nearest.exact &&
                      ((origin.header && origin.header->intent == kLabelIntent) ||
                       looks_like_labels(values, grid.mean.points));
  WrittenSlice slice{.outside = nearest.outside, .missing = 0, .lowest = whole};
  DataArray written;
  if (!values.sparse && (nearest.exact || labels)) {
    std::vector<std::byte> beyond(byte_size(values.type) * as_size(values.components));
    if (!colors) std::ranges::copy(in_type(std::span(&none, 1), values.type).array.bytes, beyond.begin());
    written = values_at(values, nearest, beyond);
    if (labels)
      context.console.note(
          "whole numbers that name parts of the image: those of the nearest voxels are taken");
    for (std::size_t i = 0; i < written.tuples && !whole; ++i)
      slice.missing += std::isnan(written.at(i)) ? 1 : 0;
  } else {
    const auto components = as_size(values.components);
    std::vector<double> numbers(count_of(lattice.points) * components);
    for (std::size_t c = 0; c < components; ++c) {
      const std::vector<double> part = values_on(grid.mean, values, static_cast<int>(c), lattice,
                                                 options.common.threads, grid.lines.get());
      for (std::size_t i = 0; i < part.size(); ++i) {
        const bool beyond = std::isnan(part[i]);
        slice.missing += c == 0 && beyond && !whole ? 1 : 0;
        numbers[i * components + c] = !beyond ? part[i] : colors ? 0.0 : none;
      }
    }
    TypedArray typed = in_type(numbers, values.type);
    if (whole && typed.rounded > 0)
      context.console.note("values between voxels rounded to " + std::string(name_of(values.type)) +
                           ", the type of the data: by at most 0.5");
    written = std::move(typed.array);
    written.components = values.components;
    written.tuples = count_of(lattice.points);
  }
  if (!whole) slice.missing -= slice.outside;
  const std::string cost = take_type(options.slice, written, origin);
  if (!cost.empty()) context.console.note(options.output.file.string() + ": " + cost);
  const auto lost = write_image(options.output.file, lattice, written, options.common.force, origin);
  for (const std::string& line : lost) context.console.note(options.output.file.string() + ": " + line);
  return slice;
}

/// Slices side by side, and the volume with them: what a window shows in panes.
ExitCode draw_panes(const Document& options, const VerbContext& context) {
  if (options.output.file.empty()) throw usage_error("slice needs an output: try --out slices.png");
  for (const std::string& name : options.given) {
    if (name == "plane" || name == "spacing" || name == "contours")
      throw usage_error("--" + name + " is for one slice: --layout " + options.panes.layout +
                        " shows those through --cross, in pixels of the picture");
  }
  Document drawn = options;
  drawn.volume.window = options.slice.window;
  drawn.volume.level = options.slice.level;
  return volume_render_verb(modes_of(FieldKind::kScalar), {}).run(drawn, context);
}

std::string nothing_there(const WrittenSlice& slice) {
  std::string text;
  if (slice.outside > 0)
    text = "; " + counted(slice.outside, "point") + " outside, " +
           (slice.lowest ? "at the lowest value" : "NaN");
  if (slice.missing > 0) text += "; " + counted(slice.missing, "point") + " without a value, NaN";
  return text;
}

ExitCode run_slice(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.panes.layout != PanesOptions{}.layout) return draw_panes(options, context);
  check_slices(options);
  for (const Setting& row : panes_settings()) {
    if (row.name != "slice-side" && !is_default(row, options))
      throw usage_error("--" + std::string(row.name) +
                        " is for --layout 2 and 4: --plane says which slice is written");
  }
  if (!options.output.size.empty())
    throw usage_error("--size is for --layout 2 and 4: --spacing says how large pixels are");
  Input input = open_input(options, context);
  context.console.note(input.choice_sentence());
  Resampling resampling{.asked = options.volume.resample, .threads = options.common.threads};
  const DataSet block = load_volume_block(input, &context.progress, &resampling);
  for (const std::string& note : resampling.notes()) context.console.note(note);
  const auto* uneven = std::get_if<RectilinearTopology>(&block.topology);
  const UnevenLattice grid = uneven != nullptr
                                 ? uneven_lattice(*uneven)
                                 : UnevenLattice{std::get<UniformTopology>(block.topology), nullptr};
  if (grid.lines && options.slice.spacing <= 0.0)
    context.console.note(
        "voxels at uneven steps: the slice has their mean one, with the values at its points; "
        "--spacing sets another");
  const DataArray& values = block.arrays.front();
  const Stopwatch watch;
  LatticeSummary summary;
  summary.lattice = lattice_of(grid.mean, options, bounds_of(grid.mean));
  const Greys greys = greys_of(values, with_window_of(input, options.slice), options.common.threads);
  const std::vector<double> contour_values = parse_contours(options.slice.contours);
  const bool as_lines = !contour_values.empty();
  const bool as_voxels = !as_lines && !is_picture(options.output.file);
  const float filler = as_lines ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(greys.lowest);
  ResampledImage slice;
  if (!as_voxels)
    slice = resample(grid.mean, values, 0, summary.lattice, filler, options.common.threads, grid.lines.get());
  WrittenSlice written{.outside = slice.outside, .missing = 0, .lowest = true};
  context.progress.begin("writing " + options.output.file.filename().string(), 0);
  context.progress.check();
  const bool anatomical = space_of(input) == ImageSpace::kPatient;
  summary.right = direction_text(glm::normalize(summary.lattice.axes[0]), anatomical);
  summary.up = direction_text(glm::normalize(summary.lattice.axes[1]), anatomical);
  if (as_lines) {
    const Contours contours = contours_of(summary.lattice, slice.values, contour_values);
    if (contours.lines.empty()) {
      throw work_error("no value of the slice is one of --contours " + options.slice.contours +
                       "; the data reach from " + short_number(greys.lowest) + " to " +
                       short_number(greys.highest));
    }
    summary.lines = contours.lines.size();
    write_lines(options.output.file, contours.lines, options.common.force, std::span(&contours.values, 1));
  } else if (is_picture(options.output.file)) {
    summary.window = greys.window;
    summary.level = greys.level;
    write_png(options.output.file, grey_image(summary.lattice, slice.values, greys),
              {{"Software", version_text(context.explorer.name)},
               {"Command", context.command_line},
               {"Comment", "right: " + summary.right + "; up: " + summary.up}});
  } else {
    const std::optional<DataSet> colors = color_block(input, &context.progress);
    written = write_slice(options, context, input, grid, colors ? colors->arrays.front() : values,
                          greys.lowest, summary.lattice);
  }
  context.interrupt.keep(options.output.file);
  summary.input = input.title();
  summary.field = input.field_label();
  summary.output = options.output.file.string();
  summary.outside = written.outside + written.missing;
  summary.lowest = greys.lowest;
  summary.highest = greys.highest;
  summary.seconds_load = input.seconds_open() + input.seconds_read();
  summary.seconds_made = watch.seconds();
  const Index3& n = summary.lattice.points;
  context.console.print(summary.input + ": slice -> " + summary.output + " (" + std::to_string(n.x) + " x " +
                        std::to_string(n.y) +
                        (as_lines                          ? ", " + counted(summary.lines, "line")
                         : is_picture(options.output.file) ? ", window " + short_number(greys.window) +
                                                                 ", level " + short_number(greys.level)
                                                           : std::string()) +
                        "), " + summary.right + " on the right, " + summary.up + " at the top" +
                        (as_lines ? std::string() : nothing_there(written)) + "\n");
  context.console.print_json(lattice_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb slice_verb(std::vector<UsageExample> examples) {
  return {.name = "slice",
          .summary = "write a slice through the volume as a picture or an image, or several side by side",
          .groups = {Group::kInput, Group::kOut, Group::kSlice, Group::kPanes, Group::kPanesSize,
                     Group::kVoxelType},
          .examples = std::move(examples),
          .run = run_slice};
}

}  // namespace palpate
