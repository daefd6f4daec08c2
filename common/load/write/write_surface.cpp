#include "common/load/write/write_surface.h"

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/load/write/vtp_appendix.h"
#include "common/load/write/write_tractogram.h"

namespace palpate {
namespace {

/// Strings as VTK XML has them in text: the numbers of their bytes, each string ended by a zero.
std::string words_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    for (const char letter : word) text += std::to_string(static_cast<unsigned char>(letter)) + " ";
    text += "0 ";
  }
  return text;
}

}  // namespace

void check_surface_output(const std::filesystem::path& path, bool overwrite) {
  const std::string ending = lower_ending(path);
  if (ending != ".vtp")
    throw usage_error(path.string() + ": surfaces are written as .vtp, not '" + ending + "'");
  check_output(path, overwrite);
}

void write_surface(const std::filesystem::path& path, std::span<const Vec3> points,
                   std::span<const std::array<std::uint32_t, 3>> triangles, const SurfaceLabels& labels,
                   std::span<const SurfaceColumn> columns, bool overwrite) {
  check_surface_output(path, overwrite);
  PALPATE_CHECK(labels.of.size() == triangles.size());
  for (const SurfaceColumn& column : columns) PALPATE_CHECK(column.values.size() == points.size());
  const std::uint64_t per_point = points.size() * sizeof(double);
  const std::uint64_t per_triangle = triangles.size() * sizeof(std::int64_t);
  VtpAppendix appendix;
  std::string head =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<Array type=\"String\" Name=\"" +
      labels.name + "_names\" NumberOfTuples=\"" + std::to_string(labels.words.size()) +
      "\" format=\"ascii\">" + words_text(labels.words) + "</Array>\n</FieldData>\n<Piece NumberOfPoints=\"" +
      std::to_string(points.size()) + "\" NumberOfPolys=\"" + std::to_string(triangles.size()) +
      "\">\n<PointData>\n";
  for (const SurfaceColumn& column : columns) head += appendix.declare("Float64", column.name, 1, per_point);
  head += "</PointData>\n<CellData>\n";
  head += appendix.declare("Int32", labels.name, 1, triangles.size() * sizeof(std::int32_t));
  head += "</CellData>\n<Points>\n" + appendix.declare("Float64", "Points", 3, 3 * per_point);
  head += "</Points>\n<Polys>\n" + appendix.declare("Int64", "connectivity", 1, 3 * per_triangle);
  head += appendix.declare("Int64", "offsets", 1, per_triangle);
  head += "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  OutputFile file(path, overwrite);
  file.write(head);
  for (const SurfaceColumn& column : columns) {
    file.write_number(per_point);
    for (const double value : column.values) file.write_number(value);
  }
  file.write_number(std::uint64_t{triangles.size() * sizeof(std::int32_t)});
  for (const std::int32_t label : labels.of) file.write_number(label);
  file.write_number(3 * per_point);
  for (const Vec3& x : points)
    for (int axis = 0; axis < 3; ++axis) file.write_number(x[axis]);
  file.write_number(3 * per_triangle);
  for (const auto& triangle : triangles)
    for (const std::uint32_t p : triangle) file.write_number(static_cast<std::int64_t>(p));
  file.write_number(per_triangle);
  for (std::size_t t = 1; t <= triangles.size(); ++t) file.write_number(static_cast<std::int64_t>(3 * t));
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.finish();
}

}  // namespace palpate
