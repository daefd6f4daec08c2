/// Two endpoints of a USB device as a stream of bytes.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver/transport/usb.h"

namespace palpate {

class UsbStream final : public ByteStream {
 public:
  UsbStream(std::shared_ptr<UsbConnection> connection, const UsbEndpoint& out, const UsbEndpoint& in)
      : connection_(std::move(connection)), out_(out), in_(in) {}

  /// @pre `data` has room for a packet.
  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    TransferResult got = connection_->read(in_, data, seconds);
    // A transfer that would have taken more has what came until its time was over.
    if (got.status == TransferStatus::kTimeout && got.bytes > 0) got.status = TransferStatus::kOk;
    // An empty packet is nothing.
    if (got.ok() && got.bytes == 0) got.status = TransferStatus::kTimeout;
    return got;
  }
  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    TransferResult sent = connection_->write(out_, data, seconds);
    if (sent.ok() && sent.bytes < data.size()) sent.status = TransferStatus::kTimeout;
    return sent;
  }

 private:
  std::shared_ptr<UsbConnection> connection_;
  UsbEndpoint out_, in_;
};

}  // namespace palpate
