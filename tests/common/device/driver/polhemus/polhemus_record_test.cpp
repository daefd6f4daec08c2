// Records of Polhemus trackers in streams of bytes: known ones to the byte, damaged ones, and none at all.

#include "common/device/driver/polhemus/polhemus_record.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/device/driver/polhemus/polhemus_emulator.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using enum LibertyItem;
constexpr std::array kGoldenOrder{kTime, kFrame, kDistortion, kPositionExtended, kQuaternion};
constexpr std::array kOrder{kTime, kFrame, kDistortion, kPositionExtended, kQuaternion, kButton};

template <class Parser>
std::vector<PolhemusNews> all_news(Parser& parser, const Bytes& bytes) {
  std::vector<PolhemusNews> all;
  for (const std::uint8_t byte : bytes) {
    if (const auto news = parser.push(byte)) all.push_back(*news);
  }
  return all;
}

// Station 2, 1000 ms, frame 5, at (10, -2.5, 0.5), turned by (1, 1, 1, -1) / 2.
const Bytes kLiberty{'L', 'Y', 2, 'C',  ' ', 0, 40,   0,    0xE8, 0x03, 0,    0,    5, 0, 0, 0,
                     0,   0,   0, 0,    0,   0, 0x20, 0x41, 0,    0,    0x20, 0xC0, 0, 0, 0, 0x3F,
                     0,   0,   0, 0x3F, 0,   0, 0,    0x3F, 0,    0,    0,    0x3F, 0, 0, 0, 0xBF};
const Bytes kFastrak{'0', '3',  ' ', 0, 0, 0x20, 0x41, 0, 0, 0x20, 0xC0, 0, 0, 0,    0x3F, 0,   0,
                     0,   0x3F, 0,   0, 0, 0x3F, 0,    0, 0, 0x3F, 0,    0, 0, 0xBF, ' ',  '1', ' '};

void expect_known(const PolhemusRecord& record) {
  EXPECT_EQ(record.position, Vec3(10.0, -2.5, 0.5));
  EXPECT_EQ(record.orientation, Quat(0.5, 0.5, 0.5, -0.5));
  EXPECT_EQ(record.error, ' ');
}

TEST(PolhemusRecord, HasTheLengthsOfTheOrders) {
  EXPECT_EQ(LibertyParser(kGoldenOrder).record_bytes(), 48U);
  EXPECT_EQ(LibertyParser(kOrder).record_bytes(), 52U);
  EXPECT_EQ(LibertyParser(std::array{kPosition, kQuaternion, kTime, kSpace}).record_bytes(), 41U);
  EXPECT_EQ(LibertyParser(std::array{kPosition, kQuaternion, kTime, kButton, kSpace}).record_bytes(), 45U);
  EXPECT_EQ(kLiberty.size(), 48U);
  EXPECT_EQ(kFastrak.size(), FastrakParser::kRecord);
}

TEST(PolhemusRecord, ReadsKnownBytes) {
  for (const auto& [first, second] : {std::pair{'L', 'Y'}, {'P', 'A'}, {'L', 'U'}}) {
    LibertyParser parser(kGoldenOrder);
    Bytes bytes = kLiberty;
    bytes[0] = static_cast<std::uint8_t>(first);
    bytes[1] = static_cast<std::uint8_t>(second);
    const auto news = all_news(parser, bytes);
    ASSERT_EQ(news.size(), 1U);
    const auto& record = std::get<PolhemusRecord>(news[0]);
    expect_known(record);
    EXPECT_EQ(record.station, 2);
    EXPECT_EQ(record.time, 1000U);
    EXPECT_EQ(record.frame, 5U);
    EXPECT_FALSE(record.button);
    EXPECT_EQ(parser.dropped(), 0U);
  }
  FastrakParser parser;
  const auto news = all_news(parser, kFastrak);
  ASSERT_EQ(news.size(), 1U);
  const auto& record = std::get<PolhemusRecord>(news[0]);
  expect_known(record);
  EXPECT_EQ(record.station, 3);
  EXPECT_TRUE(record.button);
}

TEST(PolhemusRecord, ReadsWhichStationsThereAre) {
  LibertyParser parser(kOrder);
  const auto news = all_news(parser, {'L', 'Y', 0, 21, ' ', 0, 4, 0, 0x0F, 0x00, 0x05, 0x80});
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(std::get<PolhemusStations>(news[0]).detected, 0x000F);
  EXPECT_EQ(std::get<PolhemusStations>(news[0]).active, 0x8005);
}

