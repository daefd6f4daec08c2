#include "common/app/window/live_picture.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/base/clock.h"

namespace palpate {
namespace {

// Pictures' worth of tracts that are added at once while nothing else happens.
constexpr double kPatientPictures = 5.0;
// A lens that has not moved for so long stands still: its picture is drawn sharp [s].
constexpr double kLensRest = 0.3;
// What is kept of a plane while it moves is given back after so long a rest [s].
constexpr double kSlabRest = 5.0;
// So long may panels wait while pictures are made that nobody waits for [s].
constexpr double kPrepareSlice = 0.05;
// Of a volume in bricks, for one picture: some 10 ms [bytes].
constexpr std::uint64_t kBrickUpload = std::uint64_t{8} << 20;

}  // namespace

void LivePicture::draw(SceneView view, int width, int height, const PictureMoment& moment) {
  const double rest = moment.seconds - lens_moved_;
  if (moment.editing && is_edited(view)) edited_ = moment.seconds;
  asked_ = view.volume;
  const bool moving =
      moment.moving || rest < kLensRest || (moment.editing && moment.seconds - edited_ < kLensRest);
  const bool volume = view.volume && view.volume->shown;
  budget_.show(volume, volume && !view.volume->lenses.empty());
  const FrameQuality quality = moving ? budget_.quality() : FrameQuality{};
  view = with_quality(std::move(view), quality);
  if (view.volume) {
    view.volume->storage.upload = kBrickUpload;
    const bool stands = shown_.volume && shown_.camera == view.camera &&
                        same_picture(*shown_.volume, *view.volume) && width == width_ && height == height_;
    if (!stands) {
      local_.begin();
      figures_.error.reset();
      error_known_ = false;
    }
    view.volume->keep_picture = !moving && local_.on();
  }
  const bool wants_error = volume && !moving && !error_known_ && moment.interrupted;
  if (dirty_ || (wants_error && !estimating_) || width != width_ || height != height_ ||
      !same_picture(view, shown_) || quality.resolution != figures_.quality.resolution ||
      !renderer_.complete()) {
    const bool patient = !moving && moment.interrupted;
    renderer_.keep_for_error(wants_error);
    estimating_ = wants_error && !has_two_eyes(view);
    error_known_ = error_known_ || (wants_error && !estimating_);
    renderer_.draw(view, width, height, quality.resolution,
                   (patient ? kPatientPictures : 1.0) * tract_time_.milliseconds(moving),
                   patient ? moment.interrupted : nullptr);
    figures_.milliseconds = renderer_.finish();
    figures_.tracts = renderer_.tract_share();
    figures_.coarser_voxels = renderer_.coarser_voxels();
    figures_.bricks = renderer_.bricks();
    if (moving) tract_time_.drawn(figures_.milliseconds, figures_.tracts.milliseconds);
    // A picture that keeps slabs for the next ones says nothing of their time.
    if (moving && !renderer_.made_slabs()) budget_.drawn(renderer_.gpu_milliseconds());
    if (volume && view.volume->keep_picture && local_.drawn(figures_.milliseconds, renderer_.kept_volume()))
      renderer_.forget_volume();
    figures_.quality = quality;
    milliseconds_.push_back(figures_.milliseconds);
    figures_.frames_per_second = moment.seconds > last_drawn_ ? 1.0 / (moment.seconds - last_drawn_) : 0.0;
    last_drawn_ = moment.seconds;
    figures_.automatic_range = renderer_.range();
    shown_ = std::move(view);
    width_ = width;
    height_ = height;
    dirty_ = false;
  }
  preparing_ = false;
  if (moving) {
    estimating_ = false;
    return;
  }
  estimate_error(moment);
  if (moment.next_cut && volume) {
    prepare(moment);
  } else if (rest > kSlabRest) {
    renderer_.forget_slabs();
  }
}

// Whether a panel has changed how the same volume is shown.
bool LivePicture::is_edited(const SceneView& view) const {
  return view.volume && asked_ && view.volume->image == asked_->image && !same_picture(*view.volume, *asked_);
}

// While nobody waits; the picture is told with what is known so far.
void LivePicture::estimate_error(const PictureMoment& moment) {
  if (!estimating_ || !moment.interrupted || !renderer_.complete()) return;
  const Stopwatch watch;
  do {
    estimating_ = renderer_.estimate_error();
    figures_.error = renderer_.image_error();
  } while (estimating_ && !moment.interrupted() && watch.seconds() < kPrepareSlice);
  error_known_ = !estimating_;
}

// Where planes move in coarser pictures, what is kept of full ones is of no use to them.
void LivePicture::prepare(const PictureMoment& moment) {
  if (!moment.interrupted || !renderer_.complete() || budget_.quality() != FrameQuality{}) return;
  const Stopwatch watch;
  do {
    preparing_ = renderer_.prepare_slabs(*moment.next_cut);
    renderer_.finish();
  } while (preparing_ && !moment.interrupted() && watch.seconds() < kPrepareSlice);
}

double LivePicture::median_milliseconds() const {
  if (milliseconds_.empty()) return 0.0;
  std::vector<double> sorted = milliseconds_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace palpate
