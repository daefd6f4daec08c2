#include "common/load/write/write_tractogram.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/trk_header.h"
#include "common/load/write/vtp_appendix.h"
#include "common/load/write/write_trx.h"

namespace palpate {
namespace {

static_assert(std::endian::native == std::endian::little, "the binary formats are written little endian");
static_assert(sizeof(Vec3f) == 3 * sizeof(float));

/// The shortest text that reads back as the same number.
void append(std::string& text, float value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), result.ptr);
}

void check(const Tractogram& lines) {
  PALPATE_CHECK(!lines.starts.empty() && lines.starts.back() == lines.points.size());
  for (const auto& column : lines.of_points) PALPATE_CHECK(column.values.size() == lines.points.size());
  for (const auto& column : lines.of_lines) PALPATE_CHECK(column.values.size() == lines.line_count());
}

void put_name(std::array<char, 20>& field, std::string_view name) {
  std::copy_n(name.begin(), std::min(name.size(), field.size() - 1), field.begin());
}

/// Which way the voxel axes run: "LAS" where the first runs to the left, and so on.
std::array<char, 4> voxel_order(const Mat3& axes) {
  static constexpr std::array<std::array<char, 2>, 3> kLetters{{{'L', 'R'}, {'P', 'A'}, {'I', 'S'}}};
  std::array<char, 4> order{};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 size = glm::abs(axes[axis]);
    const int world = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    order[as_size(axis)] = kLetters[as_size(world)][axes[axis][world] > 0.0 ? 1 : 0];
  }
  return order;
}

/// How many of the columns a .trk file takes, named in `names`.
std::int16_t trk_columns(const std::vector<Tractogram::Column>& columns,
                         std::array<std::array<char, 20>, 10>& names) {
  if (columns.size() > names.size()) {
    throw work_error("a .trk file holds ten numbers for each point or line, found " +
                     std::to_string(columns.size()) + "; write .vtp or .csv");
  }
  for (std::size_t c = 0; c < columns.size(); ++c) put_name(names[c], columns[c].name);
  return static_cast<std::int16_t>(columns.size());
}

template <typename T>
void write_array(OutputFile& file, const std::vector<T>& values) {
  file.write_number(static_cast<std::uint64_t>(values.size() * sizeof(T)));
  file.write(std::as_bytes(std::span(values)));
}

void write_vtp(OutputFile& file, const Tractogram& lines) {
  const std::uint64_t point_bytes = lines.points.size() * sizeof(float);
  const std::uint64_t line_bytes = lines.line_count() * sizeof(std::int64_t);
  VtpAppendix appendix;
  std::string head =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<Piece NumberOfPoints=\"" +
      std::to_string(lines.points.size()) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
      std::to_string(lines.line_count()) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n";
  for (const auto& column : lines.of_points) head += appendix.declare("Float32", column.name, 1, point_bytes);
  head += "</PointData>\n<CellData>\n";
  for (const auto& column : lines.of_lines) {
    head += appendix.declare("Float32", column.name, 1, lines.line_count() * sizeof(float));
  }
  head += "</CellData>\n<Points>\n" + appendix.declare("Float32", "Points", 3, 3 * point_bytes);
  // One statement an array: the operands of + may be evaluated in any order.
  head += "</Points>\n<Lines>\n";
  head += appendix.declare("Int64", "connectivity", 1, lines.points.size() * sizeof(std::int64_t));
  head += appendix.declare("Int64", "offsets", 1, line_bytes);
  head += "</Lines>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  file.write(head);
  for (const auto& column : lines.of_points) write_array(file, column.values);
  for (const auto& column : lines.of_lines) write_array(file, column.values);
  write_array(file, lines.points);
  file.write_number(static_cast<std::uint64_t>(lines.points.size() * sizeof(std::int64_t)));
  for (std::size_t p = 0; p < lines.points.size(); ++p) file.write_number(static_cast<std::int64_t>(p));
  file.write_number(line_bytes);
  for (std::size_t i = 1; i < lines.starts.size(); ++i) {
    file.write_number(static_cast<std::int64_t>(lines.starts[i]));
  }
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

void write_csv(OutputFile& file, const Tractogram& lines) {
  std::string text = "line,point,x,y,z";
  for (const auto& column : lines.of_points) (text += ',') += column.name;
  for (const auto& column : lines.of_lines) (text += ',') += column.name;
  file.write(text += '\n');
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    for (std::uint64_t p = lines.starts[l]; p < lines.starts[l + 1]; ++p) {
      text = std::to_string(l) + ',' + std::to_string(p - lines.starts[l]);
      const auto add = [&text](float value) { append(text += ',', value); };
      for (int axis = 0; axis < 3; ++axis) add(lines.points[p][axis]);
      for (const auto& column : lines.of_points) add(column.values[p]);
      for (const auto& column : lines.of_lines) add(column.values[l]);
      file.write(text += '\n');
    }
  }
}

