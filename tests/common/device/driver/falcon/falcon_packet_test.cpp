// The wire of the Falcon: published packets, packets cut up and damaged, and what motors may be told.

#include "common/device/driver/falcon/falcon_packet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/device/driver/motor_heat.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

std::string text_of(const FalconPacket& packet) { return {packet.begin(), packet.end()}; }

/// As the firmware writes it, spelled out.
std::string reply_text(const FalconCounts& counts, int buttons, int homed) {
  std::string text = "<";
  for (const std::int16_t count : counts) {
    unsigned bits = static_cast<std::uint16_t>(count);
    for (int n = 0; n < 4; ++n, bits /= 16) text += static_cast<char>('A' + bits % 16);
  }
  text += static_cast<char>('A' + buttons + 16 * homed);
  return text + "A>";
}

std::vector<FalconReply> parse(FalconReplyParser& parser, const std::string& bytes) {
  std::vector<FalconReply> replies;
  for (const char byte : bytes) {
    if (const auto reply = parser.push(static_cast<std::uint8_t>(byte))) replies.push_back(*reply);
  }
  return replies;
}

TEST(FalconPacket, CodesThePublishedCommands) {
  const std::vector<std::pair<FalconCounts, std::string>> golden{{{4095, 3906, 4034}, "PPPACEPACMPA"},
                                                                 {{-65, 136, -159}, "PLPPIIAABGPP"},
                                                                 {{-679, 2529, -1862}, "JFNPBOJAKLIP"},
                                                                 {{100, -50, 25}, "EGAAOMPPJBAA"},
                                                                 {{-800, 200, 400}, "AOMPIMAAAJBA"}};
  for (const auto& [motors, letters] : golden) {
    EXPECT_EQ(text_of(encode({.motors = motors, .homing = false})), "<" + letters + "AA>");
    FalconReplyParser parser;
    const auto replies = parse(parser, "<" + letters + "AA>");
    ASSERT_EQ(replies.size(), 1U);
    EXPECT_EQ(replies[0].encoders, motors);
  }
  EXPECT_EQ(text_of(encode({.homing = false})), "<AAAAAAAAAAAAAA>");
  EXPECT_EQ(text_of(encode({})), "<AAAAAAAAAAAABA>");
  EXPECT_EQ(text_of(encode({.lights = kFalconGreen})), "<AAAAAAAAAAAADA>");
  EXPECT_EQ(text_of(encode({.lights = kFalconBlue, .homing = false})), "<AAAAAAAAAAAAEA>");
}

TEST(FalconPacket, ReadsEveryReplyBack) {
  std::mt19937 random{1};
  FalconReplyParser parser;
  for (int n = 0; n < 20000; ++n) {
    const auto count = [&] { return static_cast<std::int16_t>(random()); };
    const FalconReply reply{{count(), count(), count()},
                            static_cast<std::uint8_t>(random() % 16),
                            static_cast<std::uint8_t>(random() % 8)};
    const auto replies = parse(parser, reply_text(reply.encoders, reply.buttons, reply.homed));
    ASSERT_EQ(replies, std::vector{reply});
  }
  EXPECT_EQ(parser.dropped(), 0U);
}

TEST(FalconPacket, PutsCutAndMergedRepliesTogether) {
  const std::string two = reply_text({1, 2, 3}, 1, 7) + reply_text({-4, 5, -6}, 0, 7);
  for (std::size_t cut = 0; cut <= two.size(); ++cut) {
    FalconReplyParser parser;
    auto replies = parse(parser, two.substr(0, cut));
    const auto more = parse(parser, two.substr(cut));
    replies.insert(replies.end(), more.begin(), more.end());
    ASSERT_EQ(replies.size(), 2U) << cut;
    EXPECT_EQ(replies[1].encoders, (FalconCounts{-4, 5, -6}));
  }
}

// A damaged packet is never taken for another one's whole, and costs none but itself.
TEST(FalconPacket, FindsTheNextReplyAfterAnyDamage) {
  const std::string good = reply_text({300, -200, 100}, 2, 7);
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      std::string bad = good;
      bad[at] = static_cast<char>(value);
      FalconReplyParser parser;
      const auto replies = parse(parser, bad + good);
      ASSERT_GE(replies.size(), 1U);
      ASSERT_EQ(replies.back().encoders, (FalconCounts{300, -200, 100})) << at << " " << value;
    }
    FalconReplyParser parser;
    ASSERT_EQ(parse(parser, good.substr(0, at) + good).size(), 1U) << at;  // bytes that are missing
  }
}