// Whatever one byte of a record is changed to: it is refused, or what it says is near.
TEST(PolhemusRecord, RefusesWhatIsNoRecord) {
  for (const std::size_t at : {0U, 1U, 3U, 6U, 7U}) {
    for (int value = 0; value < 256; ++value) {
      Bytes bytes = kLiberty;
      if (value == bytes[at]) continue;
      bytes[at] = static_cast<std::uint8_t>(value);
      LibertyParser parser(kGoldenOrder);
      const auto news = all_news(parser, bytes);
      // Other names of the family, and the answer to another command.
      const bool meant =
          (at == 1 && value == 'U') || (at == 3 && (value == 'P' || value == 'c' || value == 'p'));
      ASSERT_EQ(news.size(), meant ? 1U : 0U) << at << " " << value;
    }
  }
  const auto refused = [](Bytes bytes, std::size_t at, std::initializer_list<std::uint8_t> with) {
    std::copy(with.begin(), with.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
    LibertyParser parser(kGoldenOrder);
    return all_news(parser, bytes).empty();
  };
  EXPECT_TRUE(refused(kLiberty, 2, {0}));
  EXPECT_TRUE(refused(kLiberty, 2, {17}));
  EXPECT_TRUE(refused(kLiberty, 20, {0, 0, 0xC0, 0x7F})) << "not a number";
  EXPECT_TRUE(refused(kLiberty, 20, {0, 0, 0x80, 0x7F})) << "infinity";
  EXPECT_TRUE(refused(kLiberty, 20, {0, 0x50, 0xC3, 0x47})) << "a hundred thousand";
  EXPECT_TRUE(refused(kLiberty, 32, {0, 0, 0x80, 0x3F})) << "no unit quaternion";
}

// After any damage the next record that comes whole is found, and nothing is made up.
TEST(PolhemusRecord, LosesNoWholeRecordAfterOneThatIsCut) {
  for (std::size_t kept = 0; kept < kLiberty.size(); ++kept) {
    LibertyParser parser(kGoldenOrder);
    Bytes bytes(kLiberty.begin(), kLiberty.begin() + static_cast<std::ptrdiff_t>(kept));
    for (int n = 0; n < 2; ++n) bytes.insert(bytes.end(), kLiberty.begin(), kLiberty.end());
    const auto news = all_news(parser, bytes);
    ASSERT_EQ(news.size(), 2U) << kept;
    EXPECT_EQ(parser.dropped(), kept);
    for (const PolhemusNews& each : news) expect_known(std::get<PolhemusRecord>(each));
  }
  for (std::size_t kept = 0; kept < kFastrak.size(); ++kept) {
    FastrakParser parser;
    Bytes bytes(kFastrak.begin(), kFastrak.begin() + static_cast<std::ptrdiff_t>(kept));
    for (int n = 0; n < 2; ++n) bytes.insert(bytes.end(), kFastrak.begin(), kFastrak.end());
    const auto news = all_news(parser, bytes);
    ASSERT_EQ(news.size(), 2U) << kept;
    for (const PolhemusNews& each : news) expect_known(std::get<PolhemusRecord>(each));
  }
}

// Made by another hand: the emulator's.
TEST(PolhemusRecord, AgreesWithTheEmulator) {
  for (const bool fastrak : {false, true}) {
    PolhemusEmulator tracker({.fastrak = fastrak, .detected = 0b1011});
    const std::string commands = fastrak ? "fO1,2,11,16,0\rC" : "U1\rF1\rO*,8,9,11,3,7,10\rC\r";
    tracker.hear(0.0, {reinterpret_cast<const std::uint8_t*>(commands.data()), commands.size()});
    Bytes said;
    tracker.speak(0.05, said);
    LibertyParser liberty(kOrder);
    FastrakParser serial;
    const auto news = fastrak ? all_news(serial, said) : all_news(liberty, said);
    ASSERT_GE(news.size(), 12U);
    EXPECT_EQ(fastrak ? serial.dropped() : liberty.dropped(), 0U);
    for (std::size_t i = 0; i < news.size(); ++i) {
      const auto& record = std::get<PolhemusRecord>(news[i]);
      const std::size_t frame = fastrak ? i : i / 3;
      const double time = static_cast<double>(frame) / 240.0;
      constexpr double kRounding = 1e-5;  // of a float, at half a metre in centimetres
      const Vec3 p = (fastrak ? 1.0 / 0.0254 : 100.0) * PolhemusEmulator::position(record.station, time);
      EXPECT_LT(glm::distance(record.position, p), kRounding);
      const Quat q = PolhemusEmulator::orientation(record.station, time);
      EXPECT_LT(angle_of(record.orientation * glm::conjugate(q)), 1e-6);
    }
  }
}

TEST(PolhemusRecord, SurvivesAnyBytesAndGoesOn) {
  std::mt19937 random{5};
  LibertyParser liberty(kGoldenOrder);
  FastrakParser fastrak;
  // Bytes that records begin with are common among them.
  constexpr std::array<std::uint8_t, 12> kLikely{'L', 'Y', 'P', 'A', 1, 'C', ' ', 0, 40, '0', '1', 21};
  const AllocationGuard guard;
  for (int n = 0; n < 1'000'000; ++n) {
    const auto byte =
        random() % 2 == 0 ? kLikely[random() % kLikely.size()] : static_cast<std::uint8_t>(random());
    for (const auto& news : {liberty.push(byte), fastrak.push(byte)}) {
      if (!news) continue;
      if (const auto* const record = std::get_if<PolhemusRecord>(&*news)) {
        ASSERT_TRUE(record->station >= 1 && record->station <= 16);
        ASSERT_LT(std::abs(glm::length(record->orientation) - 1.0), 1e-12);
        ASSERT_TRUE(is_finite(record->position));
      }
    }
    if (n % 1000 != 999) continue;
    // At most one record is lost to what came before.
    int found = 0;
    for (int times = 0; times < 2; ++times) {
      for (const std::uint8_t each : kLiberty) found += liberty.push(each) ? 1 : 0;
      for (const std::uint8_t each : kFastrak) found += fastrak.push(each) ? 1 : 0;
    }
    ASSERT_GE(found, 2);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
