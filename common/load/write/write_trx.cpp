#include "common/load/write/write_trx.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <zlib.h>

#include "common/base/error.h"
#include "common/base/json.h"

namespace palpate {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();

/// A zip file whose members are stored without packing (APPNOTE.TXT 4.3, of PKWARE).
class StoredZip {
 public:
  explicit StoredZip(OutputFile& file) : file_(file) {}

  void add(const std::string& name, std::span<const std::byte> bytes) {
    const std::uint64_t at = written_;
    if (at + bytes.size() + name.size() + kHead > kMost)
      throw work_error("four gigabytes and more do not go into a .trx file; write .tck or .vtp");
    Member member{.name = name,
                  .size = static_cast<std::uint32_t>(bytes.size()),
                  .place = static_cast<std::uint32_t>(at)};
    uLong sum = crc32_z(0, nullptr, 0);
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    member.sum = static_cast<std::uint32_t>(sum);
    put32(0x04034b50U);
    put_facts(member);
    write(std::as_bytes(std::span(name)));
    write(bytes);
    members_.push_back(std::move(member));
  }

  void finish() {
    const std::uint64_t begin = written_;
    for (const Member& member : members_) {
      put32(0x02014b50U);
      put16(kVersion);
      put_facts(member);
      put16(0);  // comment
      put16(0);  // disk
      put16(0);  // internal attributes
      put32(0);  // external attributes
      put32(member.place);
      write(std::as_bytes(std::span(member.name)));
    }
    const std::uint64_t size = written_ - begin;
    if (written_ > kMost || members_.size() > std::numeric_limits<std::uint16_t>::max())
      throw work_error("so much does not go into a .trx file; write .tck or .vtp");
    put32(0x06054b50U);
    put32(0);  // disks
    put16(static_cast<std::uint16_t>(members_.size()));
    put16(static_cast<std::uint16_t>(members_.size()));
    put32(static_cast<std::uint32_t>(size));
    put32(static_cast<std::uint32_t>(begin));
    put16(0);  // comment
  }

 private:
  static constexpr std::uint16_t kVersion = 20;
  static constexpr std::uint64_t kHead = 30;
  struct Member {
    std::string name;
    std::uint32_t size = 0, sum = 0, place = 0;
  };

  /// What a member's own head and its entry in the directory share.
  void put_facts(const Member& member) {
    constexpr std::uint16_t kUtf8 = 1U << 11U, kNewYear1980 = (1U << 5U) | 1U;
    put16(kVersion);
    put16(kUtf8);
    put16(0);  // stored
    put16(0);  // time
    put16(kNewYear1980);
    put32(member.sum);
    put32(member.size);
    put32(member.size);
    put16(static_cast<std::uint16_t>(member.name.size()));
    put16(0);  // extra field
  }
  void put16(std::uint16_t value) { write(std::as_bytes(std::span(&value, 1))); }
  void put32(std::uint32_t value) { write(std::as_bytes(std::span(&value, 1))); }
  void write(std::span<const std::byte> bytes) {
    file_.write(bytes);
    written_ += bytes.size();
  }

  OutputFile& file_;
  std::uint64_t written_ = 0;
  std::vector<Member> members_;
};

std::string header_of(const Tractogram& lines) {
  const TractogramImage image = lines.image.value_or(TractogramImage{.voxels = Index3(1)});
  Json matrix = Json::array();
  for (int row = 0; row < 3; ++row)
    matrix.push_back({image.axes[0][row], image.axes[1][row], image.axes[2][row], image.origin[row]});
  matrix.push_back({0.0, 0.0, 0.0, 1.0});
  return Json{{"VOXEL_TO_RASMM", matrix},
              {"DIMENSIONS", {image.voxels.x, image.voxels.y, image.voxels.z}},
              {"NB_VERTICES", lines.points.size()},
              {"NB_STREAMLINES", lines.line_count()}}
      .dump();
}

/// Dots and slashes part a member's name.
std::string member_name(std::string name) {
  for (char& c : name) {
    if (c == '.' || c == '/' || c == '\\') c = '_';
  }
  return name;
}

}  // namespace

void write_trx(OutputFile& file, const Tractogram& lines) {
  StoredZip zip(file);
  const std::string header = header_of(lines);
  zip.add("header.json", std::as_bytes(std::span(header)));
  zip.add("positions.3.float32", std::as_bytes(std::span(lines.points)));
  zip.add("offsets.uint64", std::as_bytes(std::span(lines.starts)));
  for (const Tractogram::Column& column : lines.of_points)
    zip.add("dpv/" + member_name(column.name) + ".float32", std::as_bytes(std::span(column.values)));
  for (const Tractogram::Column& column : lines.of_lines) {
    constexpr std::string_view kGroup = "group ";
    if (!column.name.starts_with(kGroup)) {
      zip.add("dps/" + member_name(column.name) + ".float32", std::as_bytes(std::span(column.values)));
      continue;
    }
    std::vector<std::uint32_t> members;
    for (std::size_t line = 0; line < column.values.size(); ++line) {
      if (column.values[line] != 0.0F) members.push_back(static_cast<std::uint32_t>(line));
    }
    zip.add("groups/" + member_name(column.name.substr(kGroup.size())) + ".uint32",
            std::as_bytes(std::span(members)));
  }
  zip.finish();
}

}  // namespace palpate
