// Messages of VRPN, and the local model of a force that is sent in one.

#include "common/device/driver/vrpn/vrpn_message.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/device/driver/vrpn/local_field.h"
#include "common/math/symmetric3.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

// As they stand in VRPN's own sources: packed by hand.
Bytes hex(const char* text) {
  Bytes bytes;
  for (const char* p = text; *p != '\0';) {
    if (*p == ' ') {
      ++p;
      continue;
    }
    const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    bytes.push_back(static_cast<std::uint8_t>(16 * digit(p[0]) + digit(p[1])));
    p += 2;
  }
  return bytes;
}

Bytes text(const std::string& letters) { return {letters.begin(), letters.end()}; }

// sender 2, type 5, 10 bytes of payload filled up to 16 with rubbish.
const Bytes kCookie = text("vrpn: ver. 07.36  0\x01\x02\x03\x04\x05");
const Bytes kMessage =
    hex("00000022 00000001 00000002 00000002 00000005 00000009 01020304 05060708 090a eeee eeee eeee");

struct Heard {
  std::vector<VrpnMessage> messages;
  std::vector<Bytes> payloads;
  bool cookie = false, nonsense = false;
};

Heard hear(const Bytes& bytes, std::size_t piece) {
  Heard heard;
  VrpnParser parser;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    std::span<const std::uint8_t> part = std::span(bytes).subspan(at, std::min(piece, bytes.size() - at));
    for (;;) {
      VrpnMessage message;
      const auto found = parser.push(part, message);
      if (found == VrpnParser::Found::kNothing) break;
      if (found == VrpnParser::Found::kNonsense) {
        heard.nonsense = true;
        return heard;
      }
      if (found == VrpnParser::Found::kCookie) {
        heard.cookie = true;
      } else {
        heard.messages.push_back(message);
        heard.payloads.emplace_back(message.payload.begin(), message.payload.end());
      }
    }
  }
  return heard;
}

TEST(VrpnParser, TakesAStreamApartInWhateverPiecesItComes) {
  Bytes stream = kCookie;
  for (int n = 0; n < 3; ++n) stream.insert(stream.end(), kMessage.begin(), kMessage.end());
  for (const std::size_t piece : {1UL, 3UL, 7UL, 24UL, 25UL, 40UL, 1000UL}) {
    const Heard heard = hear(stream, piece);
    EXPECT_TRUE(heard.cookie);
    ASSERT_EQ(heard.messages.size(), 3U) << piece;
    EXPECT_EQ(heard.messages[2].sender, 2);
    EXPECT_EQ(heard.messages[2].type, 5);
    EXPECT_EQ(heard.payloads[2], hex("0102030405060708090a"));
  }
}

TEST(VrpnParser, RefusesOtherProtocolsAndLengthsThatNoneHas) {
  for (const Bytes& stream : {text("HTTP/1.1 200 OK\r\n\r\n     "), text("vrpn: ver. 06.38  0     "),
                              text("vrpn: ver. 08.00  0     ")}) {
    EXPECT_TRUE(hear(stream, 5).nonsense);
  }
  for (const char* length : {"00000017", "00000000", "ffffffff", "80000000", "00010001"}) {
    Bytes stream = kCookie, message = kMessage;
    const Bytes bad = hex(length);
    std::copy(bad.begin(), bad.end(), message.begin());
    stream.insert(stream.end(), message.begin(), message.end());
    EXPECT_TRUE(hear(stream, 9).nonsense) << length;
  }
}

TEST(VrpnParser, SkipsPayloadsThatAreTooLongAndGoesOnAfterThem) {
  Bytes stream = kCookie;
  Bytes header(kMessage.begin(), kMessage.begin() + 24);
  header[2] = 0x80;  // 32802 bytes
  stream.insert(stream.end(), header.begin(), header.end());
  stream.insert(stream.end(), 32784, 0x55);
  stream.insert(stream.end(), kMessage.begin(), kMessage.end());
  for (const std::size_t piece : {100UL, 100000UL}) {
    const Heard heard = hear(stream, piece);
    ASSERT_EQ(heard.messages.size(), 2U);
    EXPECT_TRUE(heard.payloads[0].empty());
    EXPECT_EQ(heard.payloads[1], hex("0102030405060708090a"));
  }
}

