#include "common/load/gzip_head.h"

#include <algorithm>
#include <array>

#include <zlib.h>

#include "common/base/index.h"

namespace palpate {
namespace {

/// zlib's state, fed in pieces, since it counts in 32 bits.
class Inflater {
 public:
  explicit Inflater(std::string_view packed) : packed_(packed) {
    constexpr int kEitherWrapper = 32;  // added to the size of the window: gzip's or zlib's header
    good_ = inflateInit2(&stream_, MAX_WBITS + kEitherWrapper) == Z_OK;
  }
  ~Inflater() {
    if (good_) inflateEnd(&stream_);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Fills `out` as far as the data go, and says how far.
  std::size_t fill(std::span<std::byte> out) {
    std::size_t done = 0;
    while (good_ && !broken_ && !ended_) {
      if (stream_.avail_in == 0) feed();
      const std::size_t room = std::min(out.size() - done, kPiece);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + done);
      stream_.avail_out = static_cast<uInt>(room);
      const uInt before = stream_.avail_in;
      const int state = inflate(&stream_, Z_NO_FLUSH);
      const std::size_t made = room - stream_.avail_out;
      done += made;
      if (state == Z_STREAM_END) {
        end_of_member();
      } else if (state != Z_OK && state != Z_BUF_ERROR) {
        broken_ = true;
      } else if (made == 0 && stream_.avail_in == before && (room == 0 || packed_.empty())) {
        break;  // no room, or no more data
      }
    }
    return done;
  }
  [[nodiscard]] bool ended() const noexcept { return ended_; }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 30;

  void feed() {
    const std::size_t part = std::min(packed_.size(), kPiece);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed_.data()));
    stream_.avail_in = static_cast<uInt>(part);
    packed_.remove_prefix(part);
  }
  /// Another member may follow; anything else is none of the data.
  void end_of_member() {
    if (stream_.avail_in == 0) feed();
    ended_ = stream_.avail_in < 2 || stream_.next_in[0] != 0x1f || stream_.next_in[1] != 0x8b ||
             inflateReset(&stream_) != Z_OK;
  }

  z_stream stream_{};
  std::string_view packed_;
  bool good_ = false, broken_ = false, ended_ = false;
};

}  // namespace

bool is_gzip(std::string_view bytes) noexcept { return bytes.starts_with("\x1f\x8b"); }

std::string gzip_head(std::string_view compressed, std::size_t most) {
  std::string head(most, '\0');
  head.resize(Inflater(compressed).fill(std::as_writable_bytes(std::span(head))));
  return head;
}

Unpacked unpack(std::string_view packed, std::span<std::byte> out) {
  Inflater inflater(packed);
  Unpacked result{.bytes = inflater.fill(out)};
  std::array<std::byte, 4096> behind{};
  result.more = !inflater.ended() && inflater.fill(behind) > 0;
  result.ended = !result.more && inflater.ended();
  return result;
}

}  // namespace palpate
