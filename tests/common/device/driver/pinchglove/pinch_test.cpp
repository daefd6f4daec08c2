// The Pinch Glove, messages and link, against an emulated one in simulated time and at a pseudo terminal.

#include <array>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/pinchglove/pinch_link.h"
#include "common/device/driver/transport/serial_line.h"
#include "tests/common/device/driver/pinchglove/pinch_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/pty_pair.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

/// What the last byte brings.
PinchNews after(PinchParser& parser, const std::vector<std::uint8_t>& bytes) {
  PinchNews news = PinchNews::kNothing;
  for (const std::uint8_t byte : bytes) news = parser.push(byte);
  return news;
}

TEST(PinchMessage, TellsTheFingersOfBothHandsFromTheThumbOn) {
  PinchParser parser;
  EXPECT_EQ(after(parser, {0x80, 0x00, 0x18, 0x8F}), PinchNews::kContacts);
  EXPECT_EQ(parser.contacts(), 0b11U) << "right thumb and index finger";
  EXPECT_EQ(after(parser, {0x80, 0x11, 0x00, 0x08, 0x01, 0x8F}), PinchNews::kContacts);
  EXPECT_EQ(parser.contacts(), (0b10001U | 0b00010U) << 5U | 0b10000U) << "two groups, one across the hands";
  EXPECT_EQ(after(parser, {0x81, 0x00, 0x18, 0x7F, 0x01, 0x8F}), PinchNews::kContacts) << "with a time";
  EXPECT_EQ(parser.contacts(), 0b11U);
  EXPECT_EQ(after(parser, {0x80, 0x8F}), PinchNews::kContacts);
  EXPECT_EQ(parser.contacts(), 0U);
  EXPECT_EQ(after(parser, {0x82, '0', 0x8F}), PinchNews::kText);
}

TEST(PinchMessage, RefusesWhatCannotBe) {
  const std::vector<std::vector<std::uint8_t>> wrong{
      {0x80, 0x18, 0x8F},                                // half a pair
      {0x80, 0x00, 0x10, 0x8F},                          // a finger that touches nothing
      {0x80, 0x00, 0x18, 0x10, 0x10, 0x8F},              // one in two groups
      {0x80, 0x20, 0x18, 0x8F},                          // a hand of six fingers
      {0x81, 0x00, 0x8F},                                // half a time
      {0x80, 0x00, 0x18, 0x80},                          // an end that was lost
      {0x80, 1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 3, 3, 3}};  // no end
  for (const auto& bytes : wrong) {
    PinchParser parser;
    EXPECT_EQ(after(parser, bytes), PinchNews::kDamaged) << bytes.size();
    EXPECT_EQ(after(parser, {0x8F, 0x80, 0x00, 0x18, 0x8F}), PinchNews::kContacts) << "and goes on";
  }
}

TEST(PinchMessage, SurvivesAnyBytes) {
  std::mt19937 random{9};
  PinchParser parser;
  constexpr std::array<std::uint8_t, 8> kLikely{0x80, 0x81, 0x82, 0x8F, 0x18, 0x00, 0x11, 0x8F};
  const AllocationGuard guard;
  for (int n = 0; n < 500'000; ++n) {
    const auto any = static_cast<std::uint8_t>(random());
    if (parser.push(random() % 4 != 0 ? kLikely[random() % kLikely.size()] : any) == PinchNews::kContacts) {
      ASSERT_LT(parser.contacts(), 1U << 10U);
    }
  }
  EXPECT_EQ(guard.count(), 0U);
}

class PinchLinkTest : public ::testing::Test {
 protected:
  PinchLinkTest() {
    auto line = std::make_unique<FakeLine>();
    line_ = line.get();
    link_ = std::make_unique<PinchLink>(std::move(line));
  }
  void run(double seconds) {
    for (const double until = line_->now() + seconds; line_->now() < until;)
      (void)round_with(*link_, Vec3{0.0});
  }
  [[nodiscard]] std::uint32_t buttons() const { return link_->atoms().buttons; }

  FakeLine* line_ = nullptr;
  std::shared_ptr<PinchEmulator> glove_ = std::make_shared<PinchEmulator>();
  std::unique_ptr<PinchLink> link_;
};

TEST_F(PinchLinkTest, FollowsPinchesAndKeepsThemWhileTheyLast) {
  line_->plug(glove_);
  run(0.1);
  ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  glove_->touch({{0, 0x18}});
  run(0.05);
  EXPECT_EQ(buttons(), 0b11U);
  run(10.0);
  EXPECT_EQ(buttons(), 0b11U) << "it says nothing while nothing changes";
  EXPECT_GT(glove_->asked(), 10);
  glove_->touch({{0x18, 0}});
  run(0.05);
  EXPECT_EQ(buttons(), 0b11U << 5U);
  glove_->touch({});
  run(0.05);
  EXPECT_EQ(buttons(), 0U);
}

