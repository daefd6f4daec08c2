#include "common/base/progress.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include <unistd.h>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void draw(const Progress& progress) {
  constexpr int kWidth = 30;
  const double fraction = progress.fraction();
  const double seconds = progress.seconds_in_stage();
  const std::string stage = progress.stage();
  if (fraction < 0.0) {
    std::fprintf(stderr, "\r\033[K%s: %.0f s", stage.c_str(), seconds);
  } else {
    const int filled = static_cast<int>(fraction * kWidth);
    const std::string bar(as_size(filled), '=');
    std::fprintf(stderr, "\r\033[K%s [%-30s] %3.0f %%", stage.c_str(), bar.c_str(), 100.0 * fraction);
    if (fraction > 0.0) std::fprintf(stderr, ", %.0f s left", seconds * (1.0 - fraction) / fraction);
  }
  std::fflush(stderr);
}

}  // namespace

void Progress::begin(std::string stage, std::uint64_t total) {
  check();
  stage_.store(std::make_shared<const std::string>(std::move(stage)));
  done_.store(0, std::memory_order_relaxed);
  total_.store(total, std::memory_order_relaxed);
  stage_start_ns_.store(now_ns(), std::memory_order_relaxed);
}

void Progress::check() const {
  if (cancelled()) throw Cancelled();
}

std::string Progress::stage() const {
  const auto stage = stage_.load();
  return stage ? *stage : std::string();
}

double Progress::seconds_in_stage() const {
  const std::int64_t start = stage_start_ns_.load(std::memory_order_relaxed);
  return start == 0 ? 0.0 : 1e-9 * static_cast<double>(now_ns() - start);
}

double Progress::fraction() const noexcept {
  const auto total = total_.load(std::memory_order_relaxed);
  if (total == 0) return -1.0;
  const auto done = done_.load(std::memory_order_relaxed);
  return std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

struct ProgressBar::Drawer {
  std::mutex mutex;
  std::condition_variable_any wake;
  bool drawn = false;
  std::jthread thread;
};

ProgressBar::ProgressBar(const Progress& progress, bool quiet) {
  if (quiet || isatty(STDERR_FILENO) == 0) return;
  drawer_ = std::make_unique<Drawer>();
  drawer_->thread = std::jthread([drawer = drawer_.get(), &progress](const std::stop_token& stop) {
    using namespace std::chrono_literals;
    std::unique_lock lock(drawer->mutex);
    while (!stop.stop_requested()) {
      drawer->wake.wait_for(lock, stop, 100ms, [] { return false; });
      if (progress.seconds_in_stage() < 1.0 || stop.stop_requested()) continue;
      draw(progress);
      drawer->drawn = true;
    }
  });
}

ProgressBar::~ProgressBar() {
  if (!drawer_) return;
  drawer_->thread.request_stop();
  drawer_->thread.join();
  if (drawer_->drawn) std::fputs("\r\033[K", stderr);
}

}  // namespace palpate
