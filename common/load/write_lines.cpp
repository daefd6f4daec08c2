#include "common/load/write_lines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/output_file.h"

namespace palpate {
namespace {

static_assert(std::endian::native == std::endian::little, "the binary formats are written little endian");

using Columns = std::span<const PointColumn>;

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::size_t count_points(const std::vector<Line>& lines) {
  std::size_t points = 0;
  for (const Line& line : lines) points += line.points.size();
  return points;
}

/// The shortest text that reads back as the same number.
std::string text_of(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

// ---- .vtp ----------------------------------------------------------------------------------------------

/// One array of the appended data: its declaration says where its bytes begin.
class Appendix {
 public:
  std::string declare(const char* type, std::string_view name, int components, std::uint64_t bytes) {
    std::string text = std::string("<DataArray type=\"") + type + "\" Name=\"" + std::string(name) +
                       "\" NumberOfComponents=\"" + std::to_string(components) +
                       "\" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + bytes;
    return text;
  }

 private:
  std::uint64_t offset_ = 0;
};

/// VTK XML, PolyData, raw appended data (VTK File Formats, "XML File Formats"). `termination` is text; its
/// number stands beside it since ParaView cannot colour by text.
void write_vtp(OutputFile& file, const std::vector<Line>& lines, Columns columns) {
  const std::size_t points = count_points(lines);
  const std::uint64_t per_point = points * sizeof(double);
  const std::uint64_t per_line = lines.size() * sizeof(std::int64_t);
  std::uint64_t words = 0;
  for (const Line& line : lines) words += name_of(line.end).size() + 1;

  Appendix appendix;
  std::string head =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<Piece NumberOfPoints=\"" +
      std::to_string(points) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(lines.size()) +
      "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  head += "<PointData Scalars=\"speed\">\n";
  head += appendix.declare("Float64", "time", 1, per_point);
  head += appendix.declare("Float64", "speed", 1, per_point);
  head += appendix.declare("Float64", "error", 1, per_point);
  for (const PointColumn& column : columns) head += appendix.declare("Float64", column.name, 1, per_point);
  head += "</PointData>\n<CellData>\n";
  head += appendix.declare("String", "termination", 1, words);
  head += appendix.declare("Int64", "termination_code", 1, per_line);
  head += appendix.declare("Int64", "seed", 1, per_line);
  head += "</CellData>\n<Points>\n";
  head += appendix.declare("Float64", "Points", 3, 3 * per_point);
  head += "</Points>\n<Lines>\n";
  head += appendix.declare("Int64", "connectivity", 1, points * sizeof(std::int64_t));
  head += appendix.declare("Int64", "offsets", 1, per_line);
  head += "</Lines>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  file.write(head);

  const auto each_point = [&](std::uint64_t bytes, const auto& write) {
    file.write_number(bytes);
    for (const Line& line : lines) {
      for (const LinePoint& point : line.points) write(point);
    }
  };
  each_point(per_point, [&](const LinePoint& point) { file.write_number(point.time); });
  each_point(per_point, [&](const LinePoint& point) { file.write_number(point.speed); });
  each_point(per_point, [&](const LinePoint& point) { file.write_number(point.error); });
  for (const PointColumn& column : columns) {
    file.write_number(per_point);
    for (const double value : column.values) file.write_number(value);
  }

  file.write_number(words);
  for (const Line& line : lines) {
    file.write(name_of(line.end));
    file.write_number('\0');
  }
  file.write_number(per_line);
  for (const Line& line : lines) file.write_number(static_cast<std::int64_t>(line.end));
  file.write_number(per_line);
  for (const Line& line : lines) file.write_number(static_cast<std::int64_t>(line.seed));

  each_point(3 * per_point, [&](const LinePoint& point) {
    for (int axis = 0; axis < 3; ++axis) file.write_number(point.position[axis]);
  });
  std::int64_t next = 0;
  each_point(points * sizeof(std::int64_t), [&](const LinePoint&) { file.write_number(next++); });
  file.write_number(per_line);
  std::int64_t end = 0;
  for (const Line& line : lines) {
    end += static_cast<std::int64_t>(line.points.size());
    file.write_number(end);
  }
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

// ---- single precision ----------------------------------------------------------------------------------

/// `value` in single precision. @throws Error (work failed) where it does not fit.
float single(double value) {
  const auto narrow = static_cast<float>(value);
  if (std::isfinite(value) && !std::isfinite(narrow)) {
    throw work_error("a value of " + text_of(value) +
                     " does not fit this format's single precision; write .vtp or .csv");
  }
  return narrow;
}

// ---- .tck ----------------------------------------------------------------------------------------------

/// MRtrix3 tracks: a text header, then triplets of floats; NaN ends a track, infinity the file.
/// https://mrtrix.readthedocs.io, "MRtrix Tracks file format".
void write_tck(OutputFile& file, const std::vector<Line>& lines, Columns) {
  const std::string start = "mrtrix tracks\ndatatype: Float32LE\ncount: " + std::to_string(lines.size()) +
                            "\ntotal_count: " + std::to_string(lines.size()) + "\nfile: . ";
  // The header names its own length, whose digits are part of it.
  const std::string_view end = "\nEND\n";
  std::size_t length = start.size() + end.size();
  while (length != start.size() + end.size() + std::to_string(length).size()) {
    length = start.size() + end.size() + std::to_string(length).size();
  }
  file.write(start + std::to_string(length));
  file.write(end);

  const auto triplet = [&file](const std::array<float, 3>& x) { file.write(std::as_bytes(std::span(x))); };
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) {
      triplet({single(point.position.x), single(point.position.y), single(point.position.z)});
    }
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    triplet({kNan, kNan, kNan});
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  triplet({kInfinity, kInfinity, kInfinity});
}

// ---- .trk ----------------------------------------------------------------------------------------------

/// Header of a TrackVis file, version 2: http://trackvis.org/docs/?subsect=fileformat. 1000 bytes.
#pragma pack(push, 1)
struct TrkHeader {
  std::array<char, 6> id_string{'T', 'R', 'A', 'C', 'K', '\0'};
  std::array<std::int16_t, 3> dim{};
  std::array<float, 3> voxel_size{};
  std::array<float, 3> origin{};
  std::int16_t n_scalars = 0;
  std::array<std::array<char, 20>, 10> scalar_name{};
  std::int16_t n_properties = 0;
  std::array<std::array<char, 20>, 10> property_name{};
  std::array<std::array<float, 4>, 4> vox_to_ras{};
  std::array<char, 444> reserved{};
  std::array<char, 4> voxel_order{'R', 'A', 'S', '\0'};
  std::array<char, 4> pad2{'R', 'A', 'S', '\0'};
  std::array<float, 6> image_orientation_patient{1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F};
  std::array<char, 2> pad1{};
  std::array<std::uint8_t, 6> invert_and_swap{};
  std::int32_t n_count = 0;
  std::int32_t version = 2;
  std::int32_t hdr_size = 1000;
};
#pragma pack(pop)
static_assert(sizeof(TrkHeader) == 1000);

void put_name(std::array<char, 20>& field, std::string_view name) {
  std::copy_n(name.begin(), std::min(name.size(), field.size() - 1), field.begin());
}

/// Points in a .trk file are measured from the corner of voxel (0, 0, 0) along the voxel axes. The lines'
/// own bounds stand in for an image: voxels of a power of two, so that `corner` costs no rounding of its own.
struct TrkSpace {
  double voxel = 1.0;
  Vec3 corner{0.0};
  Index3 dim{1};
};

TrkSpace trk_space(const std::vector<Line>& lines) {
  Box bounds;
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) {
      if (is_finite(point.position)) bounds.include(point.position);
    }
  }
  TrkSpace space;
  if (bounds.empty()) return space;
  const Vec3 size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  constexpr int kVoxelsLog2 = 8;
  if (longest > 0.0) space.voxel = std::ldexp(1.0, std::ilogb(longest) + 1 - kVoxelsLog2);
  space.corner = glm::floor(bounds.lower / space.voxel) * space.voxel;
  for (int axis = 0; axis < 3; ++axis) {
    space.dim[axis] =
        static_cast<int>(std::floor((bounds.upper[axis] - space.corner[axis]) / space.voxel)) + 1;
  }
  return space;
}

void write_trk(OutputFile& file, const std::vector<Line>& lines, Columns) {
  const TrkSpace space = trk_space(lines);
  TrkHeader header;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<int>(axis);
    header.dim[axis] = static_cast<std::int16_t>(space.dim[a]);
    header.voxel_size[axis] = single(space.voxel);
    header.vox_to_ras[axis][axis] = single(space.voxel);
    header.vox_to_ras[axis][3] = single(space.corner[a] + 0.5 * space.voxel);  // the centre of voxel 0
  }
  header.vox_to_ras[3][3] = 1.0F;
  header.n_scalars = 3;
  put_name(header.scalar_name[0], "time");
  put_name(header.scalar_name[1], "speed");
  put_name(header.scalar_name[2], "error");
  header.n_properties = 1;
  put_name(header.property_name[0], "termination");
  if (lines.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw work_error("too many lines for a .trk file; write .vtp or .csv");
  }
  header.n_count = static_cast<std::int32_t>(lines.size());
  file.write(std::as_bytes(std::span(&header, 1)));

