#include "common/scene/sha256.h"

#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

// The examples of FIPS 180-4 that NIST publishes: one block, two blocks, a million letters, and nothing.
TEST(Sha256, GivesTheDigestsOfTheStandard) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// Lengths around the block of 64 bytes and the 56 that leave room for the length.
TEST(Sha256, ReadsAFileInPiecesAsOneMessage) {
  const TempFolder folder;
  for (const std::size_t length : {55U, 56U, 63U, 64U, 65U, 1'500'000U}) {
    const std::string text(length, 'x');
    EXPECT_EQ(sha256_of_file(folder.write("f", text)), sha256_of(text)) << length;
  }
  EXPECT_THROW((void)sha256_of_file(folder.path("missing")), Error);
}

}  // namespace
}  // namespace palpate::test