TEST_F(PinchLinkTest, LetsGoWhereItIsPulledOutSwitchedOffOrNotThere) {
  run(0.3);
  EXPECT_NE(link_->advice().find("no serial line /dev/ttyFAKE"), std::string::npos) << link_->advice();
  line_->plug(glove_);
  run(0.1);
  glove_->touch({{0, 0x18}});
  run(0.1);
  ASSERT_EQ(buttons(), 0b11U);
  const double pulled = line_->now();
  line_->unplug();
  while (buttons() != 0) (void)round_with(*link_, Vec3{0.0});
  EXPECT_LT(line_->now() - pulled, 0.1);
  EXPECT_EQ(link_->status().phase, LinkPhase::kAbsent);
  EXPECT_EQ(line_->open_streams(), 0);
  line_->plug(glove_);
  run(0.5);
  ASSERT_EQ(link_->status().phase, LinkPhase::kReady);
  glove_->touch({{0, 0x18}});
  run(0.1);
  ASSERT_EQ(buttons(), 0b11U);
  glove_->hang(true);
  run(PinchLink::kSilence + 0.05);
  EXPECT_EQ(buttons(), 0U);
  EXPECT_NE(link_->advice().find("no Pinch Glove answers"), std::string::npos) << link_->advice();
  glove_->hang(false);
  run(1.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
}

TEST_F(PinchLinkTest, BearsEveryFaultForTwoHours) {
  line_->plug(glove_);
  std::mt19937_64 random{8};
  std::uniform_real_distribution<double> unit;
  std::uint64_t pinched = 0;
  const double seconds = soak_seconds(kTwoHours);
  while (line_->now() < seconds) {
    const bool bad = unit(random) < 0.5;
    const auto rate = [&](double most) { return bad ? most * unit(random) : 0.0; };
    line_->set_faults({.lost_byte = rate(0.1),
                       .corrupt_byte = rate(0.1),
                       .foreign_byte = rate(0.1),
                       .split_read = rate(0.5),
                       .late_read = rate(0.05),
                       .lost_write = rate(0.2),
                       .short_write = rate(0.2),
                       .seed = random()});
    if (unit(random) < 0.1) line_->unplug_at_call(1 + random() % 200);
    glove_->hang(unit(random) < 0.05);
    glove_->touch(unit(random) < 0.5 ? std::vector<std::pair<int, int>>{{0, 0x18}}
                                     : std::vector<std::pair<int, int>>{});
    for (const double until = line_->now() + 3.0 * unit(random); line_->now() < until;) {
      (void)round_with(*link_, Vec3{1.0});
      if (buttons() == 0b11U) ++pinched;
      ASSERT_LT(buttons(), 1U << 10U);
      ASSERT_TRUE(line_->plugged() || line_->open_streams() <= 1);
    }
    if (!line_->plugged()) line_->plug(glove_);
  }
  EXPECT_GT(static_cast<double>(pinched), 2.5 * seconds);
  line_->set_faults({});
  glove_->hang(false);
  run(3.0);
  glove_->touch({});
  run(0.1);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(buttons(), 0U);
}

TEST(PinchAtAPty, IsFollowed) {
  const auto glove = std::make_shared<PinchEmulator>();
  PtyPair pair(glove);
  PinchLink link(std::make_unique<SerialLine>(pair.path(), 9600));
  constexpr int kMostRounds = 5000;
  for (int n = 0; n < kMostRounds && link.status().phase != LinkPhase::kReady; ++n)
    (void)round_with(link, Vec3{0.0});
  ASSERT_EQ(link.status().phase, LinkPhase::kReady) << link.advice();
  {
    const std::lock_guard lock(pair.mutex());
    glove->touch({{0x10, 0x10}});
  }
  for (int n = 0; n < kMostRounds && link.atoms().buttons == 0; ++n) (void)round_with(link, Vec3{0.0});
  EXPECT_EQ(link.atoms().buttons, 0b100001U) << "thumb to thumb";
}

TEST(PinchOptions, NeedALine) {
  EXPECT_EQ(pinch_settings({{"port", "/dev/ttyS0"}}).baud, 9600);
  EXPECT_EQ(pinch_settings({{"port", "/dev/ttyS0"}, {"baud", "19200"}}).baud, 19200);
  EXPECT_THROW((void)pinch_settings({}), Error);
  EXPECT_THROW((void)pinch_settings({{"port", "/dev/ttyS0"}, {"baud", "9601"}}), Error);
  EXPECT_THROW((void)pinch_settings({{"port", "/dev/ttyS0"}, {"hand", "left"}}), Error);
}

}  // namespace
}  // namespace palpate::test
