#include "common/device/driver/transport/libusb_transport.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <libusb-1.0/libusb.h>
#include <sys/time.h>

#include "common/base/index.h"
#include "common/device/driver/transport/guardian.h"

namespace palpate {
namespace {

struct EndContext {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
};
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
};
struct FreeConfiguration {
  void operator()(libusb_config_descriptor* configuration) const noexcept {
    libusb_free_config_descriptor(configuration);
  }
};
using Handle = std::unique_ptr<libusb_device_handle, CloseHandle>;
using Context = std::shared_ptr<libusb_context>;

TransferStatus status_of(int code) noexcept {
  switch (code) {
    case LIBUSB_SUCCESS:
      return TransferStatus::kOk;
    case LIBUSB_ERROR_TIMEOUT:
      return TransferStatus::kTimeout;
    case LIBUSB_ERROR_PIPE:
    case LIBUSB_ERROR_OVERFLOW:
      return TransferStatus::kStall;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return TransferStatus::kGone;
    case LIBUSB_ERROR_ACCESS:
      return TransferStatus::kDenied;
    case LIBUSB_ERROR_BUSY:
      return TransferStatus::kBusy;
    default:
      return TransferStatus::kFailed;
  }
}

/// At least one: zero would mean no limit at all.
unsigned milliseconds(double seconds) noexcept {
  return static_cast<unsigned>(std::clamp(std::ceil(1e3 * seconds), 1.0, 60'000.0));
}

/// Bus and the ports on the way, as the kernel names them: "1-2.3".
std::string path_of(libusb_device* device) {
  constexpr int kMostPorts = 7;
  std::uint8_t ports[kMostPorts];
  const int count = libusb_get_port_numbers(device, ports, kMostPorts);
  std::string path = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) path += (i == 0 ? "-" : ".") + std::to_string(ports[i]);
  return path;
}

std::vector<UsbEndpoint> endpoints_of(libusb_device* device) {
  std::vector<UsbEndpoint> endpoints;
  libusb_config_descriptor* raw = nullptr;
  if (libusb_get_active_config_descriptor(device, &raw) != LIBUSB_SUCCESS) return endpoints;
  const std::unique_ptr<libusb_config_descriptor, FreeConfiguration> configuration(raw);
  for (int i = 0; i < configuration->bNumInterfaces; ++i) {
    const libusb_interface& interface = configuration->interface[i];
    if (interface.num_altsetting < 1) continue;
    const libusb_interface_descriptor& setting = interface.altsetting[0];
    for (int e = 0; e < setting.bNumEndpoints; ++e) {
      const libusb_endpoint_descriptor& endpoint = setting.endpoint[e];
      const unsigned kind = endpoint.bmAttributes & 3U;
      if (kind != LIBUSB_TRANSFER_TYPE_BULK && kind != LIBUSB_TRANSFER_TYPE_INTERRUPT) continue;
      endpoints.push_back({.interface = setting.bInterfaceNumber,
                           .address = endpoint.bEndpointAddress,
                           .packet = static_cast<std::uint16_t>(endpoint.wMaxPacketSize & 0x7FFU),
                           .interrupt = kind == LIBUSB_TRANSFER_TYPE_INTERRUPT});
    }
  }
  return endpoints;
}

class LibusbConnection final : public UsbConnection {
 public:
  /// @pre `interface` of `handle` is claimed.
  LibusbConnection(Context context, Handle handle, int interface)
      : context_(std::move(context)), handle_(std::move(handle)), interface_(interface) {}
  ~LibusbConnection() override {
    guardian_ = {};  // while the interface is not free yet
    libusb_release_interface(handle_.get(), interface_);
  }

  TransferResult control(const UsbControl& setup, std::span<const std::uint8_t> data,
                         double seconds) noexcept override {
    // libusb does not write to what it sends.
    return transfer_control(setup, const_cast<std::uint8_t*>(data.data()), data.size(), seconds);
  }

  TransferResult ask(const UsbControl& setup, std::span<std::uint8_t> data,
                     double seconds) noexcept override {
    return transfer_control(setup, data.data(), data.size(), seconds);
  }

  TransferResult write(const UsbEndpoint& endpoint, std::span<const std::uint8_t> data,
                       double seconds) noexcept override {
    return transfer(endpoint, const_cast<std::uint8_t*>(data.data()), data.size(), seconds);
  }

  TransferResult read(const UsbEndpoint& endpoint, std::span<std::uint8_t> data,
                      double seconds) noexcept override {
    return transfer(endpoint, data.data(), data.size(), seconds);
  }

  bool leave_last_word(const UsbEndpoint& endpoint, std::span<const std::uint8_t> word) override {
    constexpr int kTimes = 3;
    libusb_device* const device = libusb_get_device(handle_.get());
    const auto three = [](int number) {
      const std::string digits = std::to_string(number);
      return std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
    };
    const std::string node = "/dev/bus/usb/" + three(libusb_get_bus_number(device)) + "/" +
                             three(libusb_get_device_address(device));
    guardian_ =
        Guardian({"usb", node, std::to_string(interface_), std::to_string(endpoint.address)}, word, kTimes);
    return guardian_.watches();
  }

 private:
  TransferResult transfer_control(const UsbControl& setup, std::uint8_t* data, std::size_t bytes,
                                  double seconds) noexcept {
    const int done =
        libusb_control_transfer(handle_.get(), setup.request_type, setup.request, setup.value, setup.index,
                                data, static_cast<std::uint16_t>(bytes), milliseconds(seconds));
    if (done < 0) return {status_of(done), 0};
    return {TransferStatus::kOk, as_size(done)};
  }

  TransferResult transfer(const UsbEndpoint& endpoint, std::uint8_t* data, std::size_t bytes,
                          double seconds) noexcept {
    int done = 0;
    auto* const move = endpoint.interrupt ? libusb_interrupt_transfer : libusb_bulk_transfer;
    const int code =
        move(handle_.get(), endpoint.address, data, static_cast<int>(bytes), &done, milliseconds(seconds));
    if (code == LIBUSB_ERROR_PIPE) libusb_clear_halt(handle_.get(), endpoint.address);
    return {status_of(code), as_size(std::max(done, 0))};
  }

  Context context_;
  Handle handle_;
  int interface_;
  Guardian guardian_;
};

class LibusbTransport final : public UsbTransport {
 public:
  explicit LibusbTransport(Context context) : context_(std::move(context)) {
    if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return;
    tells_arrivals_ = libusb_hotplug_register_callback(context_.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED, 0,
                                                       LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
                                                       LIBUSB_HOTPLUG_MATCH_ANY, &LibusbTransport::arrived,
                                                       this, &callback_) == LIBUSB_SUCCESS;
  }
  ~LibusbTransport() override {
    if (tells_arrivals_) libusb_hotplug_deregister_callback(context_.get(), callback_);
  }

  std::vector<UsbDevice> devices() override {
    std::vector<UsbDevice> all;
    each([&](libusb_device* device) {
      libusb_device_descriptor description{};
      if (libusb_get_device_descriptor(device, &description) != LIBUSB_SUCCESS) return true;
      all.push_back({.id = {description.idVendor, description.idProduct},
                     .path = path_of(device),
                     .endpoints = endpoints_of(device)});
      return true;
    });
    return all;
  }

  UsbOpened open(const std::string& path, int interface) override {
    UsbOpened opened{.status = TransferStatus::kGone};
    Handle handle = handle_at(path, opened.status);
    if (!handle) return opened;
    // Where the system has no driver to be detached this says so, which is no fault.
    libusb_set_auto_detach_kernel_driver(handle.get(), 1);
    opened.status = status_of(libusb_claim_interface(handle.get(), interface));
    if (opened.status == TransferStatus::kOk) {
      opened.connection = std::make_unique<LibusbConnection>(context_, std::move(handle), interface);
    }
    return opened;
  }

  TransferStatus access(const std::string& path) override {
    TransferStatus status = TransferStatus::kGone;
    (void)handle_at(path, status);
    return status;
  }

  [[nodiscard]] double now() const noexcept override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  void sleep(double seconds) noexcept override {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }

  void await_arrival(double seconds) noexcept override {
    if (!tells_arrivals_) return UsbTransport::await_arrival(seconds);
    const std::uint64_t before = arrivals_.load();
    for (const double until = now() + seconds; arrivals_.load() == before;) {
      const double left = until - now();
      if (left <= 0.0) return;
      timeval wait{.tv_sec = 0, .tv_usec = static_cast<suseconds_t>(std::min(1e6 * left, 999'999.0))};
      // Where events cannot be waited for, time still passes.
      if (libusb_handle_events_timeout_completed(context_.get(), &wait, nullptr) != LIBUSB_SUCCESS)
        return UsbTransport::await_arrival(left);
    }
  }

 private:
  /// Calls `use` with each device until it returns false.
  template <class Use>
  void each(const Use& use) {
    libusb_device** list = nullptr;
    const ssize_t count = libusb_get_device_list(context_.get(), &list);
    for (ssize_t i = 0; i < count; ++i) {
      if (!use(list[i])) break;
    }
    if (count >= 0) libusb_free_device_list(list, 1);
  }

  Handle handle_at(const std::string& path, TransferStatus& status) {
    Handle handle;
    each([&](libusb_device* device) {
      if (path_of(device) != path) return true;
      libusb_device_handle* raw = nullptr;
      status = status_of(libusb_open(device, &raw));
      handle.reset(raw);
      return false;
    });
    return handle;
  }

  /// On whatever thread waits for events.
  static int LIBUSB_CALL arrived(libusb_context* /*context*/, libusb_device* /*device*/,
                                 libusb_hotplug_event /*event*/, void* self) {
    static_cast<LibusbTransport*>(self)->arrivals_.fetch_add(1);
    return 0;
  }

  Context context_;
  std::atomic<std::uint64_t> arrivals_{0};
  libusb_hotplug_callback_handle callback_ = 0;
  bool tells_arrivals_ = false;
};

}  // namespace

std::unique_ptr<UsbTransport> make_libusb_transport(std::string& error) {
  libusb_context* raw = nullptr;
  const int code = libusb_init(&raw);
  if (code != LIBUSB_SUCCESS) {
    error = std::string("libusb cannot start: ") + libusb_strerror(static_cast<libusb_error>(code));
    return nullptr;
  }
  return std::make_unique<LibusbTransport>(Context(raw, EndContext{}));
}

}  // namespace palpate
