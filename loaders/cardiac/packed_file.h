/// Bytes of a file, packed with gzip or not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

struct gzFile_s;

namespace palpate {

/// A file that is read as it is, or unpacked where it is packed with gzip.
class PackedFile {
 public:
  explicit PackedFile(const std::string& path);
  ~PackedFile();
  PackedFile(const PackedFile&) = delete;
  PackedFile& operator=(const PackedFile&) = delete;

  /// How many bytes came; fewer at its end, where it is damaged, and none where it cannot be opened.
  std::size_t read(void* to, std::size_t bytes);
  bool go_to(std::uint64_t place);

 private:
  gzFile_s* file_;
};

/// Of the file as it is unpacked: what can be read of one that is damaged.
[[nodiscard]] std::uint64_t unpacked_bytes(const std::string& path);

}  // namespace palpate
