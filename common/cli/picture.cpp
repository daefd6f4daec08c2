#include "common/cli/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/files/output_file.h"
#include "common/base/quantile.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/cli/film.h"
#include "common/cli/json/json_output.h"
#include "common/cli/verbs.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/compose/text/stereo_text.h"
#include "common/device/probe_path.h"
#include "common/hand/drawn/annotation_list.h"
#include "common/hand/drawn/drawn_lines.h"
#include "common/hand/technique/scene_pick.h"
#include "common/hand/touch_options.h"
#include "common/hand/workbench/head_view.h"
#include "common/render/png.h"
#include "common/render/render_panes.h"
#include "common/render/volume/estimate/image_error.h"

namespace palpate {
namespace {

constexpr int kOversampling = 3;  // samples along each edge of a pixel of the converged picture
constexpr int kFramesForJson = 5;

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

/// Of a volume as its picture was estimated, else of lines against more samples a pixel.
void measure_error(const SceneView& view, const RenderedImage& rendered, RenderSummary& summary) {
  const Image& image = rendered.image;
  if (has_two_eyes(view)) {
    // Of one eye: an interlaced picture has no finer one.
    SceneView one = view;
    one.stereo.mode = StereoMode::kNone;
    // Both of quad-buffer are in one picture.
    const int height = view.stereo.mode == StereoMode::kQuadBuffer ? image.height / 2 : image.height;
    const EyePictureSize size = eye_picture_size(view.stereo.mode, image.width, height);
    measure_error(one, render_image(one, size.width, size.height, 0, 0.0, true), summary);
    return;
  }
  if (rendered.error) {
    summary.estimate = rendered.error;
    summary.image_error = rendered.error->rms;
    summary.image_error_kind =
        "root mean square of full scale, of some pixels against 32 samples a voxel and tables of 512 entries";
    if (!rendered.error->of_asked_voxels)
      summary.image_error_kind += ", from the coarser voxels that are drawn: what these hide is not in it";
    return;
  }
  const RenderedImage fine = render_panes(view, kOversampling * image.width, kOversampling * image.height);
  summary.image_error = difference(image, fine.image, kOversampling);
  summary.image_error_kind = "root mean square of full scale, against 9 samples a pixel";
}

/// Of one of several pictures: "seen-front.png".
std::filesystem::path output_of(const std::filesystem::path& out, const ScreenPicture& picture,
                                bool several) {
  if (!several) return out;
  std::filesystem::path named = out;
  named.replace_filename(out.stem().string() + "-" + picture.name + out.extension().string());
  return named;
}

/// A ray hits lines that are this near to it: 3 mm of the default workspace [diagonals].
constexpr double kRayRadius = 0.012;

PickBeam beam_of_option(const ViewOptions& options, const SceneView& view) {
  return parse_beam(options.pick, kRayRadius * view.bounds.diagonal(), "--pick");
}

/// @throws Error (usage) where there is no volume.
void refine(SceneView& view) {
  if (!view.volume) throw usage_error("--converged is for pictures of volumes");
  VolumeView& volume = *view.volume;
  volume = converged_view(std::move(volume));
  volume.skip_empty = volume.stop_where_opaque = true;  // unseen
}

/// What is told of the drawing once a picture is there.
void tell(const RenderSummary& summary, const DrawnScene& drawn, const RenderedImage& rendered,
          Console& console) {
  console.print(summary.input + ": " + drawn.what + " -> " + summary.output + " (" +
                std::to_string(summary.width) + " x " + std::to_string(summary.height) + ", " +
                short_number(std::round(summary.frame_ms)) + " ms a frame, " + summary.renderer + ")\n");
  if (const BrickShare& bricks = rendered.bricks; bricks.all > 0) {
    console.print("  bricks: " + std::to_string(bricks.held) + " of the " + std::to_string(bricks.all) +
                  " of the volume are looked up and held, in a pool of " +
                  std::to_string(bricks.bytes >> 20U) + " MB\n");
  }
  if (const auto& coarser = rendered.coarser_voxels) {
    const Index3& n = coarser->points;
    std::string error;
    if (rendered.error && rendered.error->of_asked_voxels)
      error = "; root mean square of the picture's error " + short_number(rendered.error->rms) +
              " of full scale, worst " + short_number(rendered.error->worst);
    if (rendered.error && !rendered.error->of_asked_voxels)
      error = "; what they hide is not known: not even those of one ray fit";
    console.note("drawn from " + std::to_string(n.x) + " x " + std::to_string(n.y) + " x " +
                 std::to_string(n.z) +
                 " voxels, each the mean of several: finer ones do not fit --gpu-memory" + error);
    if (coarser->hidden > 0.0)
      console.note(
          "WARNING: thin things are lost in these means: of the parts of the volume that show something " +
          short_number(std::round(1e3 * coarser->hidden) / 10.0) +
          " % or more are clear in this picture; a larger --gpu-memory shows them");
  }
  console.print(stereo_text(drawn.view));
  if (drawn.view.volume) {
    const std::string note = panes_note(*drawn.view.volume);
    if (!note.empty()) console.note(note);
  }
}

}  // namespace

void show_hand(std::shared_ptr<PathHand> hand, const Document& options, DrawnScene& drawn) {
  drawn.view.probe = hand->at(options.output.path_frames > 0 ? 0.0 : 1.0);
  drawn.hand = [hand = std::move(hand)](double part) { return hand->at(part); };
}

void check_hand(std::span<const HapticMode> modes, const Document& given) {
  if (!given.hand.path.empty()) (void)read_probe_path(given.hand.path.string());
  (void)find_mode(modes, given.touch.mode);
  (void)touch_settings(given.touch);
}

ExitCode draw_picture(const PictureMaker& maker, const Document& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.output.file.empty()) throw usage_error("render needs an output: try --out picture.png");
  (void)camera_of(options.view, Box{}, 1.0);
  SceneView unseen;  // refuses what is no colour, range and the like
  apply_appearance(options, unseen);
  if (options.view.converged && options.view.frame_budget > 0.0)
    throw usage_error("--converged and --frame-budget: a picture is either refined or hurried");
  if (!options.view.pick.empty()) (void)beam_of_option(options.view, {});
  const std::vector<Annotation> annotations = annotations_of(options.touch.annotations, "--annotation");
  DrawnLines lines;
  if (!options.touch.drawn_lines.empty()) lines.put(read_drawn_lines(options.touch.drawn_lines));
  const std::vector<ScreenPicture> pictures = asked_pictures(options);
  const auto [width, height] = pictures.front().size;
  double aspect = eye_aspect(pictures.front().stereo.mode, width, height);
  const SlicePanes panes = slice_panes_of(options.panes, Box());
  if (panes.layout > 1) {
    if (!options.hand.workbench.empty())
      throw usage_error("--layout: slices are for a desktop: leave out --workbench, or ask for --layout 1");
    for (const Pane& pane : panes_of(panes, width, height))
      if (!pane.plane) aspect = static_cast<double>(pane.width) / pane.height;
  }
  if (!options.heart.beside.empty() || !options.heart.beside_angle.empty()) {
    if (pictures.front().stereo.mode != StereoMode::kNone || !options.hand.workbench.empty() ||
        asks_for_film(options)) {
      throw usage_error(
          "--compare: two hearts are one picture for one eye: leave out --stereo, --workbench, --turntable and "
          "--path-frames");
    }
    const Pane half = halves_of(width, height).front();
    aspect = static_cast<double>(half.width) / half.height;
  }
  const std::filesystem::path extension = options.output.file.extension();
  const bool film = asks_for_film(options), encoded = extension == ".mp4" || extension == ".webm";
  if (encoded && !film) {
    throw usage_error(options.output.file.string() +
                      ": a film takes --turntable N, or --path FILE.csv with --path-frames N");
  }
  if (!encoded && extension != ".png" && extension != ".PNG") {
    throw usage_error(options.output.file.string() + ": pictures are written as .png" +
                      (film ? ", films as numbered .png, .mp4 or .webm" : ""));
  }
  if (film) {
    check_film(options, pictures.size(), panes.layout);
  } else {
    for (const ScreenPicture& picture : pictures)
      check_output(output_of(options.output.file, picture, pictures.size() > 1), options.common.force);
  }
  maker.check(options);

