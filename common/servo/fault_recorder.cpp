#include "common/servo/fault_recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/servo/recording.h"

namespace palpate {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 50ms;  // between two looks for something to write
constexpr std::size_t kMostEntries = 1U << 16U;
constexpr std::size_t kSettings = 1U << 10U;  // a slider that is moved all the time: 60 a second

}  // namespace

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
      case HandSwitch::kRestart:
        break;
    }
  }
}

void FaultRecorder::Situation::take(const HandStep& step, const DeviceLimits& limits) noexcept {
  if (step.cut == ForceCut::kTooFast || (is_fault(step.cut) && limits.latch_faults)) off = true;
}

void FaultRecorder::Memory::reserve(std::size_t entries) {
  entries_.resize(entries);
  settings_.resize(kSettings);
}

void FaultRecorder::Memory::begin(const Situation& before) noexcept {
  first_ = count_ = settings_first_ = settings_next_ = 0;
  before_ = before;
}

Change FaultRecorder::Memory::change_of(const ChangeEntry& entry) const noexcept {
  if (const auto* slot = std::get_if<Slot>(&entry.what)) return settings_[slot->index];
  if (const auto* chain = std::get_if<ChainChange>(&entry.what)) return *chain;
  return std::get<HandSwitch>(entry.what);
}

void FaultRecorder::Memory::take(const Entry& entry, Situation& situation,
                                 const DeviceLimits& limits) const noexcept {
  if (const auto* change = std::get_if<ChangeEntry>(&entry)) {
    situation.take(change_of(*change));
  } else {
    situation.take(std::get<StepEntry>(entry).step, limits);
  }
}

void FaultRecorder::Memory::drop_oldest(const DeviceLimits& limits) noexcept {
  const Entry& oldest = entries_[first_];
  take(oldest, before_, limits);
  const auto* change = std::get_if<ChangeEntry>(&oldest);
  if (change != nullptr && std::holds_alternative<Slot>(change->what)) ++settings_first_;
  first_ = (first_ + 1) % entries_.size();
  --count_;
}

void FaultRecorder::Memory::push(const Entry& entry, const DeviceLimits& limits) noexcept {
  if (count_ == entries_.size()) drop_oldest(limits);
  entries_[(first_ + count_++) % entries_.size()] = entry;
}

void FaultRecorder::Memory::add(const StepEntry& entry, const DeviceLimits& limits) noexcept {
  push(entry, limits);
}

void FaultRecorder::Memory::add(std::uint64_t step, const Change& change,
                                const DeviceLimits& limits) noexcept {
  ChangeEntry entry{.step = step, .what = {}};
  if (const auto* settings = std::get_if<ChainSettings>(&change)) {
    while (settings_next_ - settings_first_ == settings_.size()) drop_oldest(limits);
    const std::size_t index = settings_next_++ % settings_.size();
    settings_[index] = *settings;
    entry.what = Slot{index};
  } else if (const auto* chain = std::get_if<ChainChange>(&change)) {
    entry.what = *chain;
  } else {
    entry.what = std::get<HandSwitch>(change);
  }
  push(entry, limits);
}

FaultRecorder::FaultRecorder(std::filesystem::path folder, RecordingHeader header, double rate)
    : folder_(std::move(folder)),
      header_(std::move(header)),
      aftermath_(static_cast<std::uint64_t>(std::ceil(kAftermath * rate))) {
  const auto entries = floor_size(std::ceil(kSeconds * rate));
  for (Memory& memory : memories_) memory.reserve(std::min(entries, kMostEntries));
  thread_ = std::jthread([this](const std::stop_token& stop) { write_loop(stop); });
}

FaultRecorder::~FaultRecorder() { finish(); }

void FaultRecorder::finish() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  if (to_go_) save(memories_[as_size(active_)]);
}

void FaultRecorder::change(std::uint64_t step, const Change& change) noexcept {
  now_.take(change);
  memories_[as_size(active_)].add(step, change, header_.limits);
}

void FaultRecorder::step(const HandInput& input, const HandStep& step) noexcept {
  now_.take(step, header_.limits);
  memories_[as_size(active_)].add(StepEntry{input, step}, header_.limits);
  if (std::exchange(cut_, step.cut) != step.cut && is_fault(step.cut)) begin_fault();
  if (to_go_ && (*to_go_)-- == 0) hand_over();
}

