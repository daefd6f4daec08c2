#include "common/device/driver/polhemus/polhemus_record.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/base/check.h"

namespace palpate {
namespace {

constexpr std::uint8_t kStationsCommand = 21;  // Ctrl-U
constexpr std::size_t kStationsPayload = 4;
constexpr std::size_t kFloat = 4, kVectorBytes = 3 * kFloat, kQuaternionBytes = 4 * kFloat;
constexpr double kFarthest = 2000.0;  // no tracker reaches so many centimetres or inches
constexpr double kUnitSlack = 0.01;   // of the length of a quaternion

std::uint32_t word_at(const std::uint8_t* at) noexcept {
  return at[0] | static_cast<std::uint32_t>(at[1]) << 8U | static_cast<std::uint32_t>(at[2]) << 16U |
         static_cast<std::uint32_t>(at[3]) << 24U;
}
std::uint16_t half_at(const std::uint8_t* at) noexcept {
  return static_cast<std::uint16_t>(at[0] | static_cast<unsigned>(at[1]) << 8U);
}
double float_at(const std::uint8_t* at) noexcept { return std::bit_cast<float>(word_at(at)); }

/// False where a number of it is none, or far from where a sensor can be.
bool take_position(const std::uint8_t* at, PolhemusRecord& record) noexcept {
  record.position = {float_at(at), float_at(at + kFloat), float_at(at + 2 * kFloat)};
  const auto near = [](double x) { return std::abs(x) <= kFarthest; };  // no NaN
  return near(record.position.x) && near(record.position.y) && near(record.position.z);
}

/// False where it is no unit quaternion.
bool take_quaternion(const std::uint8_t* at, PolhemusRecord& record) noexcept {
  const Quat q{float_at(at), float_at(at + kFloat), float_at(at + 2 * kFloat), float_at(at + 3 * kFloat)};
  const double length = glm::length(q);
  if (!(std::abs(length - 1.0) <= kUnitSlack)) return false;
  record.orientation = q / length;
  return true;
}

bool is_tag(std::uint8_t first, std::uint8_t second) noexcept {
  return (first == 'L' && (second == 'Y' || second == 'U')) || (first == 'P' && second == 'A');
}

}  // namespace

std::size_t bytes_of(LibertyItem item) noexcept {
  switch (item) {
    case LibertyItem::kSpace:
      return 1;
    case LibertyItem::kLineEnd:
      return 2;
    case LibertyItem::kPosition:
    case LibertyItem::kPositionExtended:
    case LibertyItem::kEuler:
    case LibertyItem::kEulerExtended:
      return kVectorBytes;
    case LibertyItem::kQuaternion:
      return kQuaternionBytes;
    case LibertyItem::kTime:
    case LibertyItem::kFrame:
    case LibertyItem::kButton:
    case LibertyItem::kDistortion:
      return 4;
  }
  return 0;
}

LibertyParser::LibertyParser(std::span<const LibertyItem> items) noexcept : item_count_(items.size()) {
  PALPATE_CHECK(items.size() <= kMostItems);
  std::copy(items.begin(), items.end(), items_.begin());
  for (const LibertyItem item : items) payload_ += bytes_of(item);
}

std::optional<PolhemusNews> LibertyParser::push(std::uint8_t byte) noexcept {
  bytes_[size_++] = byte;
  while (size_ > 0) {
    if (!could_begin()) {
      drop_first();
      continue;
    }
    if (size_ < kHeader || size_ < kHeader + half_at(&bytes_[6])) return std::nullopt;
    std::optional<PolhemusNews> news = decoded();
    if (news) {
      size_ = 0;
      return news;
    }
    drop_first();
  }
  return std::nullopt;
}

/// Whether the bytes so far are the first of a record, as far as its header says.
bool LibertyParser::could_begin() const noexcept {
  if (bytes_[0] != 'L' && bytes_[0] != 'P') return false;
  if (size_ > 1 && !is_tag(bytes_[0], bytes_[1])) return false;
  if (size_ <= 3) return true;
  const bool stations = bytes_[3] == kStationsCommand;
  if (!stations) {
    const std::uint8_t command = bytes_[3];
    if (command != 'C' && command != 'c' && command != 'P' && command != 'p') return false;
    if (bytes_[2] < 1 || bytes_[2] > kMostStations) return false;
  }
  const std::size_t follow = stations ? kStationsPayload : payload_;
  return (size_ <= 6 || bytes_[6] == follow % 256) && (size_ <= 7 || bytes_[7] == follow / 256);
}

std::optional<PolhemusNews> LibertyParser::decoded() const noexcept {
  const std::uint8_t* at = &bytes_[kHeader];
  if (bytes_[3] == kStationsCommand) return PolhemusStations{half_at(at), half_at(at + 2)};
  PolhemusRecord record{.station = bytes_[2], .error = static_cast<char>(bytes_[4])};
  bool whole = true;
  for (std::size_t i = 0; i < item_count_; ++i) {
    switch (items_[i]) {
      case LibertyItem::kSpace:
        whole = whole && *at == ' ';
        break;
      case LibertyItem::kLineEnd:
        whole = whole && at[0] == '\r' && at[1] == '\n';
        break;
      case LibertyItem::kPosition:
      case LibertyItem::kPositionExtended:
        whole = whole && take_position(at, record);
        break;
      case LibertyItem::kQuaternion:
        whole = whole && take_quaternion(at, record);
        break;
      case LibertyItem::kTime:
        record.time = word_at(at);
        break;
      case LibertyItem::kFrame:
        record.frame = word_at(at);
        break;
      case LibertyItem::kButton:
        whole = whole && word_at(at) <= 1;
        record.button = word_at(at) == 1;
        break;
      case LibertyItem::kEuler:
      case LibertyItem::kEulerExtended:
      case LibertyItem::kDistortion:
        break;
    }
    at += bytes_of(items_[i]);
  }
  return whole ? std::optional<PolhemusNews>(record) : std::nullopt;
}

void LibertyParser::drop_first() noexcept {
  std::copy(bytes_.begin() + 1, bytes_.begin() + static_cast<std::ptrdiff_t>(size_), bytes_.begin());
  --size_;
  ++dropped_;
}

std::optional<PolhemusNews> FastrakParser::push(std::uint8_t byte) noexcept {
  bytes_[size_++] = byte;
  while (size_ > 0) {
    if (could_begin()) {
      if (size_ < kRecord) return std::nullopt;
      std::optional<PolhemusNews> news = decoded();
      if (news) {
        size_ = 0;
        return news;
      }
    }
    drop_first();
  }
  return std::nullopt;
}

bool FastrakParser::could_begin() const noexcept {
  if (bytes_[0] != '0') return false;
  if (size_ > 1 && (bytes_[1] < '1' || bytes_[1] >= '1' + kMostStations)) return false;
  if (size_ <= 2) return true;
  const std::uint8_t status = bytes_[2];
  return status == ' ' || (status >= 'A' && status <= 'Z') || (status >= 'a' && status <= 'z');
}

std::optional<PolhemusNews> FastrakParser::decoded() const noexcept {
  constexpr std::size_t kPositionAt = 3, kQuaternionAt = kPositionAt + kVectorBytes,
                        kButtonAt = kQuaternionAt + kQuaternionBytes;
  PolhemusRecord record{.station = bytes_[1] - '0',
                        .error = static_cast<char>(bytes_[2]),
                        .button = bytes_[kButtonAt + 1] == '1'};
  const bool framed = bytes_[kButtonAt] == ' ' && bytes_[kRecord - 1] == ' ' &&
                      (bytes_[kButtonAt + 1] == '0' || bytes_[kButtonAt + 1] == '1');
  const bool whole = framed && take_position(&bytes_[kPositionAt], record) &&
                     take_quaternion(&bytes_[kQuaternionAt], record);
  return whole ? std::optional<PolhemusNews>(record) : std::nullopt;
}

void FastrakParser::drop_first() noexcept {
  std::copy(bytes_.begin() + 1, bytes_.begin() + static_cast<std::ptrdiff_t>(size_), bytes_.begin());
  --size_;
  ++dropped_;
}

}  // namespace palpate
