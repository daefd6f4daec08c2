#include "common/study/packed_text.h"

#include <memory>

#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"

namespace palpate {

std::string packed(std::string_view text) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16, kMemory = 8;
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw work_error("not enough memory to pack a recording");
  std::string out(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = deflate(&stream, Z_FINISH);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw work_error("a recording cannot be packed");
  return out;
}

std::string unpacked_file(const std::string& file, std::size_t most) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw input_error({file, "", "cannot be read (" + errno_text() + ")", "", ""});
  std::string out;
  std::string part(std::size_t{1} << 16U, '\0');
  for (;;) {
    const int got = gzread(in.get(), part.data(), static_cast<unsigned>(part.size()));
    if (got == 0 && gzeof(in.get()) != 0) break;
    int error = Z_OK;
    (void)gzerror(in.get(), &error);
    if (got <= 0 || out.size() + static_cast<std::size_t>(got) > most)
      throw input_error({file, "", got <= 0 ? "it is damaged" : "it unpacks to too much",
                         "a packed recording", "restore it from a copy"});
    out.append(part, 0, static_cast<std::size_t>(got));
  }
  int error = Z_OK;
  (void)gzerror(in.get(), &error);
  if (error != Z_OK && error != Z_STREAM_END)
    throw input_error({file, "", "it is cut off", "a packed recording", "restore it from a copy"});
  return out;
}

Recording read_packed_recording(const std::string& file) {
  const std::string text = unpacked_file(file);
  const UniqueFd memory(memfd_create("recording", MFD_CLOEXEC));
  for (std::size_t at = 0; memory.get() >= 0 && at < text.size();) {
    const ssize_t got = ::write(memory.get(), text.data() + at, text.size() - at);
    if (got <= 0) throw work_error("not enough memory to unpack " + file);
    at += static_cast<std::size_t>(got);
  }
  try {
    return read_recording("/proc/self/fd/" + std::to_string(memory.get()));
  } catch (const Error& error) {
    throw Error(error.code(), file + ": " + error.what());
  }
}

}  // namespace palpate
