/// A Pinch Glove in bytes: it says which fingers touch when that changes, and answers what it is asked.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tests/common/device/driver/transport/fake_line.h"

namespace palpate::test {

class PinchEmulator final : public Speaker {
 public:
  /// Groups of fingers in contact from now on, as it codes them: left and right hand, 16 thumb to 1 little
  /// finger.
  void touch(std::vector<std::pair<int, int>> groups) {
    groups_ = std::move(groups);
    changed_ = true;
  }
  /// It is as if it were switched off.
  void hang(bool on) { hangs_ = on; }
  [[nodiscard]] int asked() const { return asked_; }

  void hear(double /*now*/, std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) {
      // Its second letter chooses whether messages have a time.
      if (half_ && (byte == '0' || byte == '1') && !hangs_) {
        timed_ = byte == '1';
        ++asked_;
        said_.insert(said_.end(), {0x82, byte, 0x8F});
      }
      half_ = byte == 'T';
    }
  }
  void speak(double /*now*/, std::vector<std::uint8_t>& bytes) override {
    if (hangs_) said_.clear();
    if (changed_ && !hangs_) {
      said_.push_back(timed_ ? 0x81 : 0x80);
      for (const auto& [left, right] : groups_) {
        said_.push_back(static_cast<std::uint8_t>(left));
        said_.push_back(static_cast<std::uint8_t>(right));
      }
      if (timed_) said_.insert(said_.end(), {0x12, 0x34});
      said_.push_back(0x8F);
    }
    changed_ = false;
    bytes.insert(bytes.end(), said_.begin(), said_.end());
    said_.clear();
  }

 private:
  std::vector<std::pair<int, int>> groups_;
  std::vector<std::uint8_t> said_;
  bool changed_ = false, hangs_ = false, half_ = false;
  bool timed_ = true;  // as it is switched on
  int asked_ = 0;
};

}  // namespace palpate::test