void FaultRecorder::begin_fault() noexcept {
  // A busy machine is no fault of what shows no force: a mouse.
  const bool late = !is_fault(cut_) || cut_ == ForceCut::kStale || cut_ == ForceCut::kTime;
  if (late && !header_.limits.latch_faults) return;
  faults_.store(faults_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (!to_go_ && files_ < kMostFiles) to_go_ = aftermath_;
}

/// Goes on in the other memory, unless that one is still being written.
void FaultRecorder::hand_over() noexcept {
  to_go_.reset();
  if (handed_.load(std::memory_order_acquire) != kNone) return;
  ++files_;
  const int full = std::exchange(active_, 1 - active_);
  memories_[as_size(active_)].begin(now_);
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
    save(memories_[as_size(full)]);
    handed_.store(kNone, std::memory_order_release);
  }
}

void FaultRecorder::save(const Memory& memory) {
  std::string message;
  try {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);  // a failure shows when the file is made
    const std::vector<std::uint64_t> there = numbers();
    const std::filesystem::path path = file_of(there.empty() ? 1 : there.back() + 1);
    OutputFile file(path, false);
    file.write(text_of(memory));
    file.finish();
    prune();
    message =
        "a fault of the servo: the seconds before it are in " + path.string() + ", which --replay plays";
  } catch (const Error& error) {
    message = std::string("a fault of the servo, whose last seconds could not be saved: ") + error.what();
  }
  const std::lock_guard lock(mutex_);
  news_ = std::move(message);
}

std::filesystem::path FaultRecorder::file_of(std::uint64_t number) const {
  return folder_ / (header_.program + "-fault-" + std::to_string(number) + ".rec");
}

std::vector<std::uint64_t> FaultRecorder::numbers() const {
  std::vector<std::uint64_t> found;
  std::error_code unknown;  // where it cannot be told no file is made either
  for (const auto& entry : std::filesystem::directory_iterator(folder_, unknown)) {
    const std::string name = entry.path().filename().string(), before = header_.program + "-fault-";
    if (!name.starts_with(before)) continue;
    const auto number = parsed<std::uint64_t>(name.substr(before.size(), name.find('.') - before.size()));
    if (number && *number < std::numeric_limits<std::uint64_t>::max() && entry.path() == file_of(*number)) {
      found.push_back(*number);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void FaultRecorder::prune() const {
  const std::vector<std::uint64_t> there = numbers();
  for (std::size_t i = 0; i + kKept < there.size(); ++i) {
    std::error_code left_there;
    std::filesystem::remove(file_of(there[i]), left_there);
  }
}

std::string FaultRecorder::text_of(const Memory& memory) {
  // The first step of a hand off the device, which makes all be forgotten: from there everything is known.
  Situation before = memory.before();
  std::size_t first = 0;
  for (; first < memory.count(); ++first) {
    const auto* step = std::get_if<StepEntry>(&memory.at(first));
    if (step != nullptr && !step->input.present) break;
    memory.take(memory.at(first), before, header_.limits);
  }
  const bool exact = first < memory.count() && !(header_.limits.continuous_cap < header_.limits.force_cap);
  if (!exact) {
    first = 0;
    before = memory.before();
  }
  // Changes that stand first belong to the step after them.
  const auto number_of = [](const Entry& entry) {
    const auto* change = std::get_if<ChangeEntry>(&entry);
    return change != nullptr ? change->step : std::get<StepEntry>(entry).step.number;
  };
  const std::uint64_t begin = memory.count() > 0 ? number_of(memory.at(first)) : 0;

  RecordingText text(exact);
  text.header(header_);
  const std::lock_guard lock(mutex_);
  if (before.chain) text.chain(begin, descriptions_[*before.chain]);
  if (before.settings) text.settings(begin, *before.settings);
  if (before.off) text.change(begin, HandSwitch::kForceOff);
  for (std::size_t i = first; i < memory.count(); ++i) {
    if (const auto* step = std::get_if<StepEntry>(&memory.at(i))) {
      text.step(step->input, step->step);
      continue;
    }
    const auto& entry = std::get<ChangeEntry>(memory.at(i));
    const std::uint64_t number = entry.step;
    const Change change = memory.change_of(entry);
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
