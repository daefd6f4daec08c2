#include "common/hand/probe_series.h"

#include <cmath>
#include <limits>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/scene/time_series.h"

namespace palpate {
namespace {

// A curve that has been begun is finished within this time, or makes way for that of another place [s].
constexpr double kSeriesPatience = 0.3;
// Time between two pictures of a curve that grows [s].
constexpr double kGrowth = 0.05;
// Of the data's diagonal.
constexpr double kSamePlace = 1e-3;

}  // namespace

std::vector<std::size_t> coarse_to_fine(std::size_t count) {
  if (count == 0) return {};
  std::vector<std::size_t> order{0};
  std::vector<bool> taken(count);
  taken[0] = true;
  const auto take = [&](std::size_t i) {
    if (!taken[i]) order.push_back(i);
    taken[i] = true;
  };
  take(count - 1);
  std::size_t stride = 1;
  while (stride < count) stride *= 2;
  for (; stride > 0; stride /= 2)
    for (std::size_t i = stride; i < count; i += stride) take(i);
  return order;
}

/// An open input, and the steps of it that are kept.
class ProbeSeries::Reader {
 public:
  Reader(const Wanted& wanted, Progress& progress)
      : choice_(wanted.choice),
        series_(Input::open(wanted.input, &progress), wanted.value, wanted.threads),
        kept_(series_.times().size()),
        order_(coarse_to_fine(kept_.size())) {}

  [[nodiscard]] std::uint64_t choice() const noexcept { return choice_; }
  [[nodiscard]] const std::vector<std::size_t>& order() const noexcept { return order_; }
  [[nodiscard]] SeriesCurve begin(const Vec3& place) const {
    return {.name = series_.name(),
            .place = place,
            .times = series_.times(),
            .values = std::vector<double>(kept_.size(), std::numeric_limits<double>::quiet_NaN()),
            .read = 0,
            .problem = {}};
  }
  [[nodiscard]] std::shared_ptr<const ScalarField> step(std::size_t index, bool keep, Progress& progress) {
    if (!keep) kept_.assign(kept_.size(), nullptr);
    if (kept_[index]) return kept_[index];
    auto field = series_.read(index, &progress);
    if (keep) kept_[index] = field;
    return field;
  }

 private:
  std::uint64_t choice_;
  TimeSeries series_;
  std::vector<std::shared_ptr<const ScalarField>> kept_;
  std::vector<std::size_t> order_;
};

ProbeSeries::ProbeSeries(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

ProbeSeries::~ProbeSeries() {
  const std::lock_guard lock(mutex_);
  thread_.request_stop();
  if (progress_) progress_->cancel();
}

void ProbeSeries::choose(const InputOptions& input, const std::string& value, int threads) {
  const std::lock_guard lock(mutex_);
  ++wanted_.choice;
  wanted_.input = input;
  wanted_.value = value;
  wanted_.threads = threads;
  curve_ = {.name = value, .place = {}, .times = {}, .values = {}, .read = 0, .problem = {}};
  moved_ = 0.0;
  due_ = true;
  if (progress_) progress_->cancel();
  asked_.notify_one();
}

void ProbeSeries::request(const Vec3& place) {
  const std::lock_guard lock(mutex_);
  if (!is_finite(place) || (wanted_.place && glm::distance(place, *wanted_.place) <= moved_)) return;
  wanted_.place = place;
  due_ = true;
  asked_.notify_one();
}

void ProbeSeries::keep_steps(bool keep) {
  const std::lock_guard lock(mutex_);
  if (wanted_.keep == keep) return;
  wanted_.keep = keep;
  due_ = true;
  asked_.notify_one();
}

SeriesCurve ProbeSeries::curve() const {
  const std::lock_guard lock(mutex_);
  return curve_;
}

bool ProbeSeries::reading() const {
  const std::lock_guard lock(mutex_);
  return !wanted_.value.empty() && wanted_.place.has_value() && (due_ || busy_);
}

bool ProbeSeries::current(const Wanted& wanted, double seconds) const {
  const std::lock_guard lock(mutex_);
  return wanted.choice == wanted_.choice && (!due_ || seconds < kSeriesPatience);
}

void ProbeSeries::publish(const Wanted& wanted, const SeriesCurve& curve) {
  {
    const std::lock_guard lock(mutex_);
    if (wanted.choice != wanted_.choice) return;
    curve_ = curve;
  }
  wake_();
}

void ProbeSeries::fill(Reader& reader, const Wanted& wanted, Progress& progress,
                       const std::stop_token& stop) {
  SeriesCurve curve = reader.begin(*wanted.place);
  const Stopwatch whole;
  Stopwatch shown;
  CellHint hint;
  for (const std::size_t index : reader.order()) {
    if (stop.stop_requested() || !current(wanted, whole.seconds())) return;
    const auto field = reader.step(index, wanted.keep, progress);
    curve.values[index] = value_or_nan(*field, *wanted.place, hint);
    if (++curve.read == 1) {
      const std::lock_guard lock(mutex_);
      moved_ = kSamePlace * field->diagonal();
    }
    if (shown.seconds() < kGrowth) continue;
    publish(wanted, curve);
    shown.restart();
  }
  publish(wanted, curve);
}

void ProbeSeries::run(const std::stop_token& stop) {
  std::unique_ptr<Reader> reader;
  for (;;) {
    Wanted wanted;
    std::shared_ptr<Progress> progress;
    {
      std::unique_lock lock(mutex_);
      busy_ = false;
      if (!asked_.wait(lock, stop, [this] { return due_; })) return;
      due_ = false;
      busy_ = true;
      wanted = wanted_;
      progress = progress_ = std::make_shared<Progress>();
    }
    if (reader && reader->choice() != wanted.choice) reader.reset();
    try {
      if (wanted.value.empty() || !wanted.place) continue;  // opened when there is a place to read at
      if (!reader) reader = std::make_unique<Reader>(wanted, *progress);
      fill(*reader, wanted, *progress, stop);
    } catch (const Cancelled&) {
      reader.reset();  // another choice has come
    } catch (const std::exception& error) {
      reader.reset();
      publish(
          wanted,
          {.name = wanted.value, .place = {}, .times = {}, .values = {}, .read = 0, .problem = error.what()});
    }
  }
}

}  // namespace palpate
