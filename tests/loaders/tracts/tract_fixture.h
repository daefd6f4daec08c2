/// Tractograms for tests: sample lines, and the bytes of files made by hand.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/geometry/tractogram.h"

namespace palpate::test {

/// Four lines of 2, 5, 8 and 11 points with two numbers a point and one a line.
inline Tractogram sample_tracts() {
  Tractogram lines;
  lines.of_points = {{.name = "fa", .values = {}}, {.name = "force", .values = {}}};
  lines.of_lines = {{.name = "seed", .values = {}}};
  for (int l = 0; l < 4; ++l) {
    for (int p = 0; p < 2 + 3 * l; ++p) {
      const auto s = static_cast<float>(p), t = static_cast<float>(l);
      lines.points.emplace_back(-31.25F + 0.37F * s, 12.5F * std::sin(s + t), 40.0F + t * s / 3.0F);
      lines.of_points[0].values.push_back(0.1F * s);
      lines.of_points[1].values.push_back(1e-6F * t);
    }
    lines.starts.push_back(lines.points.size());
    lines.of_lines[0].values.push_back(7.0F * static_cast<float>(l));
  }
  return lines;
}

/// Expects the same lines, each point within `tolerance` [mm].
inline void expect_same_lines(const Tractogram& found, const Tractogram& wanted, double tolerance) {
  ASSERT_EQ(found.starts, wanted.starts);
  for (std::size_t p = 0; p < wanted.points.size(); ++p)
    ASSERT_LE(glm::distance(found.points[p], wanted.points[p]), tolerance) << "point " << p;
}

/// The values of the column of that name; none where there is no such one.
inline std::vector<float> column(const std::vector<Tractogram::Column>& columns, const std::string& name) {
  for (const auto& column : columns) {
    if (column.name == name) return column.values;
  }
  return {};
}

template <typename T>
void put_number(std::string& bytes, T value, bool big_endian = false) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  bytes += raw;
}

/// The text header of a .tck file whose points follow it at once.
inline std::string tck_header(const std::string& datatype, const std::string& lines = "") {
  std::string text = "mrtrix tracks\ndatatype: " + datatype + "\n" + lines + "file: . ";
  const std::size_t length = text.size() + 3 + std::string("\nEND\n").size();  // an offset of three digits
  const std::string digits = std::to_string(length);
  return text + std::string(3 - digits.size(), '0') + digits + "\nEND\n";
}

/// The points of a .tck file: lines of `T`, closed as the format asks.
template <typename T>
std::string tck_points(const Tractogram& lines, bool big_endian) {
  std::string bytes;
  const auto three = [&](T x, T y, T z) {
    for (const T value : {x, y, z}) put_number(bytes, value, big_endian);
  };
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    for (const Vec3f& x : lines.line(l)) three(x.x, x.y, x.z);
    three(NAN, NAN, NAN);
  }
  three(INFINITY, INFINITY, INFINITY);
  return bytes;
}

/// `content` as a gzip file.
inline std::string gzip(const std::string& content) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, content.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// A zip file of `members`, deflated where `deflated`.
inline std::string zip(const std::vector<std::pair<std::string, std::string>>& members, bool deflated) {
  std::string bytes, directory;
  for (const auto& [name, content] : members) {
    std::string packed = content;
    if (deflated) {
      z_stream stream{};
      deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
      packed.assign(deflateBound(&stream, content.size()), '\0');
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
      stream.avail_in = static_cast<uInt>(content.size());
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, Z_FINISH);
      packed.resize(stream.total_out);
      deflateEnd(&stream);
    }
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
    std::string fields;  // what both headers share
    put_number<std::uint16_t>(fields, 20);
    put_number<std::uint16_t>(fields, 0);
    put_number<std::uint16_t>(fields, deflated ? 8 : 0);
    put_number<std::uint32_t>(fields, 0);
    put_number(fields, crc);
    put_number(fields, static_cast<std::uint32_t>(packed.size()));
    put_number(fields, static_cast<std::uint32_t>(content.size()));
    put_number(fields, static_cast<std::uint16_t>(name.size()));
    put_number<std::uint16_t>(fields, 0);
    directory += std::string("PK\1\2\24\0", 6) + fields + std::string(10, '\0');
    put_number(directory, static_cast<std::uint32_t>(bytes.size()));
    directory += name;
    bytes += "PK\3\4" + fields + name + packed;
  }
  const std::size_t start = bytes.size();
  bytes += directory + std::string("PK\5\6\0\0\0\0", 8);
  put_number(bytes, static_cast<std::uint16_t>(members.size()));
  put_number(bytes, static_cast<std::uint16_t>(members.size()));
  put_number(bytes, static_cast<std::uint32_t>(directory.size()));
  put_number(bytes, static_cast<std::uint32_t>(start));
  return bytes + std::string(2, '\0');
}

/// The members of a TRX file of `lines`.
/// @param end_entry whether the offsets have a last entry for the end.
inline std::vector<std::pair<std::string, std::string>> trx_members(const Tractogram& lines, bool end_entry) {
  std::string positions, offsets, fa, seeds;
  for (const Vec3f& x : lines.points) {
    for (int axis = 0; axis < 3; ++axis) put_number(positions, x[axis]);
  }
  for (std::size_t l = 0; l < lines.line_count() + (end_entry ? 1 : 0); ++l)
    put_number(offsets, lines.starts[l]);
  for (const float value : column(lines.of_points, "fa")) put_number(fa, static_cast<double>(value));
  for (const float value : column(lines.of_lines, "seed")) {
    put_number(seeds, static_cast<std::int16_t>(value));
    put_number(seeds, static_cast<std::int16_t>(-value));
  }
  const std::string header =
      R"({"DIMENSIONS": [4, 5, 6], "VOXEL_TO_RASMM": [[2,0,0,1],[0,2,0,2],[0,0,2,3],[0,0,0,1]], "NB_VERTICES": )" +
      std::to_string(lines.points.size()) + R"(, "NB_STREAMLINES": )" + std::to_string(lines.line_count()) +
      "}";
  std::string group;
  put_number<std::uint32_t>(group, 2);
  return {{"header.json", header}, {"positions.3.float32", positions}, {"offsets.uint64", offsets},
          {"dpv/fa.float64", fa},  {"dps/seed.2.int16", seeds},        {"groups/left.uint32", group}};
}

}  // namespace palpate::test
