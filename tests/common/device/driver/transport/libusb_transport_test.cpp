// The real transport: unmodified libusb on USB devices that umockdev shows to it, behind whose descriptors
// and ioctls emulated ones stand, and whose plugging in udev tells. The test must run with umockdev's preload
// library (CMakeLists.txt).

#include "common/device/driver/transport/libusb_transport.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include "common/device/driver/dataglove/dataglove_link.h"
#include "common/device/driver/falcon/falcon_link.h"
#include "common/device/driver/pedal/pedal_link.h"
#include "common/device/driver/polhemus/polhemus_link.h"
#include "common/device/driver/polhemus/polhemus_port.h"
#include "common/device/driver/spacemouse/spacemouse_link.h"
#include "common/servo/real_time.h"
#include "tests/common/device/driver/dataglove/dataglove_emulator.h"
#include "tests/common/device/driver/falcon/falcon_emulator.h"
#include "tests/common/device/driver/pedal/pedal_emulator.h"
#include "tests/common/device/driver/polhemus/polhemus_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/spacemouse/spacemouse_emulator.h"

namespace palpate::test {
namespace {

constexpr const char* kNode = "/dev/bus/usb/001/002";

double now() { return 1e-9 * static_cast<double>(monotonic_ns()); }

struct Described {
  const char* vendor;
  const char* product;
  const char* descriptors;
};
// Device, configuration, one interface, two bulk endpoints of 64 bytes: as an FTDI bridge describes itself.
constexpr Described kFalcon{"0403", "cb48",
                            "1201000200000040030448cb000601020301"
                            "0902200001010080320904000002ffffff020705810240000007050202400000"};
// A boot keyboard with an interrupt endpoint of 8 bytes every 10 ms.
constexpr Described kPedal{"0c45", "7403",
                           "1201100100000008450c0374000101020001"
                           "0902190001010080320904000001030101000705810308000a"};
// A Liberty: bulk endpoints 4 and 8, of a maker's own class.
constexpr Described kLiberty{"0f44", "ff20",
                             "1201000200000040440f20ff000101020001"
                             "0902200001010080320904000002ffffff000705040240000007058802400000"};
// A Fastrak: answers by bulk endpoint 2, what it says by itself by an interrupt endpoint.
constexpr Described kFastrak{
    "0f44", "0002",
    "1201000200000040440f0200000101020001"
    "0902270001010080320904000003ffffff00070502024000000705820240000007058403400001"};
// A SpaceNavigator: a HID device with an interrupt endpoint of 8 bytes.
constexpr Described kSpaceMouse{"046d", "c626",
                                "12010002000000086d0426c6000101020001"
                                "0902190001010080320904000001030000000705830308000a"};
// A glove of five sensors: a HID device with an interrupt endpoint of 64 bytes.
constexpr Described kGlove{"5d70", "0010",
                           "1201100100000008705d1000000101020001"
                           "0902190001010080320904000001030000000705850340000a"};

/// Answers the ioctls of usbfs for one device, on umockdev's thread.
class UsbfsDevice {
 public:
  UsbfsDevice(FakeDevice& device, const Described& described, bool plugged = true)
      : device_(device), described_(described) {
    testbed_ = umockdev_testbed_new();
    if (plugged) plug();
  }
  ~UsbfsDevice() {
    if (handler_ != nullptr) {
      umockdev_testbed_detach_ioctl(testbed_, kNode, nullptr);
      g_object_unref(handler_);
    }
    g_object_unref(testbed_);
  }

