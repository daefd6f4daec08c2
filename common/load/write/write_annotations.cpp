#include "common/load/write/write_annotations.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Quoted, with quotes inside doubled (RFC 4180).
std::string csv_word(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_of(std::span<const Annotation> annotations) {
  std::string text = "annotation,kind,label,value,point,x,y,z\n";
  for (std::size_t i = 0; i < annotations.size(); ++i) {
    const Annotation& each = annotations[i];
    const std::string head = std::to_string(i) + "," + std::string(name_of(each.kind)) + "," +
                             csv_word(each.label) + "," + csv_number(measure_of(each)) + ",";
    for (std::size_t p = 0; p < each.points.size(); ++p) {
      text += head + std::to_string(p);
      for (int a = 0; a < 3; ++a) (text += ",") += exact_number(each.points[p][a]);
      text += "\n";
    }
  }
  return text;
}

/// VTK's arrays of text hold the codes of its characters, each word ended by a zero.
std::string codes(const std::string& text) {
  std::string all;
  for (const char c : text) all += std::to_string(static_cast<unsigned char>(c)) + " ";
  return all + "0\n";
}

/// Cells of one kind.
struct Cells {
  std::string connectivity, offsets;
  std::size_t count = 0, ends = 0;
};

std::string element(const char* name, const Cells& cells) {
  return std::string("<") + name + ">\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n" +
         cells.connectivity +
         "\n</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n" + cells.offsets +
         "\n</DataArray>\n</" + name + ">\n";
}

std::string vtp_of(std::span<const Annotation> annotations) {
  std::array<Cells, 3> cells;  // vertices, lines, polygons: VTK numbers cells in this order
  std::string points, kinds, labels, values;
  std::size_t point_count = 0;
  for (std::size_t sort = 0; sort < cells.size(); ++sort) {
    for (const Annotation& each : annotations) {
      const std::size_t own = each.kind == AnnotationKind::kPoint  ? 0
                              : each.kind == AnnotationKind::kArea ? 2
                                                                   : 1;
      if (own != sort) continue;
      for (const Vec3& x : each.points) {
        points += exact_number(x.x) + " " + exact_number(x.y) + " " + exact_number(x.z) + "\n";
        cells[sort].connectivity += std::to_string(point_count++) + " ";
      }
      cells[sort].ends += each.points.size();
      cells[sort].offsets += std::to_string(cells[sort].ends) + " ";
      ++cells[sort].count;
      kinds += codes(std::string(name_of(each.kind)));
      labels += codes(each.label);
      values += csv_number(measure_of(each)) + " ";
    }
  }
  const auto count = [&](std::size_t sort) { return std::to_string(cells[sort].count); };
  const std::string tuples = "\" NumberOfTuples=\"" + std::to_string(annotations.size()) +
                             "\" NumberOfComponents=\"1\" format=\"ascii\">\n";
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
         std::to_string(point_count) + "\" NumberOfVerts=\"" + count(0) + "\" NumberOfLines=\"" + count(1) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + count(2) +
         "\">\n<CellData Scalars=\"value\">\n<DataArray type=\"Float64\" Name=\"value\" format=\"ascii\">\n" +
         values + "\n</DataArray>\n<DataArray type=\"String\" Name=\"kind" + tuples + kinds +
         "</DataArray>\n<DataArray type=\"String\" Name=\"label" + tuples + labels +
         "</DataArray>\n</CellData>\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
         "format=\"ascii\">\n" +
         points + "</DataArray>\n</Points>\n" + element("Verts", cells[0]) + element("Lines", cells[1]) +
         element("Polys", cells[2]) + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace

void check_annotation_output(const std::filesystem::path& path, bool overwrite) {
  const std::string ending = path.extension().string();
  if (ending != ".csv" && ending != ".vtp")
    throw usage_error(path.string() + ": annotations are written as .csv or .vtp");
  check_output(path, overwrite);
}

void write_annotations(const std::filesystem::path& path, std::span<const Annotation> annotations,
                       bool overwrite) {
  check_annotation_output(path, overwrite);
  OutputFile file(path, overwrite);
  file.write(path.extension() == ".csv" ? csv_of(annotations) : vtp_of(annotations));
  file.finish();
}

}  // namespace palpate
