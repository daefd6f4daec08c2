#include "loaders/tract/zip_archive.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <zlib.h>

#include "common/base/error.h"
#include "common/base/file_numbers.h"
#include "common/load/gzip_head.h"

namespace palpate {
namespace {

constexpr std::string_view kEndMark("PK\5\6", 4), kEnd64Mark("PK\6\6", 4), kLocator64Mark("PK\6\7", 4),
    kEntryMark("PK\1\2", 4), kLocalMark("PK\3\4", 4);
constexpr std::size_t kEndBytes = 22, kEnd64Bytes = 56, kLocator64Bytes = 20, kEntryBytes = 46,
                      kLocalBytes = 30;
/// Where a field of 16 or 32 bits is full, the number stands in a field of 64 bits elsewhere.
constexpr std::uint32_t kElsewhere = std::numeric_limits<std::uint32_t>::max();

std::uint64_t u16(std::string_view bytes, std::uint64_t at) {
  return number_at<std::uint16_t>(bytes, at, false);
}
std::uint64_t u32(std::string_view bytes, std::uint64_t at) {
  return number_at<std::uint32_t>(bytes, at, false);
}
std::uint64_t u64(std::string_view bytes, std::uint64_t at) {
  return number_at<std::uint64_t>(bytes, at, false);
}

}  // namespace

ZipArchive::ZipArchive(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {
  const Directory directory = find_directory();
  if (directory.at > bytes_.size() || directory.size > bytes_.size() - directory.at ||
      directory.entries > directory.size / kEntryBytes) {
    refuse("", "its list of members lies outside the file");
  }
  std::uint64_t at = directory.at;
  for (std::uint64_t entry = 0; entry < directory.entries; ++entry)
    read_entry(at, directory.at + directory.size);
}

ZipArchive::Directory ZipArchive::find_directory() const {
  // The end record is followed by a comment of at most 64 KiB.
  const std::size_t most = kEndBytes + std::numeric_limits<std::uint16_t>::max();
  const std::size_t from = bytes_.size() > most ? bytes_.size() - most : 0;
  const std::size_t found = bytes_.rfind(kEndMark);
  if (found == std::string_view::npos || found < from || bytes_.size() - found < kEndBytes)
    refuse("", "has no list of its members at its end");
  Directory directory{u32(bytes_, found + 16), u32(bytes_, found + 12), u16(bytes_, found + 10)};
  const bool elsewhere = directory.at == kElsewhere || directory.size == kElsewhere ||
                         directory.entries == std::numeric_limits<std::uint16_t>::max();
  if (!elsewhere || found < kLocator64Bytes ||
      bytes_.substr(found - kLocator64Bytes, kLocator64Mark.size()) != kLocator64Mark) {
    return directory;
  }
  const std::uint64_t end64 = u64(bytes_, found - kLocator64Bytes + 8);
  if (end64 > bytes_.size() || bytes_.size() - end64 < kEnd64Bytes ||
      bytes_.substr(end64, kEnd64Mark.size()) != kEnd64Mark) {
    refuse("", "its list of members lies outside the file");
  }
  return {u64(bytes_, end64 + 48), u64(bytes_, end64 + 40), u64(bytes_, end64 + 32)};
}

void ZipArchive::read_entry(std::uint64_t& at, std::uint64_t end) {
  if (end - at < kEntryBytes || bytes_.substr(at, kEntryMark.size()) != kEntryMark)
    refuse("", "its list of members is damaged");
  const std::uint64_t name_bytes = u16(bytes_, at + 28), extra_bytes = u16(bytes_, at + 30),
                      comment_bytes = u16(bytes_, at + 32);
  if (end - at - kEntryBytes < name_bytes + extra_bytes + comment_bytes)
    refuse("", "its list of members is damaged");
  const std::string name(bytes_.substr(at + kEntryBytes, name_bytes));
  Member member{.local_header = u32(bytes_, at + 42),
                .packed = u32(bytes_, at + 20),
                .size = u32(bytes_, at + 24),
                .crc = static_cast<std::uint32_t>(u32(bytes_, at + 16)),
                .method = static_cast<std::uint16_t>(u16(bytes_, at + 10))};
  const std::uint64_t flags = u16(bytes_, at + 8);

  // The extra field 1 holds those of the three numbers that are full, in this order.
  const std::string_view extra = bytes_.substr(at + kEntryBytes + name_bytes, extra_bytes);
  for (std::size_t e = 0; e + 4 <= extra.size();) {
    const std::uint64_t id = u16(extra, e), size = u16(extra, e + 2);
    std::size_t value = e + 4;
    if (size > extra.size() - value) break;
    const std::size_t behind = value + size;
    for (std::uint64_t* number : {&member.size, &member.packed, &member.local_header}) {
      if (id != 1 || *number != kElsewhere || behind - value < sizeof(std::uint64_t)) continue;
      *number = u64(extra, value);
      value += sizeof(std::uint64_t);
    }
    e = behind;
  }
  at += kEntryBytes + name_bytes + extra_bytes + comment_bytes;
  if (name.ends_with('/')) return;
  if ((flags & 1U) != 0) refuse(name, "is encrypted");
  if (member.method != 0 && member.method != Z_DEFLATED)
    refuse(name, "is packed by method " + std::to_string(member.method) + ", not deflated or stored");
  members_.insert_or_assign(name, member);
}

std::string ZipArchive::read(const std::string& name, const Member& member) const {
  const std::uint64_t header = member.local_header;
  if (header > bytes_.size() || bytes_.size() - header < kLocalBytes ||
      bytes_.substr(header, kLocalMark.size()) != kLocalMark) {
    refuse(name, "is not where the list of members says");
  }
  const std::uint64_t behind = u16(bytes_, header + 26) + u16(bytes_, header + 28);
  const std::uint64_t left = bytes_.size() - header - kLocalBytes;
  if (behind > left || member.packed > left - behind) refuse(name, "reaches beyond the end of the file");
  const std::string_view packed = bytes_.substr(header + kLocalBytes + behind, member.packed);
  const bool possible =
      member.method == 0 ? member.size == packed.size() : member.size / kGzipRatio <= packed.size();
  if (!possible) {
    refuse(name, "claims " + std::to_string(member.size) + " bytes, and " + std::to_string(packed.size()) +
                     " are there");
  }

  std::string unpacked(member.size, '\0');
  if (member.method == 0) {
    unpacked = packed;
  } else {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    // zlib counts in 32 bits, so a large member is handed over in parts.
    constexpr std::size_t kPart = std::size_t{1} << 30;
    std::size_t in = 0, out = 0;
    int status = Z_OK;
    while (status == Z_OK) {
      const std::size_t in_part = std::min(kPart, packed.size() - in);
      const std::size_t out_part = std::min(kPart, unpacked.size() - out);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));
      stream.avail_in = static_cast<uInt>(in_part);
      stream.next_out = reinterpret_cast<Bytef*>(unpacked.data() + out);
      stream.avail_out = static_cast<uInt>(out_part);
      status = inflate(&stream, Z_NO_FLUSH);
      in += in_part - stream.avail_in;
      out += out_part - stream.avail_out;
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END || out != unpacked.size())
      refuse(name, "cannot be unpacked to the size it claims");
  }
  const auto* data = reinterpret_cast<const Bytef*>(unpacked.data());
  if (crc32_z(crc32_z(0, nullptr, 0), data, unpacked.size()) != member.crc)
    refuse(name, "does not have the checksum that the file states");
  return unpacked;
}

void ZipArchive::refuse(const std::string& place, const std::string& found) const {
  throw input_error({file_, place, found, "", "the file may be damaged or cut off"});
}

}  // namespace palpate
