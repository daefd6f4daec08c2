#include "common/hand/haptic_data.h"

#include <new>
#include <utility>

#include "common/field/noise_field.h"
#include "common/hand/fixture_view.h"

namespace palpate {

MeasuredNoise::MeasuredNoise(std::function<void()> wake, int threads)
    : wake_(std::move(wake)),
      threads_(threads),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

bool MeasuredNoise::has(const std::shared_ptr<const ScalarField>& field) const {
  return field && measured_.lock() == field;
}

void MeasuredNoise::request(const std::shared_ptr<const ScalarField>& field) {
  const std::lock_guard lock(mutex_);
  if (asked_.lock() == field) return;
  asked_ = field;
  waiting_ = field;
  wanted_.notify_one();
}

std::optional<std::shared_ptr<const ScalarField>> MeasuredNoise::of(
    const std::shared_ptr<const ScalarField>& field) const {
  const std::lock_guard lock(mutex_);
  return has(field) ? std::optional(noise_) : std::nullopt;
}

std::shared_ptr<const ScalarField> MeasuredNoise::wait(const std::shared_ptr<const ScalarField>& field) {
  request(field);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return has(field); });
  return noise_;
}

void MeasuredNoise::run(const std::stop_token& stop) {
  for (;;) {
    std::shared_ptr<const ScalarField> field, noise;
    {
      std::unique_lock lock(mutex_);
      if (!wanted_.wait(lock, stop, [this] { return waiting_ != nullptr; })) return;
      field = std::exchange(waiting_, nullptr);
    }
    try {
      noise = make_noise_field(*field, threads_);
    } catch (const std::bad_alloc&) {
      noise.reset();
    }
    {
      const std::lock_guard lock(mutex_);
      measured_ = field;
      noise_ = std::move(noise);
    }
    done_.notify_all();
    wake_();
  }
}

HapticData::HapticData(double workspace_scale, int threads, std::function<void()> wake)
    : workspace_scale_(workspace_scale), threads_(threads), wake_(std::move(wake)) {}

bool HapticData::is_open(const NamedField& open) const noexcept {
  return open.tensor == open_.tensor && open.field == open_.field &&
         (open.field || open.scalar == open_.scalar);
}

void HapticData::open(NamedField open) {
  open_ = std::move(open);
  if (!local_) local_ = std::make_unique<LocalLines>(wake_);
  if (!surfaces_) surfaces_ = std::make_unique<HapticSurfaces>(wake_);
  if (!noises_) noises_ = std::make_unique<MeasuredNoise>(wake_, threads_);
}

Workspace HapticData::workspace() const {
  const double scale = workspace_scale_ > 0.0 ? workspace_scale_ : Workspace::default_scale(open_.diagonal());
  return {scale, open_.frame()};
}

std::optional<Vec3> HapticData::gradient_at(const Vec3& x) const {
  if (!open_.scalar) return std::nullopt;
  CellHint hint;
  const VectorSample sample = open_.scalar->gradient(x, hint);
  const double size = glm::length(sample.value);
  if (sample.status != SampleStatus::kOk || !(size > 0.0)) return std::nullopt;
  return sample.value / size;
}

std::pair<double, double> HapticData::measure_range(LinearMeasure measure) const {
  constexpr double kSteepPart = 0.125;  // of the diagonal
  std::pair<double, double> values{0.0, open_.field ? open_.field->max_speed() : 0.0};
  if (measure != LinearMeasure::kSpeed && open_.scalar) {
    values = {open_.scalar->lowest(), open_.scalar->highest()};
  }
  if (measure == LinearMeasure::kGradient && !open_.empty()) {
    values = {0.0, (values.second - values.first) / (kSteepPart * open_.diagonal())};
  }
  if (!(values.first < values.second)) return {values.first, values.first + 1.0};  // one value everywhere
  return values;
}

const ScalarStatistics* HapticData::statistics() const {
  if (!open_.scalar) return nullptr;
  if (counted_ != open_.scalar) {
    statistics_ = scalar_statistics(*open_.scalar);
    counted_ = open_.scalar;
  }
  return &statistics_;
}

void HapticData::follow(const HapticChain& made) {
  surfaces_of_ = made.surfaces_of;
  chain_isovalues_ = made.isovalues;
  noise_ = made.noise;
  fixture_views_ = show_fixtures(made.fixtures, workspace(), open_.bounds());
}

HapticLevels HapticData::levels() const {
  if (!surfaces_of_) return {};
  return {surfaces_of_, chosen_.count > 0 ? chosen_ : chain_isovalues_};
}

void HapticData::request_surfaces(bool shown) { surfaces_->request(shown ? levels() : HapticLevels{}); }

HapticSurfaces::Made HapticData::surfaces() const {
  return surfaces_ ? surfaces_->made() : HapticSurfaces::Made{};
}

std::optional<double> HapticData::surfaces_fraction() const {
  return surfaces_ ? surfaces_->fraction() : std::nullopt;
}

HapticChain HapticData::build(const std::string& description, std::span<const HapticMode> modes) {
  NamedField open = open_;
  if (parse_chain(description).settings.texture.by_noise && open.scalar)
    open.noise = noises_->wait(open.scalar);
  return build_chain(description, modes, open, threads_, &store_);
}

void HapticData::request_lines(SeedShape shape, const Vec3& probe, const Camera& camera,
                               const LineStyle& style) {
  constexpr double kReach = 0.06;   // diagonals: half the length of a rake
  constexpr double kLength = 0.25;  // diagonals: of its lines, either way
  constexpr int kRakeSeeds = 11, kPlaneSeeds = 6;
  LocalRequest request;
  if (shape != SeedShape::kNone && has_flow()) {
    const double diagonal = open_.field->diagonal();
    request.field = open_.field;
    request.shape = shape;
    request.center = probe;
    request.along = kReach * diagonal * camera.axes[0];
    if (request.shape == SeedShape::kPlane) request.across = kReach * diagonal * camera.axes[1];
    request.seeds = request.shape == SeedShape::kPlane ? kPlaneSeeds : kRakeSeeds;
    request.length = kLength * diagonal;
    if (style.color_by == ColorBy::kArray) request.array = style.array;
  }
  local_->request(request);
}

}  // namespace palpate