TEST(FalconPacket, SurvivesAnyBytesAndResynchronises) {
  std::mt19937 random{2};
  FalconReplyParser parser;
  const AllocationGuard guard;
  std::uint64_t replies = 0;
  for (int n = 0; n < 1'000'000; ++n) {
    // Mostly bytes of packets, so that long beginnings of them occur.
    const auto byte =
        static_cast<std::uint8_t>(random() % 20 == 0 ? random() : "<>ABCDEFGHIJKLMNOP"[random() % 18]);
    replies += parser.push(byte) ? 1U : 0U;
  }
  EXPECT_EQ(guard.count(), 0U);
  // Every byte was of a reply, or dropped, or waits in the packet that is begun.
  EXPECT_NEAR(static_cast<double>(parser.dropped() + 16 * replies), 1e6, 15.0);
  EXPECT_EQ(parse(parser, reply_text({7, 8, 9}, 0, 7)).size(), 1U);
}

TEST(FalconMotors, AreScaledTogetherSoThatTheForceKeepsItsDirection) {
  const FalconCounts counts = motor_commands({1.0, -3.0, 2.0}, 3500.0);
  EXPECT_EQ(counts[1], kFalconLargestCommand);  // against the sense of the encoders
  EXPECT_NEAR(counts[0], -4095.0 / 3.0, 0.51);
  EXPECT_NEAR(counts[2], -4095.0 * 2.0 / 3.0, 0.51);
  EXPECT_EQ(motor_commands({0.01, 0.0, -0.02}, 3500.0), (FalconCounts{-35, 0, 70}));
  std::mt19937 random{4};
  std::normal_distribution<double> any{0.0, 10.0};
  for (int n = 0; n < 10000; ++n) {
    for (const std::int16_t c : motor_commands({any(random), any(random), any(random)}, 10000.0)) {
      ASSERT_LE(std::abs(c), kFalconLargestCommand);
    }
  }
}

TEST(FalconMotors, AreOffForWhatIsNoNumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& bad : {Vec3{kNan, 0, 0}, Vec3{0, HUGE_VAL, 0}, Vec3{1e308, 1e308, 1e308}}) {
    EXPECT_EQ(motor_commands(bad, 3500.0), FalconCounts{});
  }
}

TEST(FalconMotors, CoolDownToWhatMayLast) {
  constexpr double kLasting = 2048.0, kMost = 4095.0, kTime = 2.0;
  MotorHeat heat(kLasting, kMost, kTime);
  const std::array<double, 3> asked{4095.0, -100.0, 0.0};
  EXPECT_DOUBLE_EQ(heat.factor(asked), 1.0);  // cold
  double squares = 0.0, shown = 0.0;
  constexpr int kSteps = 60000;
  for (int n = 0; n < kSteps; ++n) {
    const double factor = heat.factor(asked);
    shown = factor * asked[0];
    heat.add({shown, factor * asked[1], 0.0}, 1e-3);
    squares += shown * shown;
  }
  EXPECT_NEAR(shown, kLasting, 1.0);
  EXPECT_LT(std::sqrt(squares / kSteps), 1.1 * kLasting);
  for (int n = 0; n < 20000; ++n) heat.add({0.0, 0.0, 0.0}, 1e-3);
  EXPECT_GT(heat.factor(asked), 0.999);
}

// What a bulk transfer holds: packets of 64 bytes, each with two status bytes before its data.
TEST(FtdiStatus, IsTakenOutOfEveryPacketOfATransfer) {
  std::vector<std::uint8_t> transfer;
  std::vector<std::uint8_t> data;
  for (int n = 0; n < 150; ++n) {
    if (transfer.size() % 64 == 0) transfer.insert(transfer.end(), {0x31, 0x60});
    transfer.push_back(static_cast<std::uint8_t>(n));
    data.push_back(static_cast<std::uint8_t>(n));
  }
  const FtdiRead read = strip_ftdi_status(transfer);
  EXPECT_EQ(read.bytes, data.size());
  EXPECT_TRUE(std::equal(data.begin(), data.end(), transfer.begin()));
  EXPECT_TRUE(read.has_status);
  EXPECT_NE(read.modem & kFtdiClearToSend, 0);

  std::vector<std::uint8_t> nothing{0x01, 0x60}, less{0x01};
  EXPECT_EQ(strip_ftdi_status(nothing).bytes, 0U);
  EXPECT_TRUE(strip_ftdi_status(nothing).has_status);
  EXPECT_FALSE(strip_ftdi_status(less).has_status);
  EXPECT_FALSE(strip_ftdi_status({}).has_status);
}

}  // namespace
}  // namespace palpate::test
