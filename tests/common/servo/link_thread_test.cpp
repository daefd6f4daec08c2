// The thread that renews a device's force: it allocates nothing while there is one.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "common/servo/linked_device.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

/// Has much to say, and counts what is allocated between two rounds.
class TalkativeLink final : public DriverLink {
 public:
  bool round() noexcept override {
    const std::size_t since = guard_ ? guard_->count() : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const bool shows = ordered() != Vec3{0.0};
    (showed_ ? with_force : without) += since;
    if (showed_) ++rounds;
    showed_ = shows;
    atoms_.time += 0.001;
    guard_.emplace();
    return true;
  }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override { return std::string(1000, 'x'); }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return "here"; }

  std::atomic<std::size_t> with_force{0}, without{0};
  std::atomic<int> rounds{0};  ///< after one that showed force

 private:
  DeviceAtoms atoms_{.has_position = true};
  LinkStatus status_{.phase = LinkPhase::kReady};
  DeviceLimits limits_;
  bool showed_ = false;
  std::optional<AllocationGuard> guard_;
};

TEST(LinkThread, AllocatesNothingWhileItShowsForce) {
  const auto link = std::make_shared<TalkativeLink>();
  LinkedDevice device(link);
  for (int n = 0; n < 30'000 && link->without == 0; ++n)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_GT(link->without, 0U) << "words are made at rest";
  // Several times as long as the pause between two words.
  for (int n = 0; n < 30'000 && link->rounds < 500; ++n) {
    device.command({0.0, 0.0, 1.0});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GE(link->rounds, 500);
  EXPECT_EQ(link->with_force, 0U);
  EXPECT_EQ(device.advice(), std::string(1000, 'x')) << "what was said before holds";
}

}  // namespace
}  // namespace palpate::test
