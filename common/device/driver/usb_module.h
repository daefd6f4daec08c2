/// A driver module over a bus: what all of them share.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/device/driver/known_devices.h"
#include "common/device/driver/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

class UsbModule final : public DriverModule {
 public:
  /// Makes a link from options. @throws Error.
  using MakeLink = std::function<std::unique_ptr<DriverLink>(UsbTransport&, const DriverOptions&)>;

  UsbModule(std::unique_ptr<UsbTransport> transport, MakeLink make, std::string help)
      : transport_(std::move(transport)), make_(std::move(make)), help_(std::move(help)) {}

  [[nodiscard]] std::string help() const override { return help_; }
  std::unique_ptr<DriverLink> make_link(const DriverOptions& options, std::string& error) noexcept override {
    return guarded<std::unique_ptr<DriverLink>>(error, [&] { return make_(*transport_, options); });
  }
  std::vector<FoundDevice> find(std::string& error) noexcept override {
    return guarded<std::vector<FoundDevice>>(error, [&] { return find_devices(*transport_); });
  }

 private:
  /// Nothing is thrown across the border.
  template <class Result, class Work>
  static Result guarded(std::string& error, const Work& work) noexcept {
    try {
      return work();
    } catch (const std::exception& problem) {
      error = problem.what();
      return Result{};
    }
  }

  std::unique_ptr<UsbTransport> transport_;
  MakeLink make_;
  std::string help_;
};

}  // namespace palpate
