#include "common/window/picture/live_picture.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/base/clock.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/estimate/image_error.h"

namespace palpate {
namespace {

// Of a volume of more the first picture is as coarse as there is: in all detail it takes over a second on processors.
constexpr std::size_t kManyVoxels = std::size_t{1} << 24;
// Pictures' worth of tracts that are added at once while nothing else happens.
constexpr double kPatientPictures = 5.0;
// A lens that has not moved for so long stands still: its picture is drawn sharp [s].
constexpr double kLensRest = 0.3;
// What is kept of a plane while it moves is given back after so long a rest [s].
constexpr double kSlabRest = 5.0;
// After so long what was refined so far is shown; whoever comes up waits for a part of it alone [s].
constexpr double kRefineSlice = 0.5;
// Of two eyes: what a picture may take [ms].
constexpr double kFinestPicture = 1000.0;
// So long may panels wait while pictures are made that nobody waits for [s].
constexpr double kPrepareSlice = 0.05;
// Of a volume in bricks, for one picture: some 10 ms [bytes].
constexpr std::uint64_t kBrickUpload = std::uint64_t{8} << 20;

}  // namespace

void LivePicture::draw(SceneView view, int width, int height, const PictureMoment& moment) {
  const double rest_time = moment.seconds - moved_;
  if (moment.editing && is_edited(view)) edited_ = moment.seconds;
  asked_ = view.volume;
  const bool volume = view.volume && view.volume->shown;
  const bool unseen = volume && view.volume->image->point_count() > kManyVoxels &&
                      !(shown_.volume && shown_.volume->image == view.volume->image);
  const bool moving = unseen || moment.moving || rest_time < kLensRest ||
                      (moment.editing && moment.seconds - edited_ < kLensRest);
  budget_.show(volume, volume && !view.volume->lenses.empty());
  if (moving && !std::exchange(moving_, moving)) budget_.begin();
  moving_ = moving;
  const FrameQuality quality = unseen ? budget_.levels().back() : moving ? budget_.quality() : FrameQuality{};
  view = with_quality(std::move(view), quality);
  if (view.volume) {
    view.volume->storage.upload = kBrickUpload;
    if (!stands(view, width, height)) begin_rest();
    resting_ = view.volume;
    resting_camera_ = view.camera;
    if (!moving && finer_ > 0 && has_two_eyes(view)) view.volume = finer_view(*view.volume, finer_);
    view.volume->cache_picture = !moving && local_.on();
  }
  const bool wants_error = volume && !moving && !error_known_ && moment.interrupted;
  if (dirty_ || (wants_error && !estimating_) || width != width_ || height != height_ ||
      !same_picture(view, shown_) || quality.resolution != figures_.quality.resolution ||
      quality.detail != figures_.quality.detail || !renderer_.complete()) {
    const bool patient = !moving && moment.interrupted;
    renderer_.keep_for_error(wants_error);
    estimating_ = wants_error;
    renderer_.set_line_detail(quality.detail);
    const bool stays = !moving && width == width_ && height == height_;
    left_ = !renderer_.draw(view, width, height, quality.resolution,
                            (patient ? kPatientPictures : 1.0) * tract_time_.milliseconds(moving),
                            patient ? moment.interrupted : nullptr, stays ? moment.stop : nullptr);
    if (left_) {
      dirty_ = true;
      estimating_ = saving_ = preparing_ = refining_ = false;
      return;
    }
    figures_.milliseconds = renderer_.finish();
    figures_.tracts = renderer_.tract_share();
    figures_.coarser_voxels = renderer_.coarser_voxels();
    figures_.bricks = renderer_.bricks();
    if (moving) {
      tract_time_.drawn(figures_.milliseconds, figures_.tracts.milliseconds);
      // Nothing rests while a picture of how it moved is made.
      moved_ += 1e-3 * figures_.milliseconds;
      edited_ += 1e-3 * figures_.milliseconds;
    }
    figures_.expected_error = moving && volume ? budget_.expected_error() : std::nullopt;
    // A picture that keeps slabs for the next ones, or compiles shaders, says nothing of their time.
    if (moving && !renderer_.made(PictureCache::kSlabs) && !renderer_.compiled())
      budget_.drawn(renderer_.gpu_milliseconds());
    if (!moving && finer_ == 0) budget_.rested(renderer_.gpu_milliseconds());
    if (volume && view.volume->cache_picture &&
        local_.drawn(figures_.milliseconds, renderer_.made(PictureCache::kVolume))) {
      renderer_.forget(PictureCache::kVolume);
      refined_ = passing_ = error_known_ = false;
      finer_ = 0;
    }
    figures_.quality = quality;
    milliseconds_.push_back(figures_.milliseconds);
    figures_.frames_per_second = moment.seconds > last_drawn_ ? 1.0 / (moment.seconds - last_drawn_) : 0.0;
    last_drawn_ = moment.seconds;
    figures_.automatic_range.reset();
    if (view.lines && !view.lines->empty()) figures_.automatic_range = renderer_.range();
    shown_ = std::move(view);
    width_ = width;
    height_ = height;
    dirty_ = false;
  }
  preparing_ = refining_ = false;
  left_ = unseen;
  if (moving) {
    estimating_ = saving_ = false;
  } else {
    rest(moment, volume);
    if (!preparing_ && rest_time > kSlabRest) renderer_.forget(PictureCache::kSlabs);
  }
}

// Whether what is known of the last picture is true of this one: its volume, seen from the same place.
bool LivePicture::stands(const SceneView& view, int width, int height) const {
  return resting_ && resting_camera_ == view.camera && width == width_ && height == height_ &&
         same_picture(*resting_, *view.volume);
}

void LivePicture::begin_rest() {
  local_.begin();
  figures_.error.reset();
  error_known_ = savings_known_ = saving_ = refined_ = passing_ = false;
  finer_ = 0;
}

// What is done while nobody waits, one thing after the other.
void LivePicture::rest(const PictureMoment& moment, bool volume) {
  if (!moment.interrupted || !volume || !renderer_.complete()) {
    estimating_ = saving_ = false;
    return;
  }
  estimate_error(moment);
  if (!estimating_) estimate_savings(moment);
  if (moment.next_cut) prepare(moment);
  if (!estimating_ && !saving_ && !preparing_) refine(moment);
}

// Whether a panel has changed how the same volume is shown.
bool LivePicture::is_edited(const SceneView& view) const {
  return view.volume && asked_ && view.volume->image == asked_->image && !same_picture(*view.volume, *asked_);
}

// The picture is told with what is known so far.
void LivePicture::estimate_error(const PictureMoment& moment) {
  if (!estimating_) return;
  const Stopwatch watch;
  do {
    estimating_ = renderer_.estimate_error();
    figures_.error = renderer_.image_error();
  } while (estimating_ && !moment.interrupted() && watch.seconds() < kPrepareSlice);
  error_known_ = !estimating_;
  saving_ = error_known_ && !savings_known_;
}

// For when it moves next.
void LivePicture::estimate_savings(const PictureMoment& moment) {
  if (!saving_) return;
  const Stopwatch watch;
  do {
    saving_ = renderer_.estimate_savings();
  } while (saving_ && !moment.interrupted() && watch.seconds() < kPrepareSlice);
  const std::optional<QualityErrors> errors = renderer_.quality_errors();
  if (errors) budget_.learn(*errors);
  savings_known_ = errors.has_value();
}

// Where planes move in coarser pictures, what is kept of full ones is of no use to them.
void LivePicture::prepare(const PictureMoment& moment) {
  if (budget_.quality() != FrameQuality{}) return;
  const Stopwatch watch;
  do {
    preparing_ = renderer_.prepare_slabs(*moment.next_cut);
    renderer_.finish();
  } while (preparing_ && !moment.interrupted() && watch.seconds() < kPrepareSlice);
}

// With twice the samples, and twice again, until no pixel would change: two eyes in whole pictures, as far as
// these come soon, one tile by tile.
void LivePicture::refine(const PictureMoment& moment) {
  if (refined_ || !error_known_ || !figures_.error || is_converged(*figures_.error)) return;
  const bool two_eyes = has_two_eyes(shown_);
  if (!std::exchange(passing_, true)) ++finer_;
  if (two_eyes) {
    refined_ = finer_ > most_doublings(*resting_) || 2.0 * figures_.milliseconds > kFinestPicture;
    if (refined_) --finer_;
    passing_ = false;
  } else {
    const Stopwatch watch;
    do {
      passing_ = renderer_.refine(finer_);
      renderer_.finish();
    } while (passing_ && !moment.interrupted() && watch.seconds() < kRefineSlice);
    refined_ = !passing_ && finer_ >= most_doublings(*resting_);
  }
  error_known_ = passing_ || (two_eyes && refined_);
  refining_ = !(two_eyes && refined_);
  dirty_ = refining_;
}

double LivePicture::median_milliseconds() const {
  if (milliseconds_.empty()) return 0.0;
  std::vector<double> sorted = milliseconds_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace palpate