  void plug() {
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&UsbfsDevice::answer), this);
    GError* error = nullptr;
    umockdev_testbed_attach_ioctl(testbed_, kNode, handler_, &error);
    EXPECT_EQ(error, nullptr);
    const std::string record = std::string("P: /devices/pci0000:00/usb1/1-2\nN: bus/usb/001/002\n") +
                               "E: BUSNUM=001\nE: DEVNUM=002\nE: DEVNAME=" + kNode +
                               "\nE: DEVTYPE=usb_device\nE: MAJOR=189\nE: MINOR=1\nE: SUBSYSTEM=usb\n"
                               "A: busnum=1\\n\nA: devnum=2\\n\nA: bConfigurationValue=1\\n\nA: speed=12\\n\n"
                               "A: idVendor=" +
                               described_.vendor + "\\n\nA: idProduct=" + described_.product +
                               "\\n\nH: descriptors=" + described_.descriptors + "\n";
    umockdev_testbed_add_from_string(testbed_, record.c_str(), &error);
    EXPECT_EQ(error, nullptr) << (error != nullptr ? error->message : "");
  }
  void unplug() {
    {
      const std::lock_guard lock(mutex_);
      gone_ = true;
    }
    umockdev_testbed_uevent(testbed_, "/sys/devices/pci0000:00/usb1/1-2", "remove");
    umockdev_testbed_remove_device(testbed_, "/sys/devices/pci0000:00/usb1/1-2");
  }
  void stall(bool on) {
    const std::lock_guard lock(mutex_);
    stalls_ = on;
  }
  [[nodiscard]] int claims() const {
    const std::lock_guard lock(mutex_);
    return claims_;
  }

 private:
  /// Time of the emulated device begins with this.
  [[nodiscard]] double local() const { return now() - start_; }

  struct Urb {
    UMockdevIoctlData* data = nullptr;
    UMockdevIoctlData* buffer = nullptr;
    std::uintptr_t address = 0;  ///< in the program that submitted it
  };

  static gboolean answer(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
    return static_cast<UsbfsDevice*>(self)->take(client) ? TRUE : FALSE;
  }

