#include "tests/common/device/driver/transport/fake_line.h"

#include <algorithm>
#include <utility>

namespace palpate::test {
namespace {

constexpr double kLineTick = 5e-4;  // [s] between two looks whether something was said
constexpr double kCallTime = 2e-5;  // [s] that any call takes

}  // namespace

class FakeLine::Stream final : public ByteStream {
 public:
  Stream(FakeLine& line, std::shared_ptr<Speaker> speaker) : line_(line), speaker_(std::move(speaker)) {
    ++line_.open_;
    speaker_->opened(line_.now_);
  }
  ~Stream() override { --line_.open_; }

  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    if (line_.happens(line_.faults_.late_read)) line_.sleep(line_.faults_.lateness);
    for (const double until = line_.now_ + seconds;;) {
      Speaker* const speaker = line_.call(speaker_);
      if (speaker == nullptr) return {TransferStatus::kGone, 0};
      line_.carry(*speaker);
      std::size_t bytes = std::min(line_.waiting_.size(), data.size());
      if (bytes > 1 && line_.happens(line_.faults_.split_read)) bytes = 1 + line_.random_() % (bytes - 1);
      if (bytes > 0) {
        std::copy_n(line_.waiting_.begin(), bytes, data.begin());
        line_.waiting_.erase(line_.waiting_.begin(),
                             line_.waiting_.begin() + static_cast<std::ptrdiff_t>(bytes));
        return {TransferStatus::kOk, bytes};
      }
      if (line_.now_ >= until) return {TransferStatus::kTimeout, 0};
      line_.sleep(std::min(kLineTick, std::max(until - line_.now_, 1e-6)));
    }
  }

  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    Speaker* const speaker = line_.call(speaker_);
    if (speaker == nullptr) return {TransferStatus::kGone, 0};
    if (line_.happens(line_.faults_.lost_write)) return {TransferStatus::kOk, data.size()};
    const bool cut = line_.happens(line_.faults_.short_write);
    const std::span<const std::uint8_t> sent = data.first(cut ? data.size() / 2 : data.size());
    speaker->hear(line_.now_, sent);
    if (cut) line_.sleep(seconds);
    return {cut ? TransferStatus::kTimeout : TransferStatus::kOk, sent.size()};
  }

 private:
  FakeLine& line_;
  std::shared_ptr<Speaker> speaker_;
};

bool FakeLine::happens(double probability) {
  return probability > 0.0 && std::uniform_real_distribution<double>()(random_) < probability;
}

void FakeLine::carry(Speaker& speaker) {
  std::vector<std::uint8_t> said;
  speaker.speak(now_, said);
  for (std::uint8_t byte : said) {
    if (happens(faults_.foreign_byte)) waiting_.push_back(static_cast<std::uint8_t>(random_()));
    if (happens(faults_.lost_byte)) continue;
    if (happens(faults_.corrupt_byte)) byte ^= static_cast<std::uint8_t>(1U << (random_() % 8));
    waiting_.push_back(byte);
  }
  // The buffer of a line holds no more than that; what comes then is lost.
  constexpr std::size_t kMost = 4096;
  if (waiting_.size() > kMost) waiting_.resize(kMost);
}

Speaker* FakeLine::call(const std::shared_ptr<Speaker>& opened) {
  now_ += kCallTime;
  if (unplug_after_ > 0 && --unplug_after_ == 0) speaker_.reset();
  return speaker_ == opened ? opened.get() : nullptr;
}

StreamOpened FakeLine::open() {
  if (refused_ != TransferStatus::kOk) return {refused_, nullptr};
  if (!speaker_) return {TransferStatus::kGone, nullptr};
  waiting_.clear();
  return {TransferStatus::kOk, std::make_unique<Stream>(*this, speaker_)};
}

}  // namespace palpate::test
