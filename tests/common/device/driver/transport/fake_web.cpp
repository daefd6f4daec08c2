#include "tests/common/device/driver/transport/fake_web.h"

#include <algorithm>

namespace palpate::test {

class FakeWeb::Connection final : public WebConnection {
 public:
  explicit Connection(FakeWeb& web) : web_(web) {
    ++web_.connections_;
    ++web_.opened_;
    say(web_.service_.snapshot(web_.now_));
  }
  ~Connection() override {
    --web_.connections_;
    web_.service_.left(web_.now_);
  }

  TransferStatus send(std::string_view message, double /*seconds*/) noexcept override {
    if (!web_.listens || ended_) return TransferStatus::kGone;
    web_.now_ += kOneWay;
    say(web_.service_.take(web_.now_, std::string(message)));
    if (web_.happens(web_.faults.reset)) ended_ = true;
    return TransferStatus::kOk;
  }

  TransferStatus receive(std::string& message, double seconds) noexcept override {
    if (!web_.listens || ended_) return TransferStatus::kGone;
    if (web_.flood) say(web_.service_.snapshot(web_.now_));
    const double until = web_.now_ + seconds;
    if (queue_.empty() || queue_.front().first > until) {
      web_.now_ = until;
      web_.service_.advance(web_.now_);
      return TransferStatus::kTimeout;
    }
    web_.now_ = std::max(web_.now_, queue_.front().first);
    web_.service_.advance(web_.now_);
    message = queue_.front().second;
    queue_.pop_front();
    return TransferStatus::kOk;
  }

 private:
  static constexpr double kOneWay = 1e-4;  // [s]

  void say(std::string text) {
    if (!web_.says.empty()) text = web_.says;
    if (web_.happens(web_.faults.lost)) return;
    if (web_.happens(web_.faults.cut)) text.resize(text.size() / 2);
    if (web_.happens(web_.faults.corrupt) && !text.empty()) {
      text[web_.random() % text.size()] = static_cast<char>(web_.random() % 256);
    }
    const double delay = web_.happens(web_.faults.late) ? web_.faults.lateness : kOneWay;
    const double at = std::max(web_.now_ + delay, queue_.empty() ? 0.0 : queue_.back().first);
    queue_.emplace_back(at, text);
    if (web_.happens(web_.faults.doubled)) queue_.emplace_back(at, text);
  }

  FakeWeb& web_;
  std::deque<std::pair<double, std::string>> queue_;
  bool ended_ = false;
};

WebOpened FakeWeb::open(const WebAddress& /*address*/, double /*seconds*/) noexcept {
  sleep(0.001);
  if (!listens) return {TransferStatus::kGone, nullptr};
  return {TransferStatus::kOk, std::make_unique<Connection>(*this)};
}

std::optional<std::string> FakeWeb::get(const WebAddress& address, const std::string& path,
                                        double seconds) noexcept {
  if (listens && tells_version && address.port == 10000 && path == "/3.0/version")
    return service_.version_page();
  sleep(seconds);
  return std::nullopt;
}

}  // namespace palpate::test