  bool take(UMockdevIoctlClient* client) {
    const std::lock_guard lock(mutex_);
    const gulong request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto done = [&](int result, int error) { umockdev_ioctl_client_complete(client, result, error); };
    if (gone_) {
      done(-1, ENODEV);
      return true;
    }
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES: {
        std::uint32_t none = 0;
        UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, sizeof(none), nullptr);
        umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(&none), sizeof(none));
        g_object_unref(data);
        done(0, 0);
        return true;
      }
      case USBDEVFS_GETDRIVER:
        done(-1, ENODATA);
        return true;
      case USBDEVFS_CLAIMINTERFACE:
      case USBDEVFS_DISCONNECT_CLAIM:
        ++claims_;
        done(0, 0);
        return true;
      case USBDEVFS_RELEASEINTERFACE:
        --claims_;
        done(0, 0);
        return true;
      case USBDEVFS_CLEAR_HALT:
      case USBDEVFS_IOCTL:
        done(0, 0);
        return true;
      case USBDEVFS_SUBMITURB:
        submit(argument);
        done(0, 0);
        return true;
      case USBDEVFS_DISCARDURB: {
        std::uintptr_t address = 0;
        std::memcpy(&address, argument->data, sizeof(address));
        for (auto urb = waiting_.begin(); urb != waiting_.end(); ++urb) {
          if (urb->address != address) continue;
          finish(*urb, -ENOENT, 0);
          waiting_.erase(urb);
          done(0, 0);
          return true;
        }
        done(-1, EINVAL);
        return true;
      }
      case USBDEVFS_REAPURB:
      case USBDEVFS_REAPURBNDELAY:
        reap(argument, done);
        return true;
      default:
        done(-1, ENOTTY);
        return true;
    }
  }

  void submit(UMockdevIoctlData* argument) {
    Urb urb;
    std::memcpy(&urb.address, argument->data, sizeof(urb.address));
    urb.data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    const usbdevfs_urb& asked = *reinterpret_cast<usbdevfs_urb*>(urb.data->data);
    if (asked.buffer_length > 0) {
      urb.buffer = umockdev_ioctl_data_resolve(urb.data, offsetof(usbdevfs_urb, buffer),
                                               static_cast<gsize>(asked.buffer_length), nullptr);
    }
    const auto length = static_cast<std::size_t>(asked.buffer_length);
    if (stalls_) return finish(urb, -EPIPE, 0);
    if (asked.type == USBDEVFS_URB_TYPE_CONTROL) {
      const guint8* const setup = urb.buffer->data;
      const auto word = [&](int at) { return static_cast<std::uint16_t>(setup[at] | (setup[at + 1] << 8)); };
      const UsbControl asking{
          .request_type = setup[0], .request = setup[1], .value = word(2), .index = word(4)};
      if ((setup[0] & 0x80U) != 0) {
        std::vector<std::uint8_t> said(length - 8);
        const std::size_t bytes = device_.answer(local(), asking, said);
        if (bytes == 0) return finish(urb, -EPIPE, 0);
        umockdev_ioctl_data_update(urb.buffer, 8, said.data(), static_cast<gint>(bytes));
        return finish(urb, 0, static_cast<int>(bytes));
      }
      const TransferStatus status =
          device_.control(local(), asking, std::span<const std::uint8_t>(setup + 8, length - 8));
      return finish(urb, status == TransferStatus::kOk ? 0 : -EPIPE, static_cast<int>(length - 8));
    }
    if ((asked.endpoint & 0x80U) == 0) {
      device_.write(local(), asked.endpoint, {urb.buffer->data, length});
      return finish(urb, 0, asked.buffer_length);
    }
    waiting_.push_back(urb);
  }

  /// Reads end when the device has something to say.
  void serve_reads() {
    while (!waiting_.empty()) {
      const usbdevfs_urb& asked = *reinterpret_cast<usbdevfs_urb*>(waiting_.front().data->data);
      std::vector<std::uint8_t> said(static_cast<std::size_t>(asked.buffer_length));
      const std::size_t bytes = device_.read(local(), asked.endpoint, said);
      if (bytes == 0) return;
      umockdev_ioctl_data_update(waiting_.front().buffer, 0, said.data(), static_cast<gint>(bytes));
      finish(waiting_.front(), 0, static_cast<int>(bytes));
      waiting_.pop_front();
    }
  }

  void finish(const Urb& urb, int status, int bytes) {
    const auto set = [&](std::size_t offset, int value) {
      umockdev_ioctl_data_update(urb.data, offset, reinterpret_cast<guint8*>(&value), sizeof(value));
    };
    set(offsetof(usbdevfs_urb, status), status);
    set(offsetof(usbdevfs_urb, actual_length), bytes);
    finished_.push_back(urb);
  }

  template <class Done>
  void reap(UMockdevIoctlData* argument, const Done& done) {
    serve_reads();
    if (finished_.empty()) return done(-1, EAGAIN);
    const Urb urb = finished_.front();
    finished_.pop_front();
    UMockdevIoctlData* const pointer = umockdev_ioctl_data_resolve(argument, 0, sizeof(void*), nullptr);
    umockdev_ioctl_data_set_ptr(pointer, 0, urb.data);
    done(0, 0);
    g_object_unref(pointer);
    if (urb.buffer != nullptr) g_object_unref(urb.buffer);
    g_object_unref(urb.data);
  }

  FakeDevice& device_;
  Described described_;
  const double start_ = now();
  UMockdevTestbed* testbed_ = nullptr;
  UMockdevIoctlBase* handler_ = nullptr;
  mutable std::mutex mutex_;
  std::deque<Urb> waiting_, finished_;
  bool gone_ = false, stalls_ = false;
  int claims_ = 0;
};

class LibusbTransport : public ::testing::Test {
 protected:
  void SetUp() override {
    usbfs_ = std::make_unique<UsbfsDevice>(falcon_, kFalcon);
    ASSERT_EQ(::access("/sys/devices/pci0000:00/usb1/1-2", F_OK), 0)
        << "run with LD_PRELOAD=libumockdev-preload.so.0";
    std::string error;
    bus_ = make_libusb_transport(error);
    ASSERT_TRUE(bus_) << error;
  }

