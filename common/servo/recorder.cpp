#include "common/servo/recorder.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <system_error>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/line_reader.h"
#include "common/haptics/settings_text.h"

namespace palpate {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 20ms;        // between two looks into the ring
constexpr auto kFlushInterval = 1s;  // what a crash may cost

/// A space and the shortest text that reads back to the same number.
template <typename Number>
void append(std::string& text, Number value) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text += ' ';
  text.append(digits.data(), result.ptr);
}

void append_hash(std::string& text, const StepHash& hash) {
  std::array<char, 16> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), hash.value(), 16);
  text += "hash";
  append(text, hash.steps());
  text += ' ';
  text.append(digits.data(), result.ptr);
  text += '\n';
}

/// A line of its own whatever is in it, and short enough to be read again.
std::string one_line(std::string_view text) {
  std::string line(text.substr(0, LineReader::kLongestLine / 2));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line;
}

std::string header_text(const RecordingHeader& header) {
  std::string text = "palpate-recording 1\n";
  text += "program " + one_line(header.program) + "\nversion " + one_line(header.version) + "\nbuild " +
          one_line(header.build) + '\n';
  for (const RecordedFile& input : header.inputs) {
    text += "input " + std::to_string(input.bytes) + ' ' + (input.sha256.empty() ? "-" : input.sha256) + ' ' +
            one_line(input.file) + '\n';
  }
  for (const auto& [key, value] : header.values) {
    PALPATE_CHECK(!key.empty() && key.find_first_of(" \n\r") == std::string::npos);
    text += "set " + key + ' ' + one_line(value) + '\n';
  }
  text += "limits";
  for (const double* field : limits_fields(header.limits)) append(text, *field);
  return text + "\nbegin\n";
}

}  // namespace

Recorder::Recorder(std::filesystem::path path, const RecordingHeader& header, bool overwrite,
                   std::size_t capacity)
    : path_(std::move(path)), ring_(capacity) {
  file_.reset(std::fopen(path_.c_str(), overwrite ? "we" : "wxe"));
  if (!file_ && errno == EEXIST) throw usage_error(path_.string() + " exists; --force overwrites it");
  if (!file_) refuse(errno);
  text_ = header_text(header);
  flush();
  if (failed()) refuse(error_);
  thread_ = std::jthread([this](const std::stop_token& stop) { write_loop(stop); });
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
  std::string line = "event";
  append(line, step);
  append(line, frame);
  const std::lock_guard lock(mutex_);
  events_ += line + ' ' + one_line(text) + '\n';
}

void Recorder::finish() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  drain();
  if (hash_.steps() % kHashBlock != 0) append_hash(text_, hash_);
  text_ += "end";
  append(text_, hash_.steps());
  text_ += '\n';
  flush();
  if (failed()) refuse(error_);
}

void Recorder::write_loop(const std::stop_token& stop) {
  auto flushed = std::chrono::steady_clock::now();
  std::mutex sleeping;
  std::unique_lock lock(sleeping);
  while (!stop.stop_requested()) {
    (void)wake_.wait_for(lock, stop, kPause, [] { return false; });
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
    text_ += "lost";
    append(text_, lost);
    text_ += '\n';
  }
  const std::lock_guard lock(mutex_);
  text_ += events_;
  events_.clear();
}

void Recorder::write(const RecordedChange& change) {
  if (const auto* chain = std::get_if<ChainChange>(&change.change)) {
    text_ += "chain";
    append(text_, change.step);
    const std::lock_guard lock(mutex_);
    text_ += ' ' + descriptions_[chain->chain];
  } else if (const auto* settings = std::get_if<ChainSettings>(&change.change)) {
    text_ += "settings";
    append(text_, change.step);
    (text_ += ' ') += settings_text(*settings);
  } else {
    text_ += "switch";
    append(text_, change.step);
    text_ += ' ';
    text_ += name_of(std::get<HandSwitch>(change.change));
  }
  text_ += '\n';
}

void Recorder::write(const StepEntry& entry) {
  text_ += entry.input.present ? "s" : "n";
  append(text_, entry.step.number);
  append(text_, entry.input.time);
  if (entry.input.present) {
    const DeviceSample& sample = entry.input.sample;
    append(text_, sample.time);
    for (int a = 0; a < 3; ++a) append(text_, sample.position[a]);
    append(text_, sample.buttons);
  }
  text_ += '\n';
  hash_.add(entry.step);
  if (hash_.steps() % kHashBlock == 0) append_hash(text_, hash_);
}

void Recorder::flush() noexcept {
  if (!failed() && (std::fwrite(text_.data(), 1, text_.size(), file_.get()) != text_.size() ||
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
