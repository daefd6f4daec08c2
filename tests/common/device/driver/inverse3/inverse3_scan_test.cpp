// The scan of Haply's messages against a parser of JSON that is not ours, and that it allocates nothing.

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "common/base/json.h"
#include "common/device/driver/inverse3/inverse3_message.h"
#include "tests/common/device/driver/inverse3/haply_emulator.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

bool scanned(const std::string& message) {
  HaplyState state;
  return read_haply_state(message, "", state);
}

TEST(HaplyScan, TakesWhatIsJsonAndNothingElse) {
  for (const char* message : {R"({"a":[1,-0.5e+3,0,2E-2,true,false,null,"x\n\u00e9\ud83d\ude00é"],"b":{}})",
                              "{ }", " {\"\":[ ]}\n", R"({"tiny":1e-999,"none":0.0000e5})"}) {
    EXPECT_TRUE(Json::accept(message)) << message;
    EXPECT_TRUE(scanned(message)) << message;
  }
  for (const char* message : {"{,}",
                              "{\"a\":1,}",
                              "{\"a\" 1}",
                              "{\"a\":[1,]}",
                              "{\"a\":[,1]}",
                              "{\"a\":[1 2]}",
                              "{\"a\":01}",
                              "{\"a\":+1}",
                              "{\"a\":.5}",
                              "{\"a\":1.}",
                              "{\"a\":1e}",
                              "{\"a\":--1}",
                              "{\"a\":tru}",
                              "{\"a\":True}",
                              "{\"a\":\"\t\"}",
                              "{\"a\":\"\\x\"}",
                              "{\"a\":\"\\u12g4\"}",
                              "{\"a\":\"\\ud800\"}",
                              "{\"a\":\"\\udc00\"}",
                              "{\"a\":\"\xc0\xaf\"}",
                              "{\"a\":\"\xed\xa0\x80\"}",
                              "{\"a\":\"\xf5\x80\x80\x80\"}",
                              "{\"a\":\"\xe2\x82\"}",
                              "{\"a\":1}}",
                              "{\"a\":1} x",
                              "{a:1}",
                              "{'a':1}",
                              "{\"a\":1e999}",
                              "{\"a\":nan}"}) {
    EXPECT_FALSE(Json::accept(message) && message != std::string("{\"a\":1e999}")) << message;
    EXPECT_FALSE(scanned(message)) << message;
  }
}

TEST(HaplyScan, AgreesOnMessagesThatAreDamagedAnywhere) {
  HaplyEmulator service;
  service.arm.put({0.01, 0.02, -0.03});
  const std::string good = service.snapshot(0.0);
  ASSERT_TRUE(scanned(good));
  std::mt19937_64 random(9);
  constexpr char kLetters[] = "{}[],:\"\\0123456789.eE+-tfnu \n\x80\xc3\xe2";
  int taken = 0;
  for (int n = 0; n < 50'000; ++n) {
    std::string message = good;
    for (std::uint64_t changes = 1 + random() % 3; changes > 0; --changes) {
      const std::size_t at = random() % message.size();
      const char letter = kLetters[random() % (sizeof(kLetters) - 1)];
      switch (random() % 3) {
        case 0:
          message[at] = letter;
          break;
        case 1:
          message.insert(at, 1, letter);
          break;
        default:
          message.erase(at, 1 + random() % 4);
      }
    }
    const bool json = Json::accept(message) && message.find_first_not_of(" \t\r\n") == message.find('{');
    ASSERT_EQ(scanned(message), json) << message;
    taken += json ? 1 : 0;
  }
  EXPECT_GT(taken, 300) << "some damage does no harm";
}

TEST(HaplyScan, AllocatesNothing) {
  HaplyEmulator service;
  const std::string message = service.snapshot(0.0);
  const std::string bad = message.substr(0, message.size() / 2);
  const AllocationGuard allocations;
  HaplyState state;
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(read_haply_state(message, "049D", state));
    ASSERT_FALSE(read_haply_state(bad, "049D", state));
  }
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