  FalconEmulator falcon_{{.loaded = true, .homed = true}};
  std::unique_ptr<UsbfsDevice> usbfs_;
  std::unique_ptr<UsbTransport> bus_;
};

TEST_F(LibusbTransport, FindsTheDeviceWithItsEndpoints) {
  const auto devices = bus_->devices();
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_EQ(devices[0].id, kFalconId);
  EXPECT_EQ(devices[0].path, "1-2");
  ASSERT_EQ(devices[0].endpoints.size(), 2U);
  EXPECT_EQ(devices[0].endpoints[0].address, 0x81);
  EXPECT_TRUE(devices[0].endpoints[0].in());
  EXPECT_EQ(devices[0].endpoints[1].packet, 64);
  EXPECT_FALSE(devices[0].endpoints[1].interrupt);
  EXPECT_EQ(bus_->access("1-2"), TransferStatus::kOk);
  EXPECT_EQ(bus_->access("9-9"), TransferStatus::kGone);
  EXPECT_EQ(bus_->open("9-9", 0).status, TransferStatus::kGone);
}

TEST_F(LibusbTransport, MovesDataBothWaysAndSaysWhatWentWrong) {
  constexpr UsbEndpoint kOut{.address = 0x02, .packet = 64}, kIn{.address = 0x81, .packet = 64};
  UsbOpened opened = bus_->open("1-2", 0);
  ASSERT_EQ(opened.status, TransferStatus::kOk);
  EXPECT_EQ(usbfs_->claims(), 1);
  UsbConnection& falcon = *opened.connection;
  EXPECT_TRUE(falcon.control({.request_type = 0x40, .request = 0x09, .value = 1}, {}, 1.0).ok());
  EXPECT_TRUE(falcon.control({.request_type = 0x40, .request = 0x03, .value = 2}, {}, 1.0).ok());
  EXPECT_EQ(falcon.control({.request_type = 0x40, .request = 0x77}, {}, 1.0).status, TransferStatus::kStall);
  const FalconPacket packet = encode({});
  const TransferResult sent = falcon.write(kOut, packet, 1.0);
  EXPECT_TRUE(sent.ok());
  EXPECT_EQ(sent.bytes, packet.size());
  std::array<std::uint8_t, 64> data{};
  std::size_t bytes = 0;
  for (int n = 0; n < 100 && bytes <= 2; ++n) {
    const TransferResult got = falcon.read(kIn, data, 1.0);
    ASSERT_TRUE(got.ok());
    bytes = got.bytes;
  }
  EXPECT_EQ(bytes, 18U);  // status and an answer
  EXPECT_EQ(data[2], '<');

  // Nothing comes at the longest latency within a millisecond.
  EXPECT_TRUE(falcon.control({.request_type = 0x40, .request = 0x09, .value = 255}, {}, 1.0).ok());
  EXPECT_EQ(falcon.read(kIn, data, 0.001).status, TransferStatus::kTimeout);
  usbfs_->stall(true);
  EXPECT_EQ(falcon.write(kOut, packet, 1.0).status, TransferStatus::kStall);
  usbfs_->stall(false);
  EXPECT_TRUE(falcon.write(kOut, packet, 1.0).ok());
  opened.connection.reset();
  EXPECT_EQ(usbfs_->claims(), 0);
}

TEST_F(LibusbTransport, CarriesTheFalconFromOpeningToForcesAndUnplugging) {
  FalconLink link(*bus_, {});
  for (const double until = now() + 20.0; now() < until && link.status().phase != LinkPhase::kReady;) {
    (void)round_with(link, Vec3{0.0});
  }
  ASSERT_EQ(link.status().phase, LinkPhase::kReady) << link.advice();
  for (int n = 0; n < 100; ++n) (void)round_with(link, {0.0, 0.0, 1.0});
  EXPECT_GT(falcon_.largest_motor(), 0);
  usbfs_->unplug();
  for (int n = 0; n < 20 && link.status().phase == LinkPhase::kReady; ++n)
    (void)round_with(link, {0.0, 0.0, 1.0});
  EXPECT_EQ(link.status().phase, LinkPhase::kAbsent);
}

