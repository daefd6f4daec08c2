#include "common/render/scene_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/math/power_of_two.h"
#include "common/render/color/palette.h"
#include "common/render/frame_block.h"
#include "common/render/gl/frame_timer.h"
#include "common/render/gl/object.h"
#include "common/render/gl/program.h"
#include "common/render/gl/target.h"
#include "common/render/glyph/probe_pass.h"
#include "common/render/label/label_pass.h"
#include "common/render/line/line_layers.h"
#include "common/render/line/line_pass.h"
#include "common/render/overlay/overlay.h"
#include "common/render/scene_geometry.h"
#include "common/render/scene_parts.h"
#include "common/render/scene_view.h"
#include "common/render/slice/slice_pass.h"
#include "common/render/stereo/stereo_pass.h"
#include "common/render/surface/surface_pass.h"
#include "common/render/tensor/tensor_pass.h"
#include "common/render/tract/growing_tracts.h"
#include "common/render/volume/estimate/picture_estimates.h"
#include "common/render/volume/tile_pass.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {
namespace {

// How far a line may be moved unseen [scene frame]: a part of a pixel where the scene is nearest. A
// power of two, so that it changes rarely while the camera moves.
double line_tolerance(const ViewTransform& view, bool perspective, double pixel) {
  constexpr double kPartOfPixel = 0.25, kNearest = 0.05;
  const double enlarged = perspective ? std::clamp(view.near_depth / view.distance, kNearest, 1.0) : 1.0;
  return power_of_two(binary_exponent(kPartOfPixel * pixel * enlarged));
}

}  // namespace

struct SceneRenderer::State {
  RenderTarget target;
  GlProgram background;
  GlVertexArray no_vertices = make_vertex_array();
  LineProgram line_program, layer_program{LineProgram::Into::kLayers};
  LineLayers layers;
  std::optional<LayeredLines> layered;  // what `layers` held in the last picture
  SceneGeometry geometry;
  ColoredLines& lines = geometry.lines();
  std::unique_ptr<ProbePass> probe;  // made when a picture first shows one
  std::unique_ptr<VolumePass> volume;
  bool draws_volume = false;  // in the last picture
  bool keeps_for_error = false;
  RenderTarget sharp;  // of the same size as pictures that are kept, which have fewer pixels
  std::optional<BehindSharp> behind_sharp;  // for the next of these
  PictureEstimates estimates;               // of the last picture
  std::optional<SceneView> estimated;       // that picture without its volume
  std::unique_ptr<SurfacePass> surfaces;
  std::unique_ptr<VolumeSlicePass> slice;
  std::unique_ptr<TensorPass> tensors;
  GrowingTracts tracts;
  std::unique_ptr<LabelPass> labels;
  std::unique_ptr<Overlay> overlay;
  std::unique_ptr<StereoPass> stereo;  // of the last picture; none where it has one eye
  FrameTimer timer;
  int compiled_before = 0;  // programs, the last picture
  FrameBlock block;         // of this picture

  // What the second framebuffer shows; none where it is out of date.
  std::optional<SceneView> still;
  bool made_still = false;                       // by the last picture
  double line_detail = 1.0, still_detail = 1.0;  // of the lines, and of those that `still` shows
  std::size_t still_path = 0;                    // the path is drawn there up to this point
  std::function<bool()> stop_tracts, stop;       // of the call of draw()
  double volume_ms = 0.0;                        // over tracts, the last time

  // @return whether the path is another one.
  bool update_probe(const SceneView& view) {
    if (!probe) probe = std::make_unique<ProbePass>();
    // Without lines in the scene, those of the probe alone say how far the colours spread.
    const bool alone = !view.lines || view.lines->empty();
    if (alone) lines.legend().range = range_alone(*view.probe, view.style);
    const bool other_path = probe->update(view, geometry.frame(), lines.legend().range);
    lines.legend().forces_above = probe->forces_above();
    return other_path;
  }

