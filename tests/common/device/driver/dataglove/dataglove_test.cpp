// The 5DT Data Glove on USB, reports and link, against an emulated one in simulated time.

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/device/driver/dataglove/dataglove_link.h"
#include "common/device/driver/transport/usb_search.h"
#include "tests/common/device/driver/dataglove/dataglove_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/fake_usb.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

TEST(DataGloveReport, HoldsSixteenNumbersHighByteFirst) {
  std::vector<std::uint8_t> report(64, 0);
  report[0] = 0x10;  // full scale
  report[6] = 0x08;
  report[31] = 0x01;
  const auto numbers = glove_numbers(report);
  ASSERT_TRUE(numbers);
  EXPECT_EQ((*numbers)[0], 1.0);
  EXPECT_EQ((*numbers)[3], 0.5);
  EXPECT_EQ((*numbers)[15], 1.0 / 4096.0);
  report[1] = 0x01;
  EXPECT_FALSE(glove_numbers(report)) << "beyond full scale";
  report[1] = 0;
  report.pop_back();
  EXPECT_FALSE(glove_numbers(report)) << "cut";
}

TEST(DataGloveReport, TellsModelsByTheirProductId) {
  EXPECT_EQ(GloveModel{0x0000}.sensors(), 14U);
  EXPECT_EQ(GloveModel{0x0011}.sensors(), 5U);
  EXPECT_TRUE(GloveModel{0x0011}.left());
  EXPECT_FALSE(GloveModel{0x0012}.left());
  for (const int product : {0x00, 0x01, 0x10, 0x11, 0x02, 0x03, 0x12, 0x13, 0x06, 0x07, 0x16, 0x17}) {
    const KnownDevice* const known = find_known({0x5d70, static_cast<std::uint16_t>(product)});
    ASSERT_NE(known, nullptr) << product;
    EXPECT_EQ(known->driver, "dataglove");
  }
}

TEST(DataGloveReport, LearnsARangeAndIsNotSpoiltByOneWrongReading) {
  BendRange range;
  EXPECT_EQ(range.bend(0.5), 0.0) << "nothing is known yet";
  for (int n = 0; n < 2; ++n) (void)range.bend(0.2);
  for (int n = 0; n < 2; ++n) (void)range.bend(0.6);
  EXPECT_NEAR(range.bend(0.5), 0.75, 1e-12);
  EXPECT_EQ(range.bend(1.0), 1.0);
  EXPECT_NEAR(range.bend(0.5), 0.75, 1e-12) << "a single one is not believed";
}

TEST(DataGloveReport, SurvivesAnyBytes) {
  std::mt19937 random{3};
  std::array<std::uint8_t, 64> report{};
  const AllocationGuard guard;
  for (int n = 0; n < 100'000; ++n) {
    for (std::size_t i = 0; i < report.size(); ++i)
      report[i] = static_cast<std::uint8_t>(i % 2 == 0 ? random() % 18 : random());
    const auto numbers = glove_numbers(std::span(report).first(n % 3 == 0 ? random() % 65 : 64));
    if (!numbers) continue;
    for (const double part : *numbers) ASSERT_TRUE(part >= 0.0 && part <= 1.0);
  }
  EXPECT_EQ(guard.count(), 0U);
}

class DataGloveLinkTest : public ::testing::Test {
 protected:
  void plug(std::uint16_t product = 0x0010) {
    glove_ = std::make_shared<DataGloveEmulator>(UsbId{0x5d70, product});
    bus_.plug("1-6", glove_);
    link_ = std::make_unique<DataGloveLink>(bus_);
    run(0.2);
  }
  void run(double seconds) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) (void)round_with(*link_, Vec3{0.0});
  }
  /// A fist and a flat hand, as its wearer is asked to make.
  void teach() {
    glove_->bend_all(1.0);
    run(0.2);
    glove_->bend_all(0.0);
    run(0.2);
  }
  [[nodiscard]] const DeviceAtoms& atoms() const { return link_->atoms(); }

  FakeUsb bus_;
  std::shared_ptr<DataGloveEmulator> glove_;
  std::unique_ptr<DataGloveLink> link_;
};