// A pedal that is held speaks up by itself every 8 ms, or is asked: either way over real libusb.
TEST(LibusbPedal, IsHeardWhileItIsHeldAndReleasedWhenItIsPulledOut) {
  for (const bool repeats : {true, false}) {
    PedalEmulator pedal({.repeats = repeats});
    UsbfsDevice usbfs(pedal, kPedal);
    std::string error;
    const std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
    ASSERT_TRUE(bus) << error;
    PedalLink link(*bus);
    const auto until_down = [&](std::uint32_t buttons) {
      for (const double until = now() + 20.0; now() < until && link.atoms().buttons != buttons;) {
        (void)round_with(link, Vec3{0.0});
      }
      return link.atoms().buttons == buttons;
    };
    for (int n = 0; n < 20; ++n) (void)round_with(link, Vec3{0.0});
    EXPECT_EQ(link.status().phase, LinkPhase::kReady) << link.advice();
    pedal.press(0b001);
    EXPECT_TRUE(until_down(0b001));
    const std::uint64_t before = link.status().rounds;
    for (int n = 0; n < 20; ++n) (void)round_with(link, Vec3{0.0});
    EXPECT_GE(link.status().rounds, before + 10);
    if (!repeats) {
      EXPECT_GT(pedal.asked(), 0);
    }
    usbfs.unplug();
    EXPECT_TRUE(until_down(0));
    for (int n = 0; n < 5 && link.status().phase != LinkPhase::kAbsent; ++n)
      (void)round_with(link, Vec3{0.0});
    EXPECT_EQ(link.status().phase, LinkPhase::kAbsent);
  }
}

/// Rounds of a link until something holds; false where it does not for long.
template <class Holds>
bool work_until(DriverLink& link, const Holds& holds) {
  for (const double until = now() + 20.0; !holds();) {
    if (now() > until) return false;
    (void)round_with(link, Vec3{0.0});
  }
  return true;
}

// Both families: silenced, set up and followed, its button, and its end.
TEST(LibusbPolhemus, IsSetUpFollowedAndLostWhenItIsPulledOut) {
  for (const bool fastrak : {false, true}) {
    const auto tracker = std::make_shared<PolhemusEmulator>(EmulatedPolhemus{.fastrak = fastrak});
    tracker->freeze(true);
    PolhemusOnUsb wire(fastrak ? UsbId{0x0f44, 0x0002} : UsbId{0x0f44, 0xff20}, tracker);
    UsbfsDevice usbfs(wire, fastrak ? kFastrak : kLiberty);
    std::string error;
    const std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
    ASSERT_TRUE(bus) << error;
    PolhemusLink link(polhemus_on_usb(*bus), {});
    const auto& stations = link.poses()->stations;
    ASSERT_TRUE(work_until(link, [&] { return stations[0].valid && stations[1].valid; })) << link.advice();
    EXPECT_EQ(link.status().phase, LinkPhase::kReady);
    EXPECT_EQ(link.place(), "usb 1-2");
    EXPECT_EQ(usbfs.claims(), 1);
    constexpr double kSinglePrecision = 1e-6;  // [m]
    EXPECT_LT(glm::distance(stations[1].position, PolhemusEmulator::position(2, 0.0)), kSinglePrecision);
    tracker->press(1, true);
    EXPECT_TRUE(work_until(link, [&] { return stations[0].buttons == 1U; }));
    usbfs.unplug();
    EXPECT_TRUE(work_until(link, [&] { return link.status().phase == LinkPhase::kAbsent; }));
    EXPECT_FALSE(stations[0].valid || stations[1].valid);
    EXPECT_EQ(stations[0].buttons, 0U);
  }
}

