#include "loaders/nrrd/gzip_rest.h"

#include <array>
#include <cstring>
#include <fstream>

#include <zlib.h>

#include "common/base/text.h"

namespace palpate {
namespace {

/// zlib's state, ended with this.
struct Inflater {
  z_stream stream{};
  bool good = false;

  Inflater() {
    constexpr int kGzip = 16;
    good = inflateInit2(&stream, MAX_WBITS + kGzip) == Z_OK;
  }
  ~Inflater() {
    if (good) inflateEnd(&stream);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

std::string gzip_rest(const std::filesystem::path& file, std::uint64_t first, std::uint64_t wanted) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(in.tellg());
  constexpr std::uint64_t kTrailer = 4;
  if (!in || size < first + kTrailer) return {};
  std::array<unsigned char, kTrailer> trailer{};
  in.seekg(static_cast<std::streamoff>(size - kTrailer));
  in.read(reinterpret_cast<char*>(trailer.data()), kTrailer);
  std::uint32_t stated = 0;
  for (std::size_t i = kTrailer; i-- > 0;) stated = stated << 8U | trailer[i];
  if (stated == static_cast<std::uint32_t>(wanted)) return {};

  Inflater inflater;
  if (!inflater.good) return {};
  in.seekg(static_cast<std::streamoff>(first));
  std::array<unsigned char, 1U << 16U> packed{}, unpacked{};
  std::uint64_t consumed = first, made = 0;
  z_stream& z = inflater.stream;
  int result = Z_OK;
  while (true) {
    if (z.avail_in == 0) {
      in.read(reinterpret_cast<char*>(packed.data()), packed.size());
      z.next_in = packed.data();
      z.avail_in = static_cast<uInt>(in.gcount());
      if (z.avail_in == 0) return {};  // cut off, which is the reader's to say
    }
    // Another member may follow; anything else is no gzip data.
    if (result == Z_STREAM_END) {
      if (z.next_in[0] != 0x1f || inflateReset(&z) != Z_OK) break;
    }
    const uInt before = z.avail_in;
    z.next_out = unpacked.data();
    z.avail_out = static_cast<uInt>(unpacked.size());
    result = inflate(&z, Z_NO_FLUSH);
    consumed += before - z.avail_in;
    made += unpacked.size() - z.avail_out;
    if (made > wanted)
      return "its gzip data unpacks to more than the " + std::to_string(wanted) +
             " bytes that the header claims: the rest is left out";
    if (result != Z_OK && result != Z_STREAM_END) break;
    if (result == Z_STREAM_END && consumed == size) return {};
  }
  return counted(static_cast<std::size_t>(size - consumed), "byte") + " after its gzip data are left out";
}

}  // namespace palpate
