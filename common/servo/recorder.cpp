#include "common/servo/recorder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/output_file.h"

namespace palpate {
namespace {

using namespace std::chrono_literals;

constexpr auto kRingPause = 20ms;    // between two looks into the ring
constexpr auto kFlushInterval = 1s;  // what a crash may cost
constexpr int kLongestEnd = 100;     // [ms]

}  // namespace

Recorder::Recorder(std::filesystem::path path, const RecordingHeader& header, bool overwrite,
                   std::size_t capacity)
    : path_(std::move(path)), ring_(capacity) {
  std::error_code ignored;
  if (overwrite && std::filesystem::is_regular_file(path_, ignored)) {
    check_output(path_, overwrite);
    earlier_ = path_.string() + "~";
    if (std::rename(path_.c_str(), earlier_.c_str()) != 0) refuse(errno);
  }
  file_.reset(std::fopen(path_.c_str(), overwrite ? "we" : "wxe"));
  if (!file_ && errno == EEXIST) throw usage_error(path_.string() + " exists; --force overwrites it");
  if (!file_) refuse(errno);
  text_.header(header);
  flush();
  if (failed()) refuse(error_);
  thread_ = std::jthread([this](const std::stop_token& stop) { write_loop(stop); });
  last_act_.emplace([this] { end_soon(); });
}

Recorder::~Recorder() {
  try {
    finish();
  } catch (const Error&) {  // whoever wants to know calls finish()
  }
}

std::uint32_t Recorder::describe_chain(std::string_view description) {
  const std::lock_guard lock(mutex_);
  descriptions_.push_back(one_line(description));
  return static_cast<std::uint32_t>(descriptions_.size() - 1);
}

void Recorder::event(std::uint64_t step, std::uint64_t frame, std::string_view text) {
  WindowEvent event{step, frame, std::string(text)};
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(event));
}

void Recorder::finish() {
  last_act_.reset();
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  if (!ended_) end();
  if (failed()) refuse(error_);
}

void Recorder::end() {
  drain();
  text_.end();
  flush();
  if (!failed() && !earlier_.empty()) ::unlink(earlier_.c_str());
  ended_ = true;
}

void Recorder::end_soon() {
  end_asked_ = true;
  for (int i = 0; i < kLongestEnd && !ended_; ++i) std::this_thread::sleep_for(1ms);
}

void Recorder::write_loop(const std::stop_token& stop) {
  auto flushed = std::chrono::steady_clock::now();
  std::mutex sleeping;
  std::unique_lock lock(sleeping);
  while (!stop.stop_requested()) {
    (void)wake_.wait_for(lock, stop, kRingPause, [] { return false; });
    if (end_asked_) return end();
    drain();
    if (const auto now = std::chrono::steady_clock::now(); now - flushed >= kFlushInterval) {
      flush();
      flushed = now;
    }
  }
}

void Recorder::drain() {
  Entry entry;
  // No more than the ring holds, so that a servo faster than this thread does not keep it here.
  for (std::size_t i = 0; i < ring_.capacity() && ring_.pop(entry); ++i) {
    std::visit([this](const auto& e) { write(e); }, entry);
  }
  if (const std::uint64_t lost = ring_.dropped(); lost != lost_written_) {
    lost_written_ = lost;
    text_.lost(lost);
  }
  const std::lock_guard lock(mutex_);
  for (const WindowEvent& event : events_) text_.event(event.step, event.frame, event.text);
  events_.clear();
}

void Recorder::write(const RecordedChange& change) {
  if (const auto* chain = std::get_if<ChainChange>(&change.change)) {
    const std::lock_guard lock(mutex_);
    text_.chain(change.step, descriptions_[chain->chain]);
  } else if (const auto* settings = std::get_if<ChainSettings>(&change.change)) {
    text_.settings(change.step, *settings);
  } else {
    text_.change(change.step, std::get<HandSwitch>(change.change));
  }
}

void Recorder::flush() noexcept {
  const std::string& text = text_.text();
  if (!failed() && (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
                    std::fflush(file_.get()) != 0)) {
    error_.store(errno, std::memory_order_relaxed);
    failed_.store(true, std::memory_order_release);
  }
  text_.clear();
}

void Recorder::refuse(int error) const {
  throw work_error(path_.string() + " cannot be written: " + std::generic_category().message(error));
}

}  // namespace palpate