  Input input = open_input(options, context);
  RenderSummary summary{.input = input.title()};
  maker.check_input(options, input);
  console.note(input.choice_sentence());

  DrawnScene drawn = maker.make(input, options, context, aspect);
  if (options.view.converged) refine(drawn.view);
  drawn.view.notes = notes_of(AnnotationList(annotations), length_unit(drawn.view), std::nullopt);
  if (!lines.entries().empty()) {
    if (!drawn.view.probe) drawn.view.probe.emplace();
    drawn.view.probe->drawn_lines = lines.drawn();
    drawn.what += ", " + counted(lines.entries().size(), "line") + " drawn by hand";
  }
  summary.field = drawn.field;
  summary.lines = drawn.lines;
  summary.points = drawn.points;
  summary.seeds_left_out = drawn.seeds_left_out;
  summary.voxels = drawn.voxels;
  summary.volumes = drawn.volumes;
  summary.seconds_trace = drawn.seconds_trace;
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  if (!options.view.pick.empty()) {
    summary.picks = true;
    std::vector<ConvexShape::HalfSpace> planes;
    summary.picked = pick(scene_of(drawn.view, {}, planes), beam_of_option(options.view, drawn.view));
    if (summary.picked) drawn.view.notes.push_back(note_of(*summary.picked));
    console.print("picked: " + (summary.picked ? name_of(*summary.picked) : std::string("nothing")) + "\n");
  }
  if (film) {
    take_head(pictures.front(), drawn.view);
    draw_film(drawn, options, context, width, height, summary);
    console.print_json(render_json(summary));
    return ExitCode::kDone;
  }
  for (const ScreenPicture& picture : pictures) {
    const auto [across, up] = picture.size;
    take_head(picture, drawn.view);
    if (picture.stereo.mode != StereoMode::kNone && !has_two_eyes(drawn.view))
      throw usage_error("--stereo needs a perspective picture: leave out --projection orthographic");
    context.progress.begin("drawing", 0);
    const int repeat =
        options.output.repeat > 0 ? options.output.repeat : (console.json() ? kFramesForJson : 0);
    const RenderedImage rendered =
        render_panes(drawn.view, across, up, repeat, options.view.frame_budget, console.json());
    summary.output = output_of(options.output.file, picture, pictures.size() > 1).string();
    summary.width = rendered.image.width;
    summary.height = rendered.image.height;
    summary.first_frame_ms = rendered.first_frame_ms;
    summary.frames_timed = static_cast<int>(rendered.frame_ms.size());
    summary.frame_ms = rendered.frame_ms.empty() ? rendered.first_frame_ms : median(rendered.frame_ms);
    summary.renderer = rendered.renderer;
    summary.quality = rendered.quality;
    summary.expected_error = rendered.expected_error;
    summary.timer_query = rendered.timer_query;
    summary.bricks = rendered.bricks;
    summary.tables_by = rendered.tables_by;
    context.progress.check();
    write_png(summary.output, rendered.image,
              {{"Software", version_text(context.explorer.name)}, {"Command", context.command_line}});
    context.interrupt.keep(summary.output);
    tell(summary, drawn, rendered, console);
    if (&picture != &pictures.back()) continue;
    if (console.json()) measure_error(drawn.view, rendered, summary);
  }
  console.print_json(render_json(summary));
  return ExitCode::kDone;
}

}  // namespace palpate
