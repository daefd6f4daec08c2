#include "common/hand/drawn/local_lines.h"

#include <exception>
#include <utility>

#include "common/trace/trace.h"

namespace palpate {
namespace {

// What is looked at for a moment need not be traced to the last digit.
constexpr double kTolerance = 1e-4;

std::shared_ptr<const LineArray> along(const LineArray& array, const std::vector<Line>& lines) {
  auto values = std::make_shared<LineArray>();
  values->name = array.name;
  values->unit = array.unit;
  for (const Line& line : lines) {
    CellHint hint;
    for (const LinePoint& point : line.points)
      values->values.push_back(static_cast<float>(array.at(point.position, hint)));
  }
  return values;
}

std::shared_ptr<const LocalSeeds> trace(const LocalRequest& request) {
  auto local = std::make_shared<LocalSeeds>();
  local->shape = request.shape;
  local->seeds = local_seeds(request);
  if (request.shape == SeedShape::kRake) {
    local->origin = request.center - request.along;
    local->u = 2.0 * request.along;
  } else {
    local->origin = request.center - request.along - request.across;
    local->u = 2.0 * request.along;
    local->v = 2.0 * request.across;
  }
  TraceOptions options;
  options.backward = true;
  options.tolerance = kTolerance;
  options.max_length = request.length;
  options.threads = 1;
  local->lines =
      std::make_shared<const std::vector<Line>>(trace_lines(*request.field, local->seeds, options).lines);
  if (request.array && request.array->at) local->array = along(*request.array, *local->lines);
  return local;
}

}  // namespace

std::vector<Vec3> local_seeds(const LocalRequest& request) {
  std::vector<Vec3> seeds;
  const int n = request.seeds;
  const auto place = [n](int i) { return n > 1 ? 2.0 * i / (n - 1) - 1.0 : 0.0; };
  const int rows = request.shape == SeedShape::kPlane ? n : 1;
  for (int j = 0; j < rows; ++j) {
    const Vec3 row = request.shape == SeedShape::kPlane ? place(j) * request.across : Vec3{0.0};
    for (int i = 0; i < n; ++i) seeds.push_back(request.center + row + place(i) * request.along);
  }
  return seeds;
}

LocalLines::LocalLines(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void LocalLines::request(const LocalRequest& request) {
  if (request == asked_) return;
  asked_ = request;
  const std::lock_guard lock(mutex_);
  shape_ = request.shape;
  if (request.shape == SeedShape::kNone || !request.field || !is_finite(request.center)) {
    waiting_.reset();
    drawn_.reset();
    return;
  }
  waiting_ = request;
  wanted_.notify_one();
}

std::shared_ptr<const LocalSeeds> LocalLines::drawn() {
  const std::lock_guard lock(mutex_);
  return drawn_;
}

void LocalLines::run(const std::stop_token& stop) {
  for (;;) {
    LocalRequest request;
    {
      std::unique_lock lock(mutex_);
      if (!wanted_.wait(lock, stop, [this] { return waiting_.has_value(); })) return;
      request = *std::exchange(waiting_, std::nullopt);
    }
    std::shared_ptr<const LocalSeeds> local;
    try {
      local = trace(request);
    } catch (const std::exception&) {
      continue;  // a rake that cannot be traced here is not drawn
    }
    {
      const std::lock_guard lock(mutex_);
      if (shape_ == request.shape) drawn_ = std::move(local);  // not if it was switched off meanwhile
    }
    wake_();
  }
}

}  // namespace palpate
