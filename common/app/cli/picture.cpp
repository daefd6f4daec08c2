#include "common/app/cli/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "common/app/cli/head_view.h"
#include "common/app/cli/json_output.h"
#include "common/app/cli/line_view.h"
#include "common/app/cli/stereo_text.h"
#include "common/app/cli/verbs.h"
#include "common/app/haptic/probe_mouse.h"
#include "common/base/output_file.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/render/png.h"
#include "common/render/render_image.h"

namespace palpate {
namespace {

constexpr int kMostPixels = 8192;  // an edge of the picture: a driver may allow more, memory not
constexpr int kOversampling = 3;   // samples along each edge of a pixel of the converged picture
constexpr int kFramesForJson = 5;

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

/// Root mean square difference of colours, of full scale, between a picture and the mean of squares of
/// `oversampling` x `oversampling` pixels of a larger one.
double difference(const Image& image, const Image& fine, int oversampling) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::array<double, 3> mean{};
      for (int j = 0; j < oversampling; ++j) {
        for (int i = 0; i < oversampling; ++i) {
          const auto p = fine.pixel(oversampling * x + i, oversampling * y + j);
          for (std::size_t c = 0; c < 3; ++c) mean[c] += p[c];
        }
      }
      const auto p = image.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = (p[c] - mean[c] / (oversampling * oversampling)) / 255.0;
        sum += d * d;
      }
    }
  }
  return std::sqrt(sum / (3.0 * image.width * image.height));
}

/// Lines against more samples a pixel, volumes against more samples along the rays.
void measure_error(const SceneView& view, const Image& image, RenderSummary& summary) {
  if (has_two_eyes(view)) {
    // Of one eye: an interlaced picture has no finer one.
    SceneView one = view;
    one.stereo.mode = StereoMode::kNone;
    const EyePictureSize size = eye_picture_size(view.stereo.mode, image.width, image.height);
    measure_error(one, render_image(one, size.width, size.height).image, summary);
    return;
  }
  if (view.volume && view.volume->shown) {
    constexpr double kFiner = 4.0;
    SceneView finer = view;
    finer.volume->samples_per_voxel *= kFiner;
    finer.volume->context = {};
    for (Lens& lens : finer.volume->lenses) lens.samples_per_voxel *= kFiner;
    finer.volume->skip_empty = false;
    finer.volume->stop_where_opaque = false;
    summary.image_error = difference(image, render_image(finer, image.width, image.height).image, 1);
    summary.image_error_kind = "root mean square of full scale, against 4 times the samples along rays";
    return;
  }
  const RenderedImage fine = render_image(view, kOversampling * image.width, kOversampling * image.height);
  summary.image_error = difference(image, fine.image, kOversampling);
  summary.image_error_kind = "root mean square of full scale, against 9 samples a pixel";
}

}  // namespace

ExitCode draw_picture(const PictureMaker& maker, const Options& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty()) throw usage_error("render needs an output: try --out picture.png");
  const PictureSize size = parse_size(options.size);
  (void)camera_of(options.view, Box{}, 1.0);
  const StereoView stereo = stereo_of(options.view);
  check_head(options, eye_aspect(stereo.mode, size.width, size.height));
  if (options.out.extension() != ".png" && options.out.extension() != ".PNG") {
    throw usage_error(options.out.string() + ": pictures are written as .png");
  }
  check_output(options.out, options.common.force);
  maker.check(options);

  Input input = open_input(options, context);
  RenderSummary summary{
      .input = input.title(), .output = options.out.string(), .width = size.width, .height = size.height};
  const SceneUse use = maker.use(options, input);
  console.note(input.choice_sentence());
  if (options.common.explain) {
    summary.plan = plan_scene(input, use);
    console.print(plan_text(summary.plan));
  }

  DrawnScene drawn = maker.make(input, options, context, eye_aspect(stereo.mode, size.width, size.height));
  drawn.view.stereo = stereo;
  if (stereo.mode != StereoMode::kNone && !has_two_eyes(drawn.view))
    throw usage_error("--stereo needs a perspective picture: leave out --projection orthographic");
  take_head(options, drawn.view);
  summary.field = drawn.field;
  summary.lines = drawn.lines;
  summary.points = drawn.points;
  summary.voxels = drawn.voxels;
  summary.seconds_trace = drawn.seconds_trace;
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  context.progress.begin("drawing", 0);
  const int repeat = options.repeat > 0 ? options.repeat : (console.json() ? kFramesForJson : 0);
  const RenderedImage rendered =
      render_image(drawn.view, size.width, size.height, repeat, options.view.frame_budget);
  summary.first_frame_ms = rendered.first_frame_ms;
  summary.frames_timed = static_cast<int>(rendered.frame_ms.size());
  summary.frame_ms = rendered.frame_ms.empty() ? rendered.first_frame_ms : median(rendered.frame_ms);
  summary.renderer = rendered.renderer;
  summary.quality = rendered.quality;
  summary.bricks = rendered.bricks;
  context.progress.check();
  write_png(options.out, rendered.image,
            {{"Software", version_text(context.explorer.name)}, {"Command", context.command_line}});
  context.interrupt.keep(options.out);
  if (console.json()) measure_error(drawn.view, rendered.image, summary);
  if (options.common.explain) {
    summary.gpu = rendered.gpu;
    summary.measured = drawn.measured;
    summary.measured.push_back({.what = "first picture", .milliseconds = summary.first_frame_ms});
  }
  console.print(summary.input + ": " + drawn.what + " -> " + summary.output + " (" +
                std::to_string(size.width) + " x " + std::to_string(size.height) + ", " +
                short_number(std::round(summary.frame_ms)) + " ms a frame, " + summary.renderer + ")\n");
  if (const BrickShare& bricks = rendered.bricks; bricks.all > 0) {
    console.print("  bricks: " + std::to_string(bricks.held) + " of the " + std::to_string(bricks.all) +
                  " of the volume are looked up and held, in a pool of " +
                  std::to_string(bricks.bytes >> 20U) + " MB\n");
  }
  if (const auto& n = rendered.coarser_voxels) {
    console.note("drawn from " + std::to_string(n->x) + " x " + std::to_string(n->y) + " x " +
                 std::to_string(n->z) +
                 " voxels, each the mean of several: finer ones do not fit --gpu-memory");
  }
  console.print(stereo_text(drawn.view));
  if (options.common.explain) console.print(gpu_text(summary.gpu) + measured_text(summary.measured));
  console.print_json(render_json(summary));
  return ExitCode::kDone;
}

}  // namespace palpate