TEST_F(DataGloveLinkTest, FollowsTheFingersOfBothModels) {
  for (const std::uint16_t product : {std::uint16_t{0x0010}, std::uint16_t{0x0001}}) {
    plug(product);
    ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
    const bool five = product == 0x0010;
    ASSERT_EQ(atoms().bend_count, five ? 5 : 14);
    teach();
    glove_->bend(3, 0.75);  // the index finger
    run(0.1);
    EXPECT_NEAR(atoms().bends[five ? 1 : 3], 0.75, 1e-3);
    EXPECT_NEAR(atoms().bends[0], 0.0, 1e-3);
    EXPECT_EQ(atoms().buttons, 0b10U);
    EXPECT_FALSE(atoms().has_valuators || atoms().has_position);
    glove_->bend(3, 0.5);
    run(0.1);
    EXPECT_EQ(atoms().buttons, 0b10U) << "between both limits it stays";
    glove_->bend(3, 0.3);
    run(0.1);
    EXPECT_EQ(atoms().buttons, 0U);
    bus_.unplug("1-6");
  }
}

TEST_F(DataGloveLinkTest, IsAnOpenHandOnceItIsSilentOrGone) {
  plug();
  teach();
  glove_->bend_all(1.0);
  run(0.1);
  ASSERT_EQ(atoms().buttons, 0b11111U);
  glove_->hang(true);
  run(DataGloveLink::kSilence + 0.02);
  EXPECT_EQ(atoms().buttons, 0U);
  run(2.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("nothing that makes sense"), std::string::npos);
  glove_->hang(false);
  run(0.1);
  ASSERT_EQ(atoms().buttons, 0b11111U);
  const double pulled = bus_.now();
  bus_.unplug("1-6");
  while (atoms().buttons != 0) (void)round_with(*link_, Vec3{0.0});
  EXPECT_LT(bus_.now() - pulled, 0.1);
  EXPECT_EQ(bus_.open_connections(), 0);
  bus_.refuse(TransferStatus::kDenied);
  bus_.plug("1-7", glove_);
  run(0.3);
  EXPECT_NE(link_->advice().find("`doctor`"), std::string::npos);
  bus_.refuse(TransferStatus::kOk);
  run(0.5);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(link_->place(), "usb 1-7");
}

TEST_F(DataGloveLinkTest, BearsEveryFaultForTwoHours) {
  plug();
  std::mt19937_64 random{12};
  std::uniform_real_distribution<double> unit;
  std::uint64_t fists = 0;
  const double seconds = soak_seconds(kTwoHours);
  while (bus_.now() < seconds) {
    const bool bad = unit(random) < 0.5;
    const auto rate = [&](double most) { return bad ? most * unit(random) : 0.0; };
    bus_.set_faults({.lost_read = rate(0.3),
                     .corrupt_read = rate(0.3),
                     .short_read = rate(0.3),
                     .late_read = rate(0.1),
                     .stall = rate(0.2),
                     .seed = random()});
    if (unit(random) < 0.05) bus_.unplug_at_transfer(1 + random() % 500);
    if (unit(random) < 0.1) glove_->say({1, 2, 3});
    glove_->hang(unit(random) < 0.05);
    glove_->bend_all(unit(random) < 0.5 ? 1.0 : 0.0);
    for (const double until = bus_.now() + 2.0 * unit(random); bus_.now() < until;) {
      (void)round_with(*link_, Vec3{1.0});
      if (atoms().buttons == 0b11111U) ++fists;
      for (const double each : atoms().bends) ASSERT_TRUE(each >= 0.0 && each <= 1.0);
      ASSERT_LT(atoms().buttons, 32U);
    }
    if (bus_.devices().empty()) bus_.plug("1-6", glove_);
    ASSERT_LE(bus_.open_connections(), 1);
  }
  EXPECT_GT(static_cast<double>(fists), 2.5 * seconds);
  bus_.set_faults({});
  glove_->hang(false);
  glove_->bend_all(0.0);
  run(1.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(atoms().buttons, 0U);
}

}  // namespace
}  // namespace palpate::test
