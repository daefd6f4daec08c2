#include "common/load/write/write_mesh.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/load/load.h"
#include "common/load/write/packed_appendix.h"
#include "common/load/write/write_tractogram.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr std::uint8_t kTetrahedron = 10;  // VTK's number

/// VTK XML, UnstructuredGrid, packed appended data.
void write_vtu(OutputFile& file, std::span<const Vec3> points,
               std::span<const std::array<std::uint32_t, 4>> cells, std::span<const MeshColumn> columns,
               const std::optional<Vec3>& long_axis) {
  PackedAppendix arrays;
  std::string head =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
  if (long_axis)
    head += std::string("<FieldData>\n<DataArray type=\"Float64\" Name=\"") + kLongAxisArray +
            "\" NumberOfComponents=\"3\" NumberOfTuples=\"1\" format=\"ascii\">" +
            exact_number(long_axis->x) + " " + exact_number(long_axis->y) + " " + exact_number(long_axis->z) +
            "</DataArray>\n</FieldData>\n";
  head += "<Piece NumberOfPoints=\"" + std::to_string(points.size()) + "\" NumberOfCells=\"" +
          std::to_string(cells.size()) + "\">\n<PointData>\n";
  const auto declare = [&](bool of_cells) {
    for (const MeshColumn& column : columns)
      if (column.of_cells == of_cells)
        head += arrays.declare("Float64", column.name, static_cast<int>(column.components), column.values);
  };
  declare(false);
  head += "</PointData>\n<CellData>\n";
  declare(true);
  std::vector<double> x;
  x.reserve(3 * points.size());
  for (const Vec3& point : points) x.insert(x.end(), {point.x, point.y, point.z});
  head += "</CellData>\n<Points>\n" + arrays.declare("Float64", "Points", 3, x) + "</Points>\n<Cells>\n";
  std::vector<std::int64_t> numbers;
  numbers.reserve(4 * cells.size());
  for (const auto& cell : cells) numbers.insert(numbers.end(), cell.begin(), cell.end());
  head += arrays.declare("Int64", "connectivity", 1, numbers);
  numbers.clear();
  for (std::size_t c = 1; c <= cells.size(); ++c) numbers.push_back(static_cast<std::int64_t>(4 * c));
  head += arrays.declare("Int64", "offsets", 1, numbers);
  head += arrays.declare("UInt8", "types", 1, std::vector<std::uint8_t>(cells.size(), kTetrahedron));
  head += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  file.write(head);
  file.write(arrays.bytes());
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

void write_csv(OutputFile& file, std::span<const Vec3> points, std::span<const MeshColumn> columns) {
  std::string row = "x,y,z";
  for (const MeshColumn& column : columns) {
    for (std::size_t c = 1; !column.of_cells && c <= column.components; ++c)
      (row += ',') += column.components == 1 ? column.name : column.name + "_" + std::to_string(c);
  }
  file.write(row + "\n");
  for (std::size_t p = 0; p < points.size(); ++p) {
    row = exact_text(points[p]);
    for (const MeshColumn& column : columns)
      for (std::size_t c = 0; !column.of_cells && c < column.components; ++c)
        (row += ',') += exact_number(column.values[column.components * p + c]);
    file.write(row + "\n");
  }
}

}  // namespace

void check_mesh_output(const std::filesystem::path& path, bool overwrite) {
  const std::string ending = lower_ending(path);
  if (ending != ".vtu" && ending != ".csv")
    throw usage_error(path.string() + ": a mesh is written as .vtu or .csv, not '" + ending + "'");
  check_output(path, overwrite);
}

void write_mesh(const std::filesystem::path& path, std::span<const Vec3> points,
                std::span<const std::array<std::uint32_t, 4>> cells, std::span<const MeshColumn> columns,
                bool overwrite, const std::optional<Vec3>& long_axis) {
  check_mesh_output(path, overwrite);
  for (const MeshColumn& column : columns)
    PALPATE_CHECK(column.values.size() ==
                  column.components * (column.of_cells ? cells.size() : points.size()));
  OutputFile file(path, overwrite);
  if (lower_ending(path) == ".vtu") {
    write_vtu(file, points, cells, columns, long_axis);
  } else {
    write_csv(file, points, columns);
  }
  file.finish();
}

}  // namespace palpate
