// What a reader did not write is found, wherever it stops; packed bytes are what they unpack to.
#include "common/load/voxel_bytes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/gzip_head.h"

namespace palpate {
namespace {

TEST(VoxelMemory, AReaderThatStopsEarlyIsFoundAtEveryPlace) {
  for (const std::size_t size : {std::size_t{4}, std::size_t{8}, std::size_t{84}, std::size_t{1000}}) {
    for (std::size_t stop = 0; stop <= size; stop += 4) {
      VoxelMemory memory(size);
      std::fill_n(memory.bytes().begin(), stop, std::byte{0});
      EXPECT_EQ(written_bytes(memory.bytes()), stop / 8 * 8 == stop || stop == size ? stop : stop / 8 * 8 + 8)
          << size << " " << stop;
      if (stop == size) {
        const DataArray array = std::move(memory).finish("a", ScalarType::kInt16, 2);
        EXPECT_EQ(array.tuples, size / 4);
        continue;
      }
      if (size - stop <= 4 && size % 8 == 0) continue;  // half a word: the rest of it counts as written
      try {
        (void)std::move(memory).finish("voxels.raw", ScalarType::kInt16, 2);
        ADD_FAILURE() << size << " " << stop;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput);
        EXPECT_NE(std::string(error.what()).find("voxels.raw: voxels: only"), std::string::npos)
            << error.what();
      }
    }
  }
}

// Holes in the middle, as of a slice that a decoder left out.
TEST(VoxelMemory, AHoleIsFound) {
  VoxelMemory memory(4096);
  const auto bytes = memory.bytes();
  std::fill(bytes.begin(), bytes.begin() + 1024, std::byte{7});
  std::fill(bytes.begin() + 1040, bytes.end(), std::byte{7});
  EXPECT_EQ(written_bytes(bytes), 1024U);
}

TEST(VoxelMemory, CountsOfEachKindAreHeldAgainstTheHeader) {
  const auto said = [](const VoxelCounts& counts) -> std::string {
    try {
      check_voxel_counts("a.raw", counts);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(said({.wanted = 8, .found = 8, .unpacked = 9, .written = 8}), "");
  EXPECT_NE(said({.wanted = 8, .found = 7}).find("has 7 bytes"), std::string::npos);
  EXPECT_NE(said({.wanted = 8, .unpacked = 7}).find("only 7 bytes of voxels can be unpacked"),
            std::string::npos);
  EXPECT_NE(said({.wanted = 8, .written = 7}).find("only 7 bytes of voxels could be read"),
            std::string::npos);
}

std::string packed(const std::string& content, int wrapper) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + wrapper, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(content.size() + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

TEST(Unpack, SaysWhatWasThereAndWhetherThatWasAll) {
  std::string content;
  for (int i = 0; i < 3000; ++i) content += static_cast<char>(i * i >> 3);
  for (const int wrapper : {0, 16}) {  // zlib's and gzip's
    const std::string all = packed(content, wrapper);
    const auto into = [](const std::string& data, std::size_t room, std::string& out) {
      out.assign(room, '\0');
      return unpack(data, std::as_writable_bytes(std::span(out)));
    };
    std::string out;
    Unpacked got = into(all, content.size(), out);
    EXPECT_EQ(out, content);
    EXPECT_TRUE(got.bytes == content.size() && got.ended && !got.more);
    got = into(all, 100, out);
    EXPECT_EQ(out, content.substr(0, 100));
    EXPECT_TRUE(got.bytes == 100 && !got.ended && got.more);
    got = into(all, content.size() + 9, out);
    EXPECT_TRUE(got.bytes == content.size() && got.ended && !got.more);
    for (std::size_t cut = 0; cut < all.size(); cut += 7) {
      got = into(all.substr(0, cut), content.size(), out);
      EXPECT_TRUE(!got.ended && got.bytes <= content.size()) << cut;
      EXPECT_EQ(out.substr(0, got.bytes), content.substr(0, got.bytes));
    }
    std::string wrong = all;
    wrong[wrong.size() - 6] ^= 1;  // of the checksum, or of what is before it
    EXPECT_FALSE(into(wrong, content.size(), out).ended);
  }
  // Members one after another are one stream; what is none of them is left out.
  std::string out(2 * content.size(), '\0');
  const std::string two = packed(content, 16) + packed(content, 16) + "behind";
  const Unpacked got = unpack(two, std::as_writable_bytes(std::span(out)));
  EXPECT_TRUE(got.ended && got.bytes == out.size());
  EXPECT_EQ(out, content + content);
}

}  // namespace
}  // namespace palpate
