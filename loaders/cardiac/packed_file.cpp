#include "loaders/cardiac/packed_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include <zlib.h>

#include "common/base/index.h"

namespace palpate {
namespace {

/// Whether a file is packed, by its first bytes: not every packed one is called so.
bool is_packed(const std::string& path) {
  std::array<char, 2> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  return head == std::array<char, 2>{'\x1f', '\x8b'};
}

}  // namespace

PackedFile::PackedFile(const std::string& path) : file_(gzopen(path.c_str(), "rb")) {}

PackedFile::~PackedFile() {
  if (file_ != nullptr) gzclose(file_);
}

std::size_t PackedFile::read(void* to, std::size_t bytes) {
  if (file_ == nullptr) return 0;
  std::size_t got = 0;
  while (got < bytes) {
    constexpr std::size_t kAtOnce = std::size_t{1} << 24U;
    const int now =
        gzread(file_, static_cast<char*>(to) + got, static_cast<unsigned>(std::min(kAtOnce, bytes - got)));
    if (now <= 0) break;
    got += as_size(now);
  }
  return got;
}

bool PackedFile::go_to(std::uint64_t place) {
  return file_ != nullptr && gzseek(file_, static_cast<z_off_t>(place), SEEK_SET) >= 0;
}

std::uint64_t unpacked_bytes(const std::string& path) {
  std::error_code error;
  const std::uintmax_t stored = std::filesystem::file_size(path, error);
  if (!is_packed(path)) return error ? 0 : stored;
  PackedFile file(path);
  std::vector<char> piece(std::size_t{1} << 20U);
  std::uint64_t bytes = 0;
  while (const std::size_t got = file.read(piece.data(), piece.size())) bytes += got;
  return bytes;
}

}  // namespace palpate
