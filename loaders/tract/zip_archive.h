/// The members of a zip file: stored or deflated, with 64-bit sizes where the file needs them (PKWARE APPNOTE
/// 6.3). No encryption, no archive in several parts.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace palpate {

class ZipArchive {
 public:
  /// Reads the central directory.
  /// @param bytes of the whole file, which outlive the archive.
  /// @throws Error (bad input) with `file`: no directory, or members that lie outside the file, are
  /// encrypted, or packed in another way.
  ZipArchive(std::string file, std::string_view bytes);

  struct Member {
    std::uint64_t local_header = 0;  ///< byte offset
    std::uint64_t packed = 0;
    std::uint64_t size = 0;
    std::uint32_t crc = 0;
    std::uint16_t method = 0;  ///< 0 stored, 8 deflated
  };
  /// By path, folders ("dpv/") left out.
  [[nodiscard]] const std::map<std::string, Member>& members() const noexcept { return members_; }

  /// The unpacked bytes, whose checksum was compared.
  /// @throws Error (bad input): damaged, or of another size than claimed.
  [[nodiscard]] std::string read(const std::string& name, const Member& member) const;

 private:
  struct Directory {
    std::uint64_t at = 0;
    std::uint64_t size = 0;
    std::uint64_t entries = 0;
  };
  [[nodiscard]] Directory find_directory() const;
  /// Reads the entry at `at` and moves `at` behind it.
  void read_entry(std::uint64_t& at, std::uint64_t end);
  [[noreturn]] void refuse(const std::string& place, const std::string& found) const;

  std::string file_;
  std::string_view bytes_;
  std::map<std::string, Member> members_;
};

}  // namespace palpate