TEST(VrpnParser, SurvivesAnyBytesWithoutAllocating) {
  std::mt19937 random{7};
  std::array<std::uint8_t, 4096> bytes{};
  VrpnNames names("Tracker0");
  const AllocationGuard guard;
  for (int n = 0; n < 3000; ++n) {
    VrpnParser parser;
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % (n % 2 == 0 ? 256 : 3));
    std::copy(kCookie.begin(), kCookie.end(), bytes.begin());
    // Lengths that may be one, so that more than the first is looked at.
    bytes[24] = bytes[25] = bytes[26] = 0;
    std::span<const std::uint8_t> left(bytes);
    VrpnMessage message;
    for (int most = 0; most < 1000; ++most) {
      const auto found = parser.push(left, message);
      if (found == VrpnParser::Found::kNothing || found == VrpnParser::Found::kNonsense) break;
      if (found == VrpnParser::Found::kCookie) continue;
      message.type = static_cast<std::int32_t>(random() % 6) - 3;
      names.take(message);
      std::array<double, 6> values{};
      (void)vrpn_pose(message.payload);
      (void)vrpn_button_change(message.payload, 1);
      (void)vrpn_button_states(message.payload);
      (void)vrpn_channels(message.payload, values);
      for (const double value : values) ASSERT_LE(std::abs(value), 1.0);
    }
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(VrpnNames, AreByNumbersOfTheOtherSide) {
  VrpnNames names("Phantom0");
  const auto describe = [&](std::int32_t kind, std::int32_t number, const std::string& name) {
    std::array<std::uint8_t, 256> memory{};
    VrpnWriter writer(memory);
    writer.description(kind, number, name);
    Bytes stream = kCookie;
    stream.insert(stream.end(), writer.bytes().begin(), writer.bytes().end());
    const Heard heard = hear(stream, 1000);
    VrpnMessage message = heard.messages.at(0);
    message.payload = heard.payloads.at(0);
    names.take(message);
  };
  describe(kVrpnSenders, 1999, "Phantom0");
  describe(kVrpnSenders, 4, "Phantom01");
  describe(kVrpnSenders, 2000, "Phantom0");
  describe(kVrpnSenders, -5, "Phantom0");
  describe(kVrpnTypes, 1234, "vrpn_Tracker Pos_Quat");
  describe(kVrpnTypes, 3, "vrpn_Tracker Pos_Quatx");
  EXPECT_TRUE(names.is_device(1999));
  for (const std::int32_t other : {4, 2000, -5, 0, 2147483647}) EXPECT_FALSE(names.is_device(other)) << other;
  EXPECT_EQ(names.type(1234), VrpnType::kPosQuat);
  for (const std::int32_t other : {3, -2, 2000}) EXPECT_EQ(names.type(other), VrpnType::kOther);
  describe(kVrpnTypes, 1234, "vrpn_Button Change");
  EXPECT_EQ(names.type(1234), VrpnType::kButtonChange) << "the newest holds";
  // Lengths that lie.
  for (const char* payload : {"0000000a 50686100", "00000000 00", "ffffffff 5000", "00000002 50", "00"}) {
    const Bytes bytes = hex(payload);
    names.take({.sender = 8, .type = kVrpnSenders, .payload = bytes});
    EXPECT_FALSE(names.is_device(8)) << payload;
  }
}

// 0.25, -0.5, 2 m; a quarter turn about z, x, y, z, w.
TEST(VrpnPayload, OfAPose) {
  const Bytes good =
      hex("00000003 00000000 3fd0000000000000 bfe0000000000000 4000000000000000 "
          "0000000000000000 0000000000000000 3fe6a09e667f3bcd 3fe6a09e667f3bcd");
  const auto pose = vrpn_pose(good);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->sensor, 3);
  EXPECT_EQ(pose->position, Vec3(0.25, -0.5, 2.0));
  EXPECT_NEAR(pose->orientation.w, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(pose->orientation.z, std::sqrt(0.5), 1e-15);
  Bytes bad = good;
  bad.pop_back();
  EXPECT_FALSE(vrpn_pose(bad));
  bad = good;
  bad[8] = 0x7F, bad[9] = 0xF8;  // not a number
  EXPECT_FALSE(vrpn_pose(bad));
  bad = good;
  bad[48] = bad[56] = 0x40;  // not of unit length
  EXPECT_FALSE(vrpn_pose(bad));
}

TEST(VrpnPayload, OfButtonsAndChannels) {
  EXPECT_EQ(vrpn_button_change(hex("00000001 00000001"), 1), 3U);
  EXPECT_EQ(vrpn_button_change(hex("00000000 00000000"), 3), 2U);
  EXPECT_EQ(vrpn_button_change(hex("00000028 00000001"), 3), 3U) << "beyond what is known";
  EXPECT_FALSE(vrpn_button_change(hex("00000001 00000002"), 0));
  EXPECT_FALSE(vrpn_button_change(hex("00000001"), 0));
  EXPECT_EQ(vrpn_button_states(hex("00000003 00000001 00000000 00000001")), 5U);
  EXPECT_FALSE(vrpn_button_states(hex("00000004 00000001 00000000 00000001")));
  EXPECT_FALSE(vrpn_button_states(hex("ffffffff")));
  std::array<double, 2> values{};
  EXPECT_EQ(vrpn_channels(hex("4008000000000000 3fe0000000000000 c010000000000000 0000000000000000"), values),
            2U);
  EXPECT_EQ(values[0], 0.5);
  EXPECT_EQ(values[1], -1.0) << "clamped";
  for (const char* payload :
       {"", "bff0000000000000", "7ff8000000000000", "3fe0000000000000", "4350000000000000"}) {
    EXPECT_FALSE(vrpn_channels(hex(payload), values)) << payload;
  }
}

TEST(VrpnWriter, PacksAsTheSourcesSayAndNeverBeyondItsMemory) {
  std::array<std::uint8_t, 256> memory{};
  VrpnWriter writer(memory);
  writer.cookie();
  writer.description(kVrpnTypes, 2, "ab");
  EXPECT_EQ(std::memcmp(memory.data(), "vrpn: ver. 07.38  0", 19), 0);
  const Bytes packed(writer.bytes().begin() + 24, writer.bytes().end());
  EXPECT_EQ(packed, hex("0000001f 00000000 00000000 00000002 fffffffe 00000000 00000003 616200 00"));
  VrpnWriter field({memory.data() + 100, 88});
  field.force_field(
      12.5, 1, 6, {{1.0, 2.0, -0.5}, {0.0, 0.0, 1.0}, Mat3{{-1, -2, -3}, {-4, -5, -6}, {-7, -8, -9}}, 0.25});
  EXPECT_FALSE(field.overflowed());
  EXPECT_EQ(Bytes(field.bytes().begin(), field.bytes().end()),
            hex("00000058 0000000c 0007a120 00000001 00000006 00000000 3f800000 40000000 bf000000 00000000 "
                "00000000 "
                "3f800000 bf800000 c0800000 c0e00000 c0000000 c0a00000 c1000000 c0400000 c0c00000 c1100000 "
                "3e800000"));
  field.empty(0.0, 0, 0);
  EXPECT_TRUE(field.overflowed());
  EXPECT_EQ(field.bytes().size(), 88U);
}

// Along a line a linear force is known after one step, in space after three; what is felt between two models
// is then exact, where a force that is only held is off by stiffness times movement.
TEST(LocalField, FindsASpringAfterThreeSteps) {
  const Mat3 spring{{-200.0, 30.0, 0.0}, {30.0, -150.0, 10.0}, {0.0, 10.0, -80.0}};
  const Vec3 rest{0.001, -0.002, 0.0};
  LocalField field(10.0, 400.0, 0.01);
  std::mt19937 random{3};
  std::uniform_real_distribution<double> near{-0.004, 0.004};
  for (int n = 0; n < 60; ++n) {
    const Vec3 x{near(random), near(random), near(random)};
    field.add(x, spring * (x - rest));
  }
  const LocalField::Model model = field.model();
  for (int n = 0; n < 20; ++n) {
    const Vec3 p = model.origin + Vec3{near(random), near(random), near(random)};
    EXPECT_NEAR(glm::distance(model.force + model.stiffness * (p - model.origin), spring * (p - rest)), 0.0,
                1e-3);
  }
}

TEST(LocalField, IsPassiveBoundedAndFiniteWhateverItIsTold) {
  constexpr double kCap = 3.0, kStiffest = 300.0, kRadius = 0.01;
  LocalField field(kCap, kStiffest, kRadius);
  std::mt19937 random{8};
  std::uniform_real_distribution<double> unit{-1.0, 1.0};
  const AllocationGuard guard;
  for (int n = 0; n < 100'000; ++n) {
    const double reach = std::pow(10.0, 6.0 * unit(random) - 4.0), size = std::pow(10.0, 8.0 * unit(random));
    Vec3 force = size * Vec3{unit(random), unit(random), unit(random)};
    if (n % 97 == 0) force.y = std::nan("");
    if (n % 89 == 0) force = Vec3{0.0};
    field.add(reach * Vec3{unit(random), unit(random), unit(random)}, force);
    const LocalField::Model model = field.model();
    const Vec3 values = symmetric_eigenvalues(model.stiffness);
    ASSERT_LE(values[0], 1e-6);
    ASSERT_GE(values[2], -kStiffest * (1.0 + 1e-9));
    ASSERT_LE(glm::length(model.force) - values[2] * model.radius, kCap * (1.0 + 1e-9));
    if (force == Vec3{0.0} || !is_finite(force)) {
      ASSERT_EQ(model.radius, 0.0);
    }
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
