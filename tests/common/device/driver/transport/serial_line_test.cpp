// Serial lines through real pseudo terminals: bytes of every value both ways, time that is kept, and what is
// said of a line that is not there, is none, or was pulled out.

#include "common/device/driver/transport/serial_line.h"

#include <array>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/device/driver/transport/pty_pair.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// Says back what it hears, each byte turned over.
class Mirror final : public Speaker {
 public:
  void hear(double, std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) said_.push_back(static_cast<std::uint8_t>(~byte));
  }
  void speak(double, std::vector<std::uint8_t>& bytes) override {
    bytes.insert(bytes.end(), said_.begin(), said_.end());
    said_.clear();
  }

 private:
  std::vector<std::uint8_t> said_;
};

TEST(SerialLine, CarriesBytesOfEveryValueBothWays) {
  const PtyPair pair(std::make_shared<Mirror>());
  SerialLine line(pair.path(), 19200);
  const StreamOpened opened = line.open();
  ASSERT_EQ(opened.status, TransferStatus::kOk);
  // Among them those that end lines, stop output, or interrupt programs on a terminal.
  std::array<std::uint8_t, 256> all{};
  std::iota(all.begin(), all.end(), std::uint8_t{0});
  const TransferResult sent = opened.stream->write(all, 10.0);
  EXPECT_TRUE(sent.ok());
  EXPECT_EQ(sent.bytes, all.size());
  std::vector<std::uint8_t> back;
  for (std::array<std::uint8_t, 64> part{}; back.size() < all.size();) {
    const TransferResult got = opened.stream->read(part, 10.0);
    ASSERT_TRUE(got.ok()) << name_of(got.status);
    back.insert(back.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(got.bytes));
  }
  ASSERT_EQ(back.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(back[i], 255 - all[i]);
}

TEST(SerialLine, WaitsAsLongAsItIsToldAndNotesThatTheLineIsGone) {
  auto pair = std::make_unique<PtyPair>(std::make_shared<Mirror>());
  SerialLine line(pair->path(), 9600);
  const StreamOpened opened = line.open();
  ASSERT_EQ(opened.status, TransferStatus::kOk);
  std::array<std::uint8_t, 8> data{};
  const double start = line.now();
  EXPECT_EQ(opened.stream->read(data, 0.02).status, TransferStatus::kTimeout);
  EXPECT_GE(line.now() - start, 0.019);
  pair.reset();
  EXPECT_EQ(opened.stream->read(data, 10.0).status, TransferStatus::kGone);
  EXPECT_EQ(opened.stream->write(data, 10.0).status, TransferStatus::kGone);
}

TEST(SerialLine, SaysWhatCannotBeOpened) {
  const TempFolder folder;
  folder.write("text", "no line");
  EXPECT_EQ(SerialLine(folder.path("none").string(), 9600).open().status, TransferStatus::kGone);
  EXPECT_EQ(SerialLine(folder.path("text").string(), 9600).open().status, TransferStatus::kFailed);
}

}  // namespace
}  // namespace palpate::test