  for (const Line& line : lines) {
    file.write_number(static_cast<std::int32_t>(line.points.size()));
    for (const LinePoint& point : line.points) {
      const Vec3 x = point.position - space.corner;
      for (const double value : {x.x, x.y, x.z, point.time, point.speed, point.error})
        file.write_number(single(value));
    }
    file.write_number(static_cast<float>(line.end));
  }
}

// ---- .csv ----------------------------------------------------------------------------------------------

void write_csv(OutputFile& file, const std::vector<Line>& lines, Columns columns) {
  std::string header = "line,seed,point,x,y,z,time,arc,speed,error,termination";
  for (const PointColumn& column : columns) (header += ',') += column.name;
  file.write(header + "\n");
  std::size_t row_number = 0;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Line& line = lines[l];
    for (std::size_t p = 0; p < line.points.size(); ++p) {
      const LinePoint& point = line.points[p];
      std::string row = std::to_string(l) + "," + std::to_string(line.seed) + "," + std::to_string(p);
      for (const double value : {point.position.x, point.position.y, point.position.z, point.time, point.arc,
                                 point.speed, point.error}) {
        row += ",";
        row += text_of(value);
      }
      row += ",";
      row += name_of(line.end);
      for (const PointColumn& column : columns) (row += ',') += text_of(column.values[row_number]);
      ++row_number;
      row += "\n";
      file.write(row);
    }
  }
}

using Writer = void (*)(OutputFile&, const std::vector<Line>&, Columns);

Writer writer_for(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  if (ending == ".vtp") return write_vtp;
  if (ending == ".tck") return write_tck;
  if (ending == ".trk") return write_trk;
  if (ending == ".csv") return write_csv;
  throw usage_error(path.string() + ": lines are written as .vtp, .tck, .trk or .csv, not '" + ending + "'");
}

}  // namespace

void check_line_output(const std::filesystem::path& path, bool overwrite) {
  (void)writer_for(path);
  check_output(path, overwrite);
}

void write_lines(const std::filesystem::path& path, const std::vector<Line>& lines, bool overwrite,
                 std::span<const PointColumn> columns) {
  const Writer write = writer_for(path);
  for (const PointColumn& column : columns) PALPATE_CHECK(column.values.size() == count_points(lines));
  OutputFile file(path, overwrite);
  try {
    write(file, lines, columns);
  } catch (const Error& error) {
    const bool named = std::string_view(error.what()).substr(0, path.string().size()) == path.string();
    if (named) throw;
    throw Error(error.code(), path.string() + ": " + error.what());
  }
  file.finish();
}

}  // namespace palpate
