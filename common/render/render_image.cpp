#include "common/render/render_image.h"

#include "common/base/ledger.h"
#include "common/render/budget/frame_budget.h"
#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"

namespace palpate {

namespace {

// Draws until frames of `view` keep the budget.
void settle(FrameBudget& budget, SceneRenderer& renderer, const SceneView& view, int width, int height) {
  constexpr int kMostFrames = 120, kStill = 22;  // frames of one quality, by which time it has settled
  const bool volume = view.volume && view.volume->shown;
  budget.show(volume, volume && !view.volume->lenses.empty());
  if (volume) {
    renderer.keep_for_error(true);
    renderer.draw(view, width, height);
    renderer.keep_for_error(false);
    while (renderer.estimate_error()) {
    }
    while (renderer.estimate_savings()) {
    }
    if (const auto errors = renderer.quality_errors()) budget.learn(*errors);
  }
  budget.begin();
  int still = 0;
  for (int i = 0; i < kMostFrames && still < kStill; ++i) {
    const FrameQuality quality = budget.quality();
    renderer.set_line_detail(quality.detail);
    renderer.draw(with_quality(view, quality), width, height, quality.resolution);
    renderer.finish();
    if (!renderer.compiled()) budget.drawn(renderer.gpu_milliseconds());
    still = budget.quality() == quality ? still + 1 : 0;
  }
}

}  // namespace

RenderedImage render_image(const SceneView& view, int width, int height, int repeat, double budget,
                           bool error) {
  Work work("drawing", std::to_string(width) + " x " + std::to_string(height) + " pixels");
  work.takes(std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height));
  OffscreenContext context;
  RenderedImage result;
  result.renderer = gl_description();
  SceneRenderer renderer;
  renderer.draw(view, width, height);
  result.first_frame_ms = renderer.finish();
  if (budget > 0.0) {
    FrameBudget held(budget);
    settle(held, renderer, view, width, height);
    result.quality = held.quality();
    result.expected_error = held.expected_error();
  }
  const SceneView drawn = with_quality(view, result.quality);
  renderer.set_line_detail(result.quality.detail);
  for (int i = 0; i < repeat + (budget > 0.0 ? 1 : 0); ++i) {
    renderer.draw(drawn, width, height, result.quality.resolution);
    const double milliseconds = renderer.finish();
    if (i > 0 || budget == 0.0) result.frame_ms.push_back(milliseconds);
  }
  if (error || renderer.coarser_voxels()) {
    renderer.keep_for_error(true);
    renderer.draw(drawn, width, height, result.quality.resolution);
    while (renderer.estimate_error()) {
    }
    result.error = renderer.image_error();
  }
  result.tables_by = renderer.tables_by();
  result.image = renderer.read();
  result.coarser_voxels = renderer.coarser_voxels();
  result.bricks = renderer.bricks();
  result.timer_query = renderer.timed_by_query();
  result.gpu = gpu_objects();
  enter_gpu_objects(result.gpu, result.tables_by);
  return result;
}

struct ImageSequence::State {
  OffscreenContext context;
  SceneRenderer renderer;
  std::string description = gl_description();
  double milliseconds = 0.0;
};

ImageSequence::ImageSequence() : state_(std::make_unique<State>()) {}
ImageSequence::~ImageSequence() = default;

Image ImageSequence::draw(const SceneView& view, int width, int height) {
  state_->renderer.draw(view, width, height);
  state_->milliseconds = state_->renderer.finish();
  return state_->renderer.read();
}

double ImageSequence::milliseconds() const noexcept { return state_->milliseconds; }
const std::string& ImageSequence::renderer() const noexcept { return state_->description; }

}  // namespace palpate
