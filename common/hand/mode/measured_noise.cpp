#include "common/hand/mode/measured_noise.h"

#include <new>
#include <utility>

#include "common/field/noise_field.h"

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

}  // namespace palpate
