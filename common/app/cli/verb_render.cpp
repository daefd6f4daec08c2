#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "common/app/cli/json_output.h"
#include "common/app/cli/line_color.h"
#include "common/app/cli/line_view.h"
#include "common/app/cli/summaries.h"
#include "common/app/cli/touch_options.h"
#include "common/app/cli/verbs.h"
#include "common/app/haptic/probe_picture.h"
#include "common/base/output_file.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/scene/plan.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

constexpr int kMostPixels = 8192;  // an edge of the picture: a driver may allow more, memory not
constexpr int kOversampling = 3;   // samples along each edge of a pixel of the converged picture
constexpr int kFramesForJson = 5;

struct PictureSize {
  int width = 0;
  int height = 0;
};

PictureSize parse_size(const std::string& text) {
  PictureSize size;
  char cross = 0;
  std::istringstream in(text);
  const bool read = static_cast<bool>(in >> size.width >> cross >> size.height) && in.peek() == EOF;
  if (!read || (cross != 'x' && cross != 'X')) {
    throw usage_error("--size " + text + ": width x height in pixels is expected, such as 1280x960");
  }
  if (size.width < 1 || size.height < 1 || size.width > kMostPixels || size.height > kMostPixels) {
    throw usage_error("--size " + text + ": edges from 1 to " + std::to_string(kMostPixels) +
                      " pixels are possible");
  }
  return size;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

/// Root mean square difference, of full scale, between the picture and one with kOversampling^2 samples a
/// pixel.
double image_error(const SceneView& view, const Image& image) {
  const RenderedImage fine = render_image(view, kOversampling * image.width, kOversampling * image.height);
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::array<double, 3> mean{};
      for (int j = 0; j < kOversampling; ++j) {
        for (int i = 0; i < kOversampling; ++i) {
          const auto p = fine.image.pixel(kOversampling * x + i, kOversampling * y + j);
          for (std::size_t c = 0; c < 3; ++c) mean[c] += p[c];
        }
      }
      const auto p = image.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = (p[c] - mean[c] / (kOversampling * kOversampling)) / 255.0;
        sum += d * d;
      }
    }
  }
  return std::sqrt(sum / (3.0 * image.width * image.height));
}

/// Adds what a hand on that path has felt.
void show_probe(SceneView& view, const std::vector<PathRow>& path, const HapticMode& mode,
                const Options& options, const std::shared_ptr<const VectorField>& field) {
  const Workspace workspace = touch_workspace(options.touch, field->diagonal(), field->frame());
  const HapticScene scene{field, workspace, touch_settings(options.touch, field.get(), workspace),
                          options.common.threads};
  view.probe = probe_after(path, mode.make(scene), scene, touch_limits(options.touch), view.style.color_by);
  view.probe->reference_speed = reference_speed(view);
  fade_lines(view);
}

ExitCode run_render(const std::vector<HapticMode>& modes, const Options& options,
                    const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty()) throw usage_error("render needs an output: try --out picture.png");
  const PictureSize size = parse_size(options.size);
  const SeedSpec spec = parse_seeds(options.tracing.seeds.empty() ? kViewSeeds : options.tracing.seeds);
  const TraceOptions trace = trace_options(options, "both");
  (void)camera_angles(options.view.camera);
  if (options.out.extension() != ".png" && options.out.extension() != ".PNG") {
    throw usage_error(options.out.string() + ": pictures are written as .png");
  }
  check_output(options.out, options.common.force);
  std::vector<PathRow> path;
  if (!options.path.empty()) path = read_probe_path(options.path.string());
  const HapticMode& mode = options.touch.mode.empty() ? modes.front() : find_mode(modes, options.touch.mode);

  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  const LineColor color = line_color(options.view.color, input);
  RenderSummary summary{
      .input = input.title(), .output = options.out.string(), .width = size.width, .height = size.height};
  if (options.common.explain) {
    summary.plan = plan_scene(input, {.verb = "render",
                                      .tracing = true,
                                      .lines = line_count(spec, trace),
                                      .threads = resolve_threads(trace.threads),
                                      .drawing = true,
                                      .color_array = color.array ? color.name : std::string()});
    console.print(plan_text(summary.plan));
  }

  const auto field = input.load_field(options.common.threads, &context.progress);
  summary.field = field->name();
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  const auto seeds = make_seeds(spec, *field, options.common.seed);
  TraceResult traced = trace_lines(*field, seeds, view_trace_options(options, *field), &context.progress);
  summary.seconds_trace = traced.seconds_prepare + traced.seconds_trace;
  summary.lines = traced.lines.size();
  summary.points = traced.points;
  if (traced.lines.empty()) console.note("no seed lies in the data: the picture shows the domain alone");

  const auto lines = std::make_shared<const std::vector<Line>>(std::move(traced.lines));
  const LineStyle style = line_style(color, input, *field, *lines, options.common.threads, &context.progress);
  SceneView view =
      make_line_view(input, *field, lines, options, style, static_cast<double>(size.width) / size.height);
  if (!options.path.empty()) show_probe(view, path, mode, options, field);
  context.progress.begin("drawing", 0);
  const int repeat = options.repeat > 0 ? options.repeat : (console.json() ? kFramesForJson : 0);
  const RenderedImage rendered = render_image(view, size.width, size.height, repeat);
  summary.first_frame_ms = rendered.first_frame_ms;
  summary.frames_timed = static_cast<int>(rendered.frame_ms.size());
  summary.frame_ms = rendered.frame_ms.empty() ? rendered.first_frame_ms : median(rendered.frame_ms);
  summary.renderer = rendered.renderer;
  context.progress.check();
  write_png(options.out, rendered.image,
            {{"Software", version_text(context.explorer.name)}, {"Command", context.command_line}});
  context.interrupt.keep(options.out);
  if (console.json()) {
    summary.image_error = image_error(view, rendered.image);
    summary.image_error_kind = "root mean square of full scale, against 9 samples a pixel";
  }
  if (options.common.explain) {
    summary.measured = measured_costs(input, field->tet_mesh());
    summary.measured.push_back({.what = "lines", .milliseconds = 1e3 * summary.seconds_trace});
    summary.measured.push_back({.what = "first picture", .milliseconds = summary.first_frame_ms});
  }
  console.print(summary.input + ": " + counted(summary.lines, "line") + " -> " + summary.output + " (" +
                std::to_string(size.width) + " x " + std::to_string(size.height) + ", " +
                short_number(std::round(summary.frame_ms)) + " ms a frame, " + summary.renderer + ")\n");
  if (options.common.explain) console.print(measured_text(summary.measured));
  console.print_json(render_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb render_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples) {
  return {
      .name = "render",
      .summary = "draw a picture, with or without a display",
      .groups = {.tracing = true, .view = true, .touch = true, .path = true, .out = true, .picture = true},
      .examples = std::move(examples),
      .run = [modes = std::move(modes)](const Options& options, const VerbContext& context) {
        return run_render(modes, options, context);
      }};
}

}  // namespace palpate