// In packets no longer than its endpoint's, and its light by a request of its class.
TEST(LibusbSpaceMouse, FollowsTheCapAndRestsWhenItIsPulledOut) {
  SpaceMouseEmulator mouse;
  UsbfsDevice usbfs(mouse, kSpaceMouse);
  std::string error;
  const std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
  ASSERT_TRUE(bus) << error;
  SpaceMouseLink link(*bus, {});
  using Axes = std::array<double, 6>;
  mouse.deflect({175, -350, 70, 35, 0, 0});
  ASSERT_TRUE(work_until(link, [&] {
    return link.atoms().valuators == Axes{0.5, -0.2, -1.0, 0.1, 0.0, 0.0};
  })) << link.advice();
  EXPECT_EQ(mouse.light(), 1);
  EXPECT_EQ(mouse.bad_controls(), 0);
  mouse.press(0x1);
  EXPECT_TRUE(work_until(link, [&] { return link.atoms().buttons == 1U; }));
  usbfs.unplug();
  EXPECT_TRUE(work_until(link, [&] { return link.status().phase == LinkPhase::kAbsent; }));
  EXPECT_EQ(link.atoms().valuators, Axes{});
  EXPECT_EQ(link.atoms().buttons, 0U);
}

TEST(LibusbDataGlove, BendsItsFingersAndOpensWhenItIsPulledOut) {
  DataGloveEmulator glove({0x5d70, 0x0010});
  UsbfsDevice usbfs(glove, kGlove);
  std::string error;
  const std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
  ASSERT_TRUE(bus) << error;
  DataGloveLink link(*bus);
  const auto reports = [&](std::uint64_t more) {
    const std::uint64_t before = link.status().rounds;
    return work_until(link, [&] { return link.status().rounds >= before + more; });
  };
  // A fist and a flat hand teach the ranges.
  glove.bend_all(1.0);
  ASSERT_TRUE(reports(4)) << link.advice();
  glove.bend_all(0.0);
  ASSERT_TRUE(reports(4));
  glove.bend(3, 0.75);
  EXPECT_TRUE(work_until(link, [&] { return link.atoms().buttons == 0b10U; }));
  EXPECT_EQ(link.atoms().bend_count, 5);
  EXPECT_NEAR(link.atoms().bends[1], 0.75, 1e-3);
  usbfs.unplug();
  EXPECT_TRUE(work_until(link, [&] { return link.atoms().buttons == 0U; }));
  EXPECT_EQ(link.atoms().bend_count, 0);
}

// libusb hears of arrivals from udev by its own callback: whoever waits for one is woken by it, long before
// its time is over, and not by what leaves.
TEST(LibusbHotplug, WakesWhoeverWaitsForAnArrival) {
  FalconEmulator falcon({.loaded = true, .homed = true});
  UsbfsDevice usbfs(falcon, kFalcon, false);
  std::string error;
  const std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
  ASSERT_TRUE(bus) << error;
  EXPECT_TRUE(bus->devices().empty());
  constexpr double kShort = 0.3, kLong = 30.0;  // [s]
  double began = now();
  bus->await_arrival(kShort);
  EXPECT_GE(now() - began, kShort) << "nothing has come";

  std::jthread hand([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    usbfs.plug();
  });
  began = now();
  bus->await_arrival(kLong);
  EXPECT_LT(now() - began, 0.5 * kLong) << "it was not told";
  hand.join();
  ASSERT_EQ(bus->devices().size(), 1U);
  EXPECT_EQ(bus->devices()[0].id, kFalconId);
  EXPECT_EQ(bus->open("1-2", 0).status, TransferStatus::kOk);
  usbfs.unplug();
  began = now();
  bus->await_arrival(kShort);
  EXPECT_GE(now() - began, kShort) << "what leaves is no arrival";
}

}  // namespace
}  // namespace palpate::test