  void draw_background() {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    if (!background) background = compile_program("background/background.vert", "background/background.frag");
    glUseProgram(background.name());
    glBindVertexArray(no_vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  // All that stays as it is while the probe moves, into the framebuffer that is bound. Transparent lines
  // are not part of it: they mix with what lies behind them, which may be the probe.
  void draw_still_part(const SceneView& view, const LineDraw& base, float unit,
                       const ViewTransform& transform) {
    glDepthMask(GL_TRUE);
    glClearDepth(1.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw_background();
    if (view.slice) {
      if (!slice) slice = std::make_unique<VolumeSlicePass>();
      slice->draw(*view.slice, view.camera, target.scene_width(), target.scene_height());
    }
    if (view.show_outline) {
      line_program.use(color_map_of(view.style));
      LineDraw how = base;
      how.coloring = LineDraw::Coloring::kUnlit;
      how.color = palette_of(view.background).outline;
      how.min_width = how.width = std::max(1.0F, 1.3F * unit);
      geometry.outline().draw(how);
    }
    for (std::size_t i = 0; i < geometry.regions().size(); ++i) {
      line_program.use(color_map_of(view.style));
      LineDraw how = base;
      how.coloring = LineDraw::Coloring::kUnlit;
      how.color = view.regions[i].color;
      how.min_width = how.width = std::max(1.0F, 1.8F * unit);
      geometry.regions()[i].draw(how);
    }
    if (view.tensors) {
      if (!tensors) tensors = std::make_unique<TensorPass>();
      tensors->draw(view, geometry.frame(), transform, unit);
    }
    if (!is_transparent(view)) {
      LineDraw how = base;
      how.detail = line_detail;
      if (stop) how.stop = &stop;
      lines.draw(line_program, view, geometry.frame(), how, unit);
    }
    if (view.volume && shows_planes(*view.volume)) {
      update_volume(view);
      volume->draw_planes(block);
    }
    if (view.surfaces.empty() && !surfaces) return;
    if (!surfaces) surfaces = std::make_unique<SurfacePass>();
    surfaces->update(view.surfaces, geometry.frame());
    SurfaceColors colors{
        .style = view.style, .range = lines.legend().range, .contour_width = std::max(1.0F, 1.6F * unit)};
    if (view.color_lens) {
      colors.lens_center = Vec3f(geometry.frame().scene_from_data(view.color_lens->center));
      colors.lens_radius =
          static_cast<float>(view.color_lens->radius * power_of_two(-geometry.frame().exponent));
      colors.lens_style = view.color_lens->style;
      colors.lens_range = lines.legend().lens_range;
    }
    surfaces->draw(colors);
  }

  void update_volume(const SceneView& view) {
    if (!volume) volume = std::make_unique<VolumePass>();
    volume->update(*view.volume, geometry.frame(), block);
  }

  // Has the volume show transparent lines in it: those that what is opaque by now does not hide.
  void show_layers(const SceneView& view, const LineDraw& base, float unit) {
    std::optional<LayeredLines> wanted = LayeredLines::of(view);
    const auto draw = [&] { lines.draw(layer_program, view, geometry.frame(), base, unit); };
    if (wanted && !layers.collect(target.scene_width(), target.scene_height(), draw)) wanted.reset();
    if (!wanted) layers = {};
    if (!volume) volume = std::make_unique<VolumePass>();
    volume->show_layers(wanted ? &layers : nullptr, wanted == layered);
    layered = std::move(wanted);
  }

  // Behind and between opaque things, by their depths, into the framebuffer that is bound, and with it the
  // transparent lines in it.
  void draw_volume(const SceneView& view, const LineDraw& base, float unit) {
    show_layers(view, base, unit);
    update_volume(view);
    const std::uint32_t opaque_depth = target.copy_depth();
    if (!keeps_for_error) return volume->draw(opaque_depth, block, stop);
    StillPicture kept{
        .behind = read_picture(), .opaque_depth = opaque_depth, .sharp = std::exchange(behind_sharp, {})};
    volume->draw(opaque_depth, block, stop);
    kept.shown = read_picture();
    kept.resolution = static_cast<double>(block.size.y) / kept.shown.height;
    kept.block = block;
    kept.block.size.x = static_cast<float>(kept.shown.width);
    kept.block.size.y = static_cast<float>(kept.shown.height);
    kept.block.size.z = static_cast<float>(block.size.z * kept.resolution);
    estimates.keep(std::move(kept), geometry.frame());
    estimated = view;
    estimated->volume.reset();
  }

  // What is opaque in the picture that is estimated, without tracts and planes, from a share of its pixels along either edge:
  // lines are no thinner than a pixel there.
  Image opaque_part(const Image& picture, double share) {
    RenderTarget other;
    std::swap(target, other);
    const FrameBlock whole = block;
    target.resize(picture.width, picture.height, share);
    const Start start = begin_eye(*estimated, picture.width, picture.height);
    target.bind_scene();
    draw_still_part(*estimated, start.base, start.unit, start.transform);
    Image image = read_picture();
    std::swap(target, other);
    block = whole;
    return image;
  }

  // What lies behind the volume, in all pixels of a picture that has fewer: errors are against it. Transparent lines lie in
  // the volume, and stay as they are drawn.
  void keep_behind_sharp(SceneView view, int width, int height, double tract_milliseconds) {
    view.volume->shown = false;
    view.labels.clear();
    const bool keeps = std::exchange(keeps_for_error, false);
    std::swap(target, sharp);
    draw_eye(view, width, height, 1.0, tract_milliseconds);
    behind_sharp = BehindSharp{.behind = read_picture(), .opaque_depth = target.copy_depth()};
    std::swap(target, sharp);
    keeps_for_error = keeps;
    still.reset();
  }

  // What draws nothing of a picture, but asks for rays.
  template <typename Work>
  static bool beside_pictures(const Work& work) {
    const bool more = work();
    glBindVertexArray(0);
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return more;
  }

  // What the scene's framebuffer shows now, which stays bound.
  Image read_picture() {
    const FramebufferGuard before;
    target.resolve();
    return target.read();
  }

  // With a probe, or with tracts that there is no time for in one picture, what stays is drawn once and kept;
  // each picture begins with a copy of it. Tracts, and the probe's path, are added to it bit by bit. The
  // order is that of drawing everything, so the picture is the same. The volume, which the probe is in, comes
  // last; it may keep a picture of its own.
  void draw_over_still_part(const SceneView& view, const LineDraw& base, float unit,
                            const ViewTransform& transform, double tract_milliseconds) {
    const bool other_path = view.probe && update_probe(view);
    const bool lacks = volume && draws_volume && !volume->bricks().complete();
    const bool other =
        other_path || lacks || !still || !same_still_part(*still, view) || still_detail != line_detail;
    const bool has_tracts =
        other ? tracts.begin(view, geometry.frame(), tract_milliseconds) : view.tracts.has_value();
    // What shines lies over the tracts, and transparent ones are shown when there are enough of them: these
    // grow unseen.
    const bool unseen = has_tracts && (shows_volume(view) || view.tracts->opacity < 1.0);
    target.bind_still();
    if (unseen) target.bind_growing();
    if ((has_tracts && tracts.begins_anew()) || other) draw_still_part(view, base, unit, transform);
    if (has_tracts) tracts.draw(view, base, unit, tract_milliseconds, stop_tracts);
    made_still = other;
    if (other) {
      still = view;
      still_detail = line_detail;
      still_path = 0;
    }
    const bool grown = unseen && show_growing(other);
    if (view.probe) {
      // Over a slice nothing hides what is being drawn, tracts that have come since neither.
      if (view.slice) {
        if (tracts.share().milliseconds > 0.0) still_path = 0;
        glDepthMask(GL_TRUE);
        glClear(GL_DEPTH_BUFFER_BIT);
      }
      still_path = probe->draw_settled_path(line_program, view, unit, still_path);
    }
    target.copy_still_to_scene();
    target.bind_scene();
    if (view.probe) {
      probe->draw_path_end(line_program, view, unit);
      probe->draw(line_program, view, base, unit);
    }
    if (!shows_volume(view)) return;
    if (grown) {
      time_volume(view, base, unit);
    } else {
      draw_volume(view, base, unit);
    }
    if (view.probe) probe->draw_through(line_program, view, base, unit);
  }

  // Takes over what has grown, where it is worth it: rays through a volume take no more time than tracts.
  // @return whether it has.
  bool show_growing(bool first) {
    target.bind_still();
    if (!tracts.show(first, volume_ms)) return false;
    target.copy_growing_to_still();
    still_path = 0;
    return true;
  }

  // As draw_volume(), over tracts that have come to stay.
  void time_volume(const SceneView& view, const LineDraw& base, float unit) {
    if (volume) volume->forget(PictureCache::kVolume);
    glFinish();
    const Stopwatch watch;
    draw_volume(view, base, unit);
    glFinish();
    volume_ms = 1e3 * watch.seconds();
  }

  // What all of a picture is drawn with; its uniform block stays bound as long as this lives.
  struct Start {
    ViewTransform transform;
    LineDraw base;
    float unit = 0.0F;  // of widths: a thousandth of the height
    GlBuffer uniforms;
  };
  // For a picture into the target as it is. @pre its geometry is up to date.
  Start begin_eye(const SceneView& view, int width, int height) {
    const double aspect = static_cast<double>(width) / height;
    Box drawn = geometry.reach();
    include_labels(view.labels, view.camera.axes, drawn);
    Start start{.transform = view_transform(view.camera, geometry.frame(), drawn, aspect)};
    const bool perspective = view.camera.projection == Projection::kPerspective;
    // Lines are drawn in pixels of the scene's framebuffer, which may be coarser than the picture's.
    const int scene_height = target.scene_height();
    const double pixel = start.transform.view_height / scene_height;
    block = make_frame_block(view.camera, start.transform, palette_of(view.background), view.style.depth_cue,
                             target.scene_width(), scene_height);
    start.uniforms = make_buffer(std::span<const FrameBlock>(&block, 1));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, start.uniforms.name());

    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_MULTISAMPLE);
    start.unit = static_cast<float>(scene_height) / 1000.0F;
    start.base.tolerance = line_tolerance(start.transform, perspective, pixel);
    start.base.back = Vec3f(view.camera.axes[2]);
    start.base.clip_from_scene = start.transform.clip_from_scene;
    start.base.pixel = static_cast<float>(pixel);
    return start;
  }

  // The picture of one eye, into the target's plain framebuffer.
  void draw_eye(const SceneView& view, int width, int height, double resolution, double tract_milliseconds) {
    if (target.resize(width, height, resolution)) still.reset();
    if (geometry.update(view)) still.reset();
    if (lines.update_colors(view)) still.reset();
    draws_volume = shows_volume(view);

    const Start start = begin_eye(view, width, height);
    const auto& [transform, base, unit, uniforms] = start;
    if (view.probe || (view.tracts && std::isfinite(tract_milliseconds))) {
      draw_over_still_part(view, base, unit, transform, tract_milliseconds);
    } else {
      still.reset();
      made_still = false;
      target.bind_scene();
      draw_still_part(view, base, unit, transform);
      if (tracts.begin(view, geometry.frame(), tract_milliseconds))
        tracts.draw(view, base, unit, tract_milliseconds, stop_tracts);
      if (shows_volume(view)) draw_volume(view, base, unit);
    }
    if (!draws_volume && layered) {
      layered.reset();
      layers = {};
    }
    // Where more of them lie in a volume than there is room for, they are drawn over it.
    if (is_transparent(view) && !layered) lines.draw(line_program, view, geometry.frame(), base, unit);
    if (!view.labels.empty()) {
      if (!labels) labels = std::make_unique<LabelPass>();
      labels->draw(view.labels, geometry.frame(), view.camera.axes);
    }

    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
    glUseProgram(0);
    target.resolve();
    target.bind_resolved();
    if (has_overlay(view)) {
      lines.legend().has_lines = has_colored_lines(view);
      if (!overlay) overlay = std::make_unique<Overlay>();
      overlay->draw(view, lines.legend(), width, height);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }
};

SceneRenderer::SceneRenderer() : state_(std::make_unique<State>()) {}
SceneRenderer::~SceneRenderer() = default;

bool SceneRenderer::draw(const SceneView& view, int width, int height, double resolution,
                         double tract_milliseconds, const std::function<bool()>& stop_tracts,
                         const std::function<bool()>& stop) {
  State& s = *state_;
  s.stop_tracts = stop_tracts;
  s.stop = {};
  s.estimates.forget();
  s.compiled_before = compiled_programs();
  s.timer.begin();
  if (!has_two_eyes(view)) {
    s.stereo.reset();
    s.stop = stop;
    try {
      if (s.keeps_for_error && resolution < 1.0 && shows_volume(view) && !is_transparent(view))
        s.keep_behind_sharp(view, width, height, tract_milliseconds);
      s.draw_eye(view, width, height, resolution, tract_milliseconds);
    } catch (const DrawingStopped&) {
      s.still.reset();
      glBindVertexArray(0);
      glUseProgram(0);
      glBindFramebuffer(GL_FRAMEBUFFER, 0);
      return false;
    }
    return true;
  }
  if (!s.stereo) s.stereo = std::make_unique<StereoPass>();
  s.stereo->begin(view.stereo.mode, width, height);
  s.stop_tracts = {};
  SceneView seen = view;
  if (seen.volume) seen.volume->cache_picture = false;  // the eyes take turns
  const StereoEyes eyes = stereo_eyes(view.camera, view.stereo, view.bounds);
  for (std::size_t i = 0; i < eyes.cameras.size(); ++i) {
    seen.camera = eyes.cameras[i];
    s.still.reset();
    s.draw_eye(seen, s.stereo->eye_size().width, s.stereo->eye_size().height, resolution, HUGE_VAL);
    s.stereo->keep(view.stereo.swapped ? 1 - i : i, s.target.resolved());
  }
  s.stereo->compose(view.stereo.first);
  return true;
}

void SceneRenderer::set_line_detail(double share) {
  PALPATE_CHECK(share > 0.0 && share <= 1.0);
  state_->line_detail = share;
}

bool SceneRenderer::complete() const noexcept { return state_->tracts.complete() && bricks().complete(); }

BrickShare SceneRenderer::bricks() const noexcept {
  return state_->draws_volume && state_->volume ? state_->volume->bricks() : BrickShare{};
}

TractShare SceneRenderer::tract_share() const noexcept { return state_->tracts.share(); }

std::optional<CoarserVoxels> SceneRenderer::coarser_voxels() const noexcept {
  return state_->volume ? state_->volume->coarser_voxels() : std::nullopt;
}

bool SceneRenderer::prepare_slabs(std::size_t cut) {
  State& s = *state_;
  if (!s.volume || s.stereo) return false;
  return State::beside_pictures([&] {
    const GlBuffer frame_buffer = make_buffer(std::span<const FrameBlock>(&s.block, 1));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer.name());
    s.target.bind_scene();
    return s.volume->prepare_slabs(cut);
  });
}

void SceneRenderer::keep_for_error(bool on) { state_->keeps_for_error = on; }

bool SceneRenderer::estimate_error() {
  State& s = *state_;
  if (!s.estimates.kept() || !complete()) return false;
  return State::beside_pictures([&] { return s.estimates.add_to_error(*s.volume); });
}

std::optional<ImageError> SceneRenderer::image_error() const { return state_->estimates.error(); }

bool SceneRenderer::estimate_savings() {
  State& s = *state_;
  if (!s.estimates.kept() || !complete()) return false;
  return State::beside_pictures([&] {
    return s.estimates.add_saving(
        *s.volume, [&](const Image& picture, double share) { return s.opaque_part(picture, share); });
  });
}

std::optional<QualityErrors> SceneRenderer::quality_errors() const {
  return state_->estimates.quality_errors();
}

bool SceneRenderer::refine(int doublings) {
  State& s = *state_;
  if (!s.draws_volume || !s.volume || s.stereo || !complete()) return false;
  return State::beside_pictures([&] {
    const GlBuffer frame_buffer = make_buffer(std::span<const FrameBlock>(&s.block, 1));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer.name());
    return s.volume->refine(doublings);
  });
}

