#include "common/load/write/write_mesh.h"

#include <charconv>
#include <string>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/load/load.h"
#include "common/load/write/vtp_appendix.h"
#include "common/load/write/write_tractogram.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr std::uint8_t kTetrahedron = 10;  // VTK's number

/// VTK XML, UnstructuredGrid, raw appended data.
void write_vtu(OutputFile& file, std::span<const Vec3> points,
               std::span<const std::array<std::uint32_t, 4>> cells, std::span<const MeshColumn> columns,
               const std::optional<Vec3>& long_axis) {
  const std::uint64_t per_point = points.size() * sizeof(double);
  const std::uint64_t per_cell = cells.size() * sizeof(std::int64_t);
  VtpAppendix appendix;
  std::string head =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n";
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
        head += appendix.declare("Float64", column.name, static_cast<int>(column.components),
                                 column.values.size() * sizeof(double));
  };
  declare(false);
  head += "</PointData>\n<CellData>\n";
  declare(true);
  head += "</CellData>\n<Points>\n" + appendix.declare("Float64", "Points", 3, 3 * per_point);
  head += "</Points>\n<Cells>\n" + appendix.declare("Int64", "connectivity", 1, 4 * per_cell);
  head += appendix.declare("Int64", "offsets", 1, per_cell);
  head += appendix.declare("UInt8", "types", 1, cells.size());
  head += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  file.write(head);
  for (const bool of_cells : {false, true}) {
    for (const MeshColumn& column : columns) {
      if (column.of_cells != of_cells) continue;
      file.write_number(std::uint64_t{column.values.size() * sizeof(double)});
      for (const double value : column.values) file.write_number(value);
    }
  }
  file.write_number(3 * per_point);
  for (const Vec3& x : points)
    for (int axis = 0; axis < 3; ++axis) file.write_number(x[axis]);
  file.write_number(4 * per_cell);
  for (const auto& cell : cells)
    for (const std::uint32_t p : cell) file.write_number(static_cast<std::int64_t>(p));
  file.write_number(per_cell);
  for (std::size_t c = 1; c <= cells.size(); ++c) file.write_number(static_cast<std::int64_t>(4 * c));
  file.write_number(static_cast<std::uint64_t>(cells.size()));
  for (std::size_t c = 0; c < cells.size(); ++c) file.write_number(kTetrahedron);
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
