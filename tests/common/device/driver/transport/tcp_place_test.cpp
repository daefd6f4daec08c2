// Streams over TCP on this machine: a VRPN server in real time, and places where there is none.

#include "common/device/driver/transport/tcp_place.h"

#include <array>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "common/device/driver/vrpn/vrpn_link.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/vrpn/vrpn_server.h"

namespace palpate::test {
namespace {

TEST(TcpPlace, CarriesAVrpnLinkBothWays) {
  VrpnServer server;
  auto to = std::make_unique<TcpPlace>("localhost", server.port());
  const TcpPlace& place = *to;
  VrpnLink link(std::move(to), vrpn_settings({{"at", "Phantom0@localhost"}, {"cap", "3"}}));
  const double start = place.now();
  constexpr double kPatience = 20.0;  // [s]
  while (link.status().rounds < 100 && place.now() < start + kPatience) (void)round_with(link, Vec3{0.0});
  ASSERT_EQ(link.status().phase, LinkPhase::kReady) << link.advice();
  while (server.with([](VrpnEmulator& vrpn) { return vrpn.fields; }) < 20 &&
         place.now() < start + kPatience) {
    (void)round_with(link, {0.5, -1.0, 1.5});
  }
  EXPECT_GE(server.with([](VrpnEmulator& vrpn) { return vrpn.fields; }), 20U);
  EXPECT_LE(server.with([](VrpnEmulator& vrpn) { return vrpn.largest_field; }), 3.003);
  EXPECT_TRUE(server.with([](VrpnEmulator& vrpn) { return vrpn.strange.empty(); }));
}

TEST(TcpPlace, FindsNobodyWhereNobodyListens) {
  std::uint16_t port = 0;
  { port = VrpnServer().port(); }
  TcpPlace none("127.0.0.1", port);
  EXPECT_EQ(none.open().status, TransferStatus::kGone);
  TcpPlace nowhere("no-such-host.invalid", 3883);
  EXPECT_EQ(nowhere.open().status, TransferStatus::kGone);
  EXPECT_EQ(TcpPlace("fe80::1", 4000).name(), "[fe80::1]:4000");
}

TEST(TcpPlace, WaitsNoLongerThanItIsGivenAndSaysThatTheOtherSideHasGone) {
  auto server = std::make_unique<VrpnServer>();
  server->stall(true);
  server->with([](VrpnEmulator& vrpn) { vrpn.silent = true; });
  TcpPlace place("127.0.0.1", server->port());
  const StreamOpened opened = place.open();
  ASSERT_TRUE(opened.stream);
  std::array<std::uint8_t, 65536> bytes{};
  TransferResult got;
  do {
    got = opened.stream->read(bytes, 0.05);
  } while (got.ok());
  EXPECT_EQ(got.status, TransferStatus::kTimeout);
  // Whoever does not read is full at last: some MB of the system's.
  std::size_t sent = 0;
  TransferResult written;
  do {
    written = opened.stream->write(bytes, 0.05);
    sent += written.bytes;
  } while (written.ok() && sent < 100'000'000);
  EXPECT_EQ(written.status, TransferStatus::kTimeout);
  server.reset();
  do {
    got = opened.stream->read(bytes, 0.05);
  } while (got.ok());
  EXPECT_EQ(got.status, TransferStatus::kGone);
  EXPECT_EQ(opened.stream->write(bytes, 0.05).status, TransferStatus::kGone)
      << "and no signal ends the program";
}

}  // namespace
}  // namespace palpate::test