std::string SceneRenderer::tables_by() const {
  return state_->draws_volume && state_->volume ? state_->volume->cost().tables_by : std::string();
}

bool SceneRenderer::made(PictureCache cache) const noexcept {
  const State& s = *state_;
  if (cache == PictureCache::kStillPart) return s.made_still;
  return s.draws_volume && s.volume && s.volume->made(cache);
}

bool SceneRenderer::compiled() const noexcept { return compiled_programs() > state_->compiled_before; }

void SceneRenderer::forget(PictureCache cache) noexcept {
  if (cache == PictureCache::kStillPart) state_->still.reset();
  if (state_->volume) state_->volume->forget(cache);
}

double SceneRenderer::finish() { return state_->timer.finish(); }

void SceneRenderer::leave() { state_->timer.leave(); }

double SceneRenderer::gpu_milliseconds() const noexcept { return state_->timer.milliseconds(); }

bool SceneRenderer::timed_by_query() const noexcept { return state_->timer.by_query(); }

Image SceneRenderer::read() const { return state_->stereo ? state_->stereo->read() : state_->target.read(); }

void SceneRenderer::show(int left, int bottom, std::uint32_t framebuffer) const {
  if (state_->stereo) {
    state_->stereo->show(left, bottom, framebuffer);
  } else {
    state_->target.show(left, bottom, framebuffer);
  }
}

ValueRange SceneRenderer::range() const { return state_->lines.legend().range; }

}  // namespace palpate
