#include "common/servo/fault_recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/output_file.h"
#include "common/servo/recording_text.h"

namespace palpate {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 50ms;  // between two looks for something to write
constexpr std::size_t kMostEntries = 1U << 16U;

}  // namespace

void FaultRecorder::Situation::take(const Entry& entry, const DeviceLimits& limits) noexcept {
  if (const auto* change = std::get_if<RecordedChange>(&entry)) {
    take(change->change);
    return;
  }
  const ForceCut cut = std::get<StepEntry>(entry).step.cut;
  if (cut == ForceCut::kTooFast || (is_fault(cut) && limits.latch_faults)) off = true;
}

void FaultRecorder::Situation::take(const Change& change) noexcept {
  if (const auto* placed = std::get_if<ChainChange>(&change)) {
    chain = placed->chain;
    settings.reset();  // its own follow
  } else if (const auto* edited = std::get_if<ChainSettings>(&change)) {
    settings = *edited;
  } else {
    switch (std::get<HandSwitch>(change)) {
      case HandSwitch::kForceOff:
        off = true;
        break;
      case HandSwitch::kArm:
        off = false;
        break;
      case HandSwitch::kPause:
        paused = true;
        break;
      case HandSwitch::kResume:
        paused = false;
        break;
      case HandSwitch::kRestart:
        break;
    }
  }
}

void FaultRecorder::Memory::add(const Entry& entry, const DeviceLimits& limits) noexcept {
  if (count == entries.size()) {
    before.take(entries[first], limits);
    first = (first + 1) % entries.size();
    --count;
  }
  entries[(first + count++) % entries.size()] = entry;
}

FaultRecorder::FaultRecorder(std::filesystem::path folder, RecordingHeader header, double rate)
    : folder_(std::move(folder)),
      header_(std::move(header)),
      aftermath_(static_cast<std::uint64_t>(std::ceil(kAftermath * rate))) {
  const auto entries = static_cast<std::size_t>(std::ceil(kSeconds * rate));
  for (Memory& memory : memories_) memory.entries.resize(std::min(entries, kMostEntries));
  thread_ = std::jthread([this](const std::stop_token& stop) { write_loop(stop); });
}

FaultRecorder::~FaultRecorder() { finish(); }

void FaultRecorder::finish() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  if (to_go_) save(memories_[static_cast<std::size_t>(active_)]);
}

void FaultRecorder::change(std::uint64_t step, const Change& change) noexcept {
  add(RecordedChange{step, change});
}

void FaultRecorder::add(const Entry& entry) noexcept {
  now_.take(entry, header_.limits);
  memories_[static_cast<std::size_t>(active_)].add(entry, header_.limits);
}

void FaultRecorder::step(const HandInput& input, const HandStep& step) noexcept {
  add(StepEntry{input, step});
  if (is_fault(step.cut) && step.cut != cut_) begin_fault();
  cut_ = step.cut;
  if (to_go_ && (*to_go_)-- == 0) hand_over();
}

void FaultRecorder::begin_fault() noexcept {
  faults_.store(faults_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (!to_go_ && files_ < kMostFiles) to_go_ = aftermath_;
}

/// Goes on in the other memory, unless that one is still being written.
void FaultRecorder::hand_over() noexcept {
  to_go_.reset();
  if (handed_.load(std::memory_order_acquire) != kNone) return;
  ++files_;
  const int full = std::exchange(active_, 1 - active_);
  Memory& fresh = memories_[static_cast<std::size_t>(active_)];
  fresh.first = fresh.count = 0;
  fresh.before = now_;
  handed_.store(full, std::memory_order_release);
}

std::uint32_t FaultRecorder::describe_chain(std::string_view description) {
  const std::lock_guard lock(mutex_);
  descriptions_.emplace_back(description);
  return static_cast<std::uint32_t>(descriptions_.size() - 1);
}

std::optional<std::string> FaultRecorder::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, std::nullopt);
}

void FaultRecorder::write_loop(const std::stop_token& stop) {
  std::mutex sleeping;
  std::unique_lock lock(sleeping);
  for (bool stopping = false; !stopping;) {
    stopping = wake_.wait_for(lock, stop, kPause, [] { return false; }) || stop.stop_requested();
    const int full = handed_.load(std::memory_order_acquire);
    if (full == kNone) continue;
    save(memories_[static_cast<std::size_t>(full)]);
    handed_.store(kNone, std::memory_order_release);
  }
}

void FaultRecorder::save(const Memory& memory) {
  std::string message;
  try {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);  // a failure shows when the file is made
    const std::filesystem::path path = free_name();
    OutputFile file(path, false);
    file.write(text_of(memory));
    file.finish();
    message =
        "a fault of the servo: the seconds before it are in " + path.string() + ", which --replay plays";
  } catch (const Error& error) {
    message = std::string("a fault of the servo, whose last seconds could not be saved: ") + error.what();
  }
  const std::lock_guard lock(mutex_);
  news_ = std::move(message);
}

std::filesystem::path FaultRecorder::free_name() const {
  for (int n = 1;; ++n) {
    std::filesystem::path path = folder_ / (header_.program + "-fault-" + std::to_string(n) + ".rec");
    std::error_code unknown;  // where it cannot be told the file is not made either
    if (!std::filesystem::exists(path, unknown)) return path;
  }
}

std::string FaultRecorder::text_of(const Memory& memory) {
  // The first step of a hand off the device, which makes all be forgotten: from there everything is known.
  Situation before = memory.before;
  std::size_t first = 0;
  for (; first < memory.count; ++first) {
    const auto* step = std::get_if<StepEntry>(&memory.at(first));
    if (step != nullptr && !step->input.present && !before.paused) break;
    before.take(memory.at(first), header_.limits);
  }
  const bool exact = first < memory.count && !(header_.limits.continuous_cap < header_.limits.force_cap);
  if (!exact) {
    first = 0;
    before = memory.before;
  }
  // Changes that stand first belong to the step after them.
  const auto number_of = [](const Entry& entry) {
    const auto* change = std::get_if<RecordedChange>(&entry);
    return change != nullptr ? change->step : std::get<StepEntry>(entry).step.number;
  };
  const std::uint64_t begin = memory.count > 0 ? number_of(memory.at(first)) : 0;

  RecordingText text(exact);
  text.header(header_);
  const std::lock_guard lock(mutex_);
  if (before.chain) text.chain(begin, descriptions_[*before.chain]);
  if (before.settings) text.settings(begin, *before.settings);
  if (before.off) text.change(begin, HandSwitch::kForceOff);
  if (before.paused) text.change(begin, HandSwitch::kPause);
  for (std::size_t i = first; i < memory.count; ++i) {
    if (const auto* step = std::get_if<StepEntry>(&memory.at(i))) {
      text.step(step->input, step->step);
      continue;
    }
    const auto& [number, change] = std::get<RecordedChange>(memory.at(i));
    if (const auto* chain = std::get_if<ChainChange>(&change)) {
      text.chain(number, descriptions_[chain->chain]);
    } else if (const auto* settings = std::get_if<ChainSettings>(&change)) {
      text.settings(number, *settings);
    } else {
      text.change(number, std::get<HandSwitch>(change));
    }
  }
  text.end();
  return text.text();
}

}  // namespace palpate
