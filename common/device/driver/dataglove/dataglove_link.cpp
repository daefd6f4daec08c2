#include "common/device/driver/dataglove/dataglove_link.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/device/driver/transport/usb_search.h"

namespace palpate {
namespace {

constexpr double kGloveReportTime = 0.010;  // [s] that one round waits for a report
constexpr std::size_t kGloveBytes = 64;     // [bytes] of a report

}  // namespace

std::optional<std::array<double, kGloveNumbers>> glove_numbers(
    std::span<const std::uint8_t> report) noexcept {
  constexpr std::size_t kReport = 64;
  constexpr unsigned kFull = 4096;
  if (report.size() != kReport) return std::nullopt;
  std::array<double, kGloveNumbers> numbers{};
  for (std::size_t i = 0; i < kGloveNumbers; ++i) {
    const unsigned raw = static_cast<unsigned>(report[2 * i]) << 8U | report[2 * i + 1];
    if (raw > kFull) return std::nullopt;
    numbers[i] = static_cast<double>(raw) / kFull;
  }
  return numbers;
}

double BendRange::bend(double part) noexcept {
  const double before = before_ < 0.0 ? part : before_;
  before_ = part;
  lower_ = std::min(lower_, std::max(before, part));
  upper_ = std::max(upper_, std::min(before, part));
  if (!(upper_ - lower_ >= kLeast)) return 0.0;
  return std::clamp((part - lower_) / (upper_ - lower_), 0.0, 1.0);
}

std::string DataGloveLink::advice() const {
  if (status_.phase == LinkPhase::kReady) return {};
  if (connection_) return "the Data Glove sends nothing that makes sense; plug it in anew";
  if (refused_ == TransferStatus::kOk) return "no Data Glove is plugged in";
  return refusal_advice("the Data Glove", refused_);
}

bool DataGloveLink::round() noexcept {
  if (!connection_) {
    search();
    return false;
  }
  std::array<std::uint8_t, kGloveBytes> report{};
  const TransferResult got = connection_->read(reports_, report, kGloveReportTime);
  const double now = transport_.now();
  if (given_up(got.status, kMostMisses, misses_)) {
    ++status_.faults;
    connection_.reset();
    path_.clear();
    refused_ = TransferStatus::kOk;
    status_.phase = LinkPhase::kAbsent;
    (void)release();
    return true;  // that its hand is open is news
  }
  if (got.ok()) {
    misses_ = 0;
    if (const auto numbers = glove_numbers(std::span(report).first(std::min(got.bytes, report.size())))) {
      heard_ = now;
      ++status_.rounds;
      status_.phase = LinkPhase::kReady;
      take(*numbers);
      return true;
    }
    status_.dropped += got.bytes;
  }
  if (now - heard_ > kDumb) {
    if (status_.phase == LinkPhase::kReady) ++status_.faults;
    status_.phase = LinkPhase::kRefused;
  }
  return now - heard_ > kSilence && release();
}

void DataGloveLink::take(const std::array<double, kGloveNumbers>& numbers) noexcept {
  atoms_.time = heard_;
  atoms_.bend_count = static_cast<std::uint8_t>(model_.sensors());
  std::array<double, kGloveNumbers> bends{};
  for (std::size_t i = 0; i < kGloveNumbers; ++i) bends[i] = ranges_[i].bend(numbers[i]);
  for (std::size_t finger = 0; finger < kFirstJoints.size(); ++finger) {
    const double bend = bends[kFirstJoints[finger]];
    const std::uint32_t bit = 1U << finger;
    if (bend >= kBent) atoms_.buttons |= bit;
    if (bend < kStretched) atoms_.buttons &= ~bit;
  }
  for (std::size_t i = 0; i < model_.sensors(); ++i)
    atoms_.bends[i] = bends[model_.five() ? kFirstJoints[i] : i];
}

bool DataGloveLink::release() noexcept {
  const bool open = atoms_.buttons == 0 && atoms_.bend_count == 0;
  atoms_ = {};
  atoms_.time = transport_.now();
  return !open;
}

void DataGloveLink::search() noexcept {
  UsbFound found = look_for(transport_, "dataglove", true, status_);
  refused_ = found.refused;
  if (!found.connection) return;
  connection_ = std::move(found.connection);
  reports_ = found.endpoint;
  model_ = {found.device.id.product};
  path_ = std::move(found.device.path);
  ranges_ = {};
  misses_ = 0;
  heard_ = transport_.now();
}

}  // namespace palpate
