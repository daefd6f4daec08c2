#include "common/load/gzip_head.h"

#include <zlib.h>

namespace palpate {

bool is_gzip(std::string_view bytes) noexcept { return bytes.starts_with("\x1f\x8b"); }

std::string gzip_head(std::string_view compressed, std::size_t most) {
  z_stream stream{};
  constexpr int kGzipWrapper = 16;  // added to the size of the window: gzip's header in place of zlib's
  if (inflateInit2(&stream, MAX_WBITS + kGzipWrapper) != Z_OK) return {};
  std::string head(most, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  stream.next_out = reinterpret_cast<Bytef*>(head.data());
  stream.avail_out = static_cast<uInt>(most);
  (void)inflate(&stream, Z_SYNC_FLUSH);  // what was unpacked before an error counts too
  head.resize(most - stream.avail_out);
  inflateEnd(&stream);
  return head;
}

}  // namespace palpate