using TractWriter = void (*)(OutputFile&, const Tractogram&);

TractWriter tract_writer_for(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  if (ending == ".tck") return write_tck;
  if (ending == ".trk") return write_trk;
  if (ending == ".trx") return write_trx;
  if (ending == ".vtp") return write_vtp;
  if (ending == ".csv") return write_csv;
  throw usage_error(path.string() + ": tracts are written as .tck, .trk, .trx, .vtp or .csv, not '" + ending +
                    "'");
}

}  // namespace

std::string lower_ending(const std::filesystem::path& path) { return lowered(path.extension().string()); }

/// https://mrtrix.readthedocs.io, "MRtrix Tracks file format": a text header, then triplets of floats; NaN
/// ends a track, infinity the file.
void write_tck(OutputFile& file, const Tractogram& lines) {
  check(lines);
  const std::string count = std::to_string(lines.line_count());
  const std::string start =
      "mrtrix tracks\ndatatype: Float32LE\ncount: " + count + "\ntotal_count: " + count + "\nfile: . ";
  // The header names its own length, whose digits are part of it.
  const std::string_view end = "\nEND\n";
  std::size_t length = start.size() + end.size();
  while (length != start.size() + end.size() + std::to_string(length).size()) {
    length = start.size() + end.size() + std::to_string(length).size();
  }
  file.write(start + std::to_string(length));
  file.write(end);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::array<float, 3> between{kNan, kNan, kNan}, last{kInfinity, kInfinity, kInfinity};
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    file.write(std::as_bytes(lines.line(l)));
    file.write(std::as_bytes(std::span(between)));
  }
  file.write(std::as_bytes(std::span(last)));
}

void write_trk(OutputFile& file, const Tractogram& lines) {
  check(lines);
  const TractogramImage image =
      lines.image.value_or(TractogramImage{.voxels = Index3{1}, .axes = Mat3{1.0}, .origin = Vec3{0.0}});
  TrkHeader header;
  Vec3 size{0.0};
  constexpr int kMostVoxels = std::numeric_limits<std::int16_t>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = as_size(axis);
    size[axis] = glm::length(image.axes[axis]);
    header.dim[a] = static_cast<std::int16_t>(std::clamp(image.voxels[axis], 0, kMostVoxels));
    header.voxel_size[a] = static_cast<float>(size[axis]);
    for (int column = 0; column < 3; ++column) {
      header.vox_to_ras[a][as_size(column)] = static_cast<float>(image.axes[column][axis]);
    }
    header.vox_to_ras[a][3] = static_cast<float>(image.origin[axis]);
  }
  header.vox_to_ras[3][3] = 1.0F;
  header.voxel_order = header.pad2 = voxel_order(image.axes);
  header.n_scalars = trk_columns(lines.of_points, header.scalar_name);
  header.n_properties = trk_columns(lines.of_lines, header.property_name);
  if (lines.line_count() > as_size(std::numeric_limits<std::int32_t>::max())) {
    throw work_error("too many lines for a .trk file; write .vtp or .csv");
  }
  header.n_count = static_cast<std::int32_t>(lines.line_count());
  file.write(std::as_bytes(std::span(&header, 1)));

  // Positions are lengths along the voxel axes from the corner of the first voxel.
  const Mat3 to_voxels = glm::inverse(image.axes);
  std::vector<float> row;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    file.write_number(static_cast<std::int32_t>(lines.line(l).size()));
    for (std::uint64_t p = lines.starts[l]; p < lines.starts[l + 1]; ++p) {
      const Vec3 x = (to_voxels * (Vec3{lines.points[p]} - image.origin) + 0.5) * size;
      row = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
      for (const auto& column : lines.of_points) row.push_back(column.values[p]);
      file.write(std::as_bytes(std::span(row)));
    }
    row.clear();
    for (const auto& column : lines.of_lines) row.push_back(column.values[l]);
    file.write(std::as_bytes(std::span(row)));
  }
}

void write_tractogram(const std::filesystem::path& path, const Tractogram& lines, bool overwrite) {
  check(lines);
  const TractWriter write = tract_writer_for(path);
  OutputFile file(path, overwrite);
  try {
    write(file, lines);
  } catch (const Error& error) {
    const bool named = std::string_view(error.what()).starts_with(path.string());
    if (named) throw;
    throw Error(error.code(), path.string() + ": " + error.what());
  }
  file.finish();
}

}  // namespace palpate
