#include "common/load/write/write_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/load/write/vtp_appendix.h"
#include "common/load/write/write_tractogram.h"
#include "common/load/write/write_trx.h"

namespace palpate {
namespace {

using PointColumns = std::span<const PointColumn>;

std::size_t count_points(const std::vector<Line>& lines) {
  std::size_t points = 0;
  for (const Line& line : lines) points += line.points.size();
  return points;
}

// ---- .vtp ----------------------------------------------------------------------------------------------

/// VTK XML, PolyData, raw appended data (VTK File Formats, "XML File Formats"). `termination` is text; its
/// number stands beside it since ParaView cannot colour by text.
void write_vtp(OutputFile& file, const std::vector<Line>& lines, PointColumns columns,
               const TractogramImage*) {
  const std::size_t points = count_points(lines);
  const std::uint64_t per_point = points * sizeof(double);
  const std::uint64_t per_line = lines.size() * sizeof(std::int64_t);
  std::uint64_t words = 0;
  for (const Line& line : lines) words += name_of(line.end).size() + 1;

  VtpAppendix appendix;
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
    throw work_error("a value of " + exact_number(value) +
                     " does not fit this format's single precision; write .vtp or .csv");
  }
  return narrow;
}

// ---- .tck and .trk -------------------------------------------------------------------------------------

/// A stand-in for an image that holds the lines: voxels of a power of two, so that its corner costs no
/// rounding of its own.
TractogramImage image_around(const std::vector<Line>& lines) {
  Box bounds;
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) {
      if (is_finite(point.position)) bounds.include(point.position);
    }
  }
  TractogramImage image{.voxels = Index3{1}, .axes = Mat3{1.0}, .origin = Vec3{0.5}};
  if (bounds.empty()) return image;
  const Vec3 size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  constexpr int kVoxelsLog2 = 8;
  const double voxel = longest > 0.0 ? std::ldexp(1.0, std::ilogb(longest) + 1 - kVoxelsLog2) : 1.0;
  const Vec3 corner = glm::floor(bounds.lower / voxel) * voxel;
  image.axes = Mat3{voxel};
  image.origin = corner + Vec3{0.5 * voxel};
  for (int axis = 0; axis < 3; ++axis) {
    image.voxels[axis] = static_cast<int>(std::floor((bounds.upper[axis] - corner[axis]) / voxel)) + 1;
  }
  return image;
}

/// The lines in single precision, with the numbers of their points and why they end.
Tractogram tractogram_of(const std::vector<Line>& lines, const TractogramImage* image) {
  Tractogram packed;
  packed.image = image != nullptr ? *image : image_around(lines);
  packed.of_points = {
      {.name = "time", .values = {}}, {.name = "speed", .values = {}}, {.name = "error", .values = {}}};
  packed.of_lines = {{.name = "termination", .values = {}}};
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) {
      packed.points.emplace_back(single(point.position.x), single(point.position.y),
                                 single(point.position.z));
      packed.of_points[0].values.push_back(single(point.time));
      packed.of_points[1].values.push_back(single(point.speed));
      packed.of_points[2].values.push_back(single(point.error));
    }
    packed.starts.push_back(packed.points.size());
    packed.of_lines[0].values.push_back(static_cast<float>(line.end));
  }
  return packed;
}

void write_tck_lines(OutputFile& file, const std::vector<Line>& lines, PointColumns,
                     const TractogramImage* image) {
  write_tck(file, tractogram_of(lines, image));
}

/// With further numbers for each point.
Tractogram packed_with(const std::vector<Line>& lines, PointColumns columns, const TractogramImage* image) {
  Tractogram packed = tractogram_of(lines, image);
  for (const PointColumn& column : columns) {
    auto& values =
        packed.of_points.emplace_back(Tractogram::Column{.name = column.name, .values = {}}).values;
    values.reserve(column.values.size());
    for (const double value : column.values) values.push_back(single(value));
  }
  return packed;
}

void write_trk_lines(OutputFile& file, const std::vector<Line>& lines, PointColumns columns,
                     const TractogramImage* image) {
  write_trk(file, packed_with(lines, columns, image));
}

void write_trx_lines(OutputFile& file, const std::vector<Line>& lines, PointColumns columns,
                     const TractogramImage* image) {
  write_trx(file, packed_with(lines, columns, image));
}

// ---- .csv ----------------------------------------------------------------------------------------------

void write_csv(OutputFile& file, const std::vector<Line>& lines, PointColumns columns,
               const TractogramImage*) {
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
        row += exact_number(value);
      }
      row += ",";
      row += name_of(line.end);
      for (const PointColumn& column : columns) (row += ',') += exact_number(column.values[row_number]);
      ++row_number;
      row += "\n";
      file.write(row);
    }
  }
}

using Writer = void (*)(OutputFile&, const std::vector<Line>&, PointColumns, const TractogramImage*);

Writer writer_for(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  if (ending == ".vtp") return write_vtp;
  if (ending == ".tck") return write_tck_lines;
  if (ending == ".trk") return write_trk_lines;
  if (ending == ".trx") return write_trx_lines;
  if (ending == ".csv") return write_csv;
  throw usage_error(path.string() + ": lines are written as .vtp, .tck, .trk, .trx or .csv, not '" + ending +
                    "'");
}

}  // namespace

void check_line_output(const std::filesystem::path& path, bool overwrite) {
  (void)writer_for(path);
  check_output(path, overwrite);
}

void write_lines(const std::filesystem::path& path, const std::vector<Line>& lines, bool overwrite,
                 std::span<const PointColumn> columns, const TractogramImage* image) {
  const Writer write = writer_for(path);
  for (const PointColumn& column : columns) PALPATE_CHECK(column.values.size() == count_points(lines));
  OutputFile file(path, overwrite);
  try {
    write(file, lines, columns, image);
  } catch (const Error& error) {
    const bool named = std::string_view(error.what()).substr(0, path.string().size()) == path.string();
    if (named) throw;
    throw Error(error.code(), path.string() + ": " + error.what());
  }
  file.finish();
}

}  // namespace palpate
