// The Haply Inverse3 over real sockets: the library's WebSocket against a server that is written by hand, one
// that behaves and ones that do not.

#include <chrono>
#include <mutex>

#include <gtest/gtest.h>

#include "common/device/driver/inverse3/inverse3_link.h"
#include "common/device/driver/transport/web_transport.h"
#include "tests/common/device/driver/inverse3/haply_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/transport/web_server.h"

namespace palpate::test {
namespace {

using Manner = WebServer::Manner;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Haply's service on real sockets; what the test looks at is behind a lock.
class Service {
 public:
  explicit Service(Manner manner)
      : start_(now()), server_(manner, [this](const std::string& message) {
          const std::lock_guard lock(mutex_);
          const double t = now() - start_;
          return message.empty() ? haply_.snapshot(t) : haply_.take(t, message);
        }) {}

  [[nodiscard]] Inverse3Settings settings() const {
    Inverse3Settings settings;
    settings.service = {"127.0.0.1", server_.port()};
    settings.spelling = HaplySpelling::kVector;
    return settings;
  }
  [[nodiscard]] WebServer& server() { return server_; }
  template <class Work>
  auto with(const Work& work) {
    const std::lock_guard lock(mutex_);
    return work(haply_);
  }

 private:
  std::mutex mutex_;
  HaplyEmulator haply_;
  double start_;
  WebServer server_;
};

// RFC 6455, sec. 1.3.
TEST(WebServerOfTheTests, ProvesAHandshakeAsTheStandardDoes) {
  EXPECT_EQ(handshake_proof("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST(BeastTransport, WorksAnInverse3WholeInPiecesAndByteByByte) {
  for (const Manner manner : {Manner::kGood, Manner::kFragments, Manner::kTrickle}) {
    Service service(manner);
    const auto transport = make_beast_transport();
    Inverse3Link link(*transport, service.settings());
    const double start = now();
    while (link.status().rounds < 50 && now() < start + 20.0) (void)round_with(link, Vec3{0.0});
    ASSERT_EQ(link.status().phase, LinkPhase::kReady) << link.advice();
    Vec3 last{0.0};
    const Vec3 force{0.5, -1.0, 1.5};
    for (int n = 0; n < 1000 && glm::distance(last, force) > 1e-6; ++n) {
      (void)round_with(link, force);
      last = service.with([](const HaplyEmulator& haply) { return haply.last; });
    }
    EXPECT_NEAR(glm::distance(last, force), 0.0, 1e-6);
    EXPECT_EQ(service.with([](const HaplyEmulator& haply) { return haply.strange; }), "");
    EXPECT_FALSE(service.server().unmasked());
  }
}

// Whoever answers: no round is longer than one may be, nothing is ever ready, nothing crashes, and the place
// is tried again.
TEST(BeastTransport, ComesToNoHarmByAHostileServer) {
  for (const Manner manner :
       {Manner::kDeaf, Manner::kOtherHash, Manner::kNotFound, Manner::kEndlessHeader, Manner::kHuge,
        Manner::kLong, Manner::kMasked, Manner::kReserved, Manner::kPings, Manner::kReset}) {
    Service service(manner);
    const auto transport = make_beast_transport();
    Inverse3Link link(*transport, service.settings());
    for (int n = 0; n < 3; ++n) {
      const double began = now();
      EXPECT_FALSE(round_with(link, {1.0, 2.0, 3.0}));
      RecordProperty("round_" + std::to_string(static_cast<int>(manner)), std::to_string(now() - began));
      EXPECT_NE(link.status().phase, LinkPhase::kReady) << static_cast<int>(manner);
    }
    EXPECT_EQ(service.with([](const HaplyEmulator& haply) { return haply.understood; }), 0U);
    EXPECT_GE(service.server().clients(), 1);
  }
}

TEST(BeastTransport, FindsNobodyAtOnceWhereNobodyListens) {
  std::uint16_t port = 0;
  {
    const WebServer server(Manner::kGood, [](const std::string&) { return std::string("{}"); });
    port = server.port();
  }
  const auto transport = make_beast_transport();
  EXPECT_EQ(transport->open({"127.0.0.1", port}, 0.25).status, TransferStatus::kGone);
  EXPECT_FALSE(transport->get({"127.0.0.1", port}, "/3.0/version", 0.25).has_value());
  const WebServer server(Manner::kNotFound, [](const std::string&) { return std::string("{}"); });
  EXPECT_FALSE(transport->get({"127.0.0.1", server.port()}, "/3.0/version", 0.5).has_value());
}

}  // namespace
}  // namespace palpate::test
