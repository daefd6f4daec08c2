// One cell of every kind in every dialect of meshes: kind x dialect x type of number x byte order, written here by
// formula and byte by byte, so that no reader or writer vouches for another. The table is part of loaders/README.md:
//   PALPATE_WRITE_PAGES=1 ctest --preset release -R loaders/flow_matrix_test

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/cell_kinds.h"
#include "tests/loaders/hdf5_file.h"
#include "tests/loaders/plot3d_cells.h"
#include "tests/loaders/solver_cells.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

struct Variant {
  bool wide = true;  ///< double precision
  bool big = false;
};
using Files = std::vector<std::pair<std::string, std::string>>;
struct Dialect {
  const char *format, *encoding, *name;
  std::vector<Variant> variants;
  std::function<std::string(const CellKind&, const Variant&)> write;  ///< empty where it has no such file
  bool has_values = true;
  /// Further files: their names and content.
  std::function<Files(const CellKind&, const Variant&)> beside = {};
};

std::string number_bytes(double value, const Variant& variant) {
  return variant.wide ? raw(value, variant.big) : raw(static_cast<float>(value), variant.big);
}

std::string legacy_file(const CellKind& kind, const Variant& variant, bool binary) {
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  const std::string type = variant.wide ? "double" : "float";
  const auto vectors = [&](const std::vector<Vec3>& all) {
    std::string out;
    for (const Vec3& v : all) {
      if (!binary) out += words_of(v) + "\n";
      for (int i = 0; binary && i < 3; ++i) out += number_bytes(v[i], {variant.wide, true});
    }
    return out + (binary ? "\n" : "");
  };
  const auto whole = [&](std::size_t n) {
    return binary ? raw(static_cast<std::int32_t>(n), true) : std::to_string(n) + " ";
  };
  std::string out = std::string("# vtk DataFile Version 3.0\nt\n") + (binary ? "BINARY" : "ASCII") +
                    "\nDATASET UNSTRUCTURED_GRID\nPOINTS " + std::to_string(nodes.size()) + " " + type +
                    "\n" + vectors(nodes) + "CELLS 1 " + std::to_string(nodes.size() + 1) + "\n" +
                    whole(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) out += whole(i);
  out += "\nCELL_TYPES 1\n" + whole(kind.vtk) + "\nPOINT_DATA " + std::to_string(nodes.size()) +
         "\nVECTORS U " + type + "\n";
  std::vector<Vec3> values;
  for (const Vec3& x : nodes) values.push_back(flow_at(x));
  return out + vectors(values);
}

std::string base64(const std::string& bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t b = 0; b < 3; ++b)
      three = three << 8U | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    for (std::size_t c = 0; c < 4; ++c)
      text += i + c > bytes.size() ? '=' : kLetters[three >> (18U - 6U * c) & 63U];
  }
  return text;
}

enum class Xml { kAscii, kBase64, kAppended };

std::string vtu_file(const CellKind& kind, const Variant& variant, Xml how) {
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  std::string appended;
  const auto array = [&](const std::string& about, const std::string& words, const std::string& bytes) {
    const std::string counted = raw(static_cast<std::uint64_t>(bytes.size()), variant.big) + bytes;
    std::string out = "<DataArray " + about;
    if (how == Xml::kAscii) return out + " format=\"ascii\">" + words + "</DataArray>";
    if (how == Xml::kBase64) return out + " format=\"binary\">" + base64(counted) + "</DataArray>";
    out += " format=\"appended\" offset=\"" + std::to_string(appended.size()) + "\"/>";
    appended += counted;
    return out;
  };
  const std::string type = variant.wide ? "Float64" : "Float32";
  const auto vectors = [&](const std::string& name, const std::vector<Vec3>& all) {
    std::string words, bytes;
    for (const Vec3& v : all) {
      words += words_of(v) + " ";
      for (int i = 0; i < 3; ++i) bytes += number_bytes(v[i], variant);
    }
    return array("type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"3\"", words, bytes);
  };
  std::vector<Vec3> values;
  std::string order, order_bytes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    values.push_back(flow_at(nodes[i]));
    order += std::to_string(i) + " ";
    order_bytes += raw(static_cast<std::int64_t>(i), variant.big);
  }
  std::string out =
      std::string("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" header_type=\"UInt64\" byte_order=\"") +
      (variant.big ? "Big" : "Little") + "Endian\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
      std::to_string(nodes.size()) + "\" NumberOfCells=\"1\"><PointData>" + vectors("U", values) +
      "</PointData><Points>" + vectors("Points", nodes) + "</Points><Cells>";
  out += array("type=\"Int64\" Name=\"connectivity\"", order, order_bytes);
  out += array("type=\"Int64\" Name=\"offsets\"", std::to_string(nodes.size()),
               raw(static_cast<std::int64_t>(nodes.size()), variant.big));
  out += array("type=\"UInt8\" Name=\"types\"", std::to_string(kind.vtk),
               std::string(1, static_cast<char>(kind.vtk)));
  out += "</Cells></Piece></UnstructuredGrid>";
  if (how == Xml::kAppended) out += "<AppendedData encoding=\"raw\">_" + appended + "</AppendedData>";
  return out + "</VTKFile>";
}

std::vector<Dialect> dialects() {
  const std::vector<Variant> text{{true, false}, {false, false}}, one{{true, false}},
      orders{{true, false}, {true, true}};
  const std::vector<Variant> all{{true, false}, {false, false}, {true, true}, {false, true}};
  const auto vtu = [](Xml how) {
    return [how](const CellKind& kind, const Variant& variant) { return vtu_file(kind, variant, how); };
  };
  const auto gmsh = [](bool version4, bool binary) {
    return [=](const CellKind& kind, const Variant& variant) {
      return gmsh_file(kind, version4, binary, variant.big);
    };
  };
  const auto ensight = [](const char* encoding, bool binary, const std::vector<Variant>& variants) {
    return Dialect{
        "EnSight Gold",
        encoding,
        "a.case",
        variants,
        [=](const CellKind& kind, const Variant& v) { return ensight_files(kind, binary, v.big).flow_case; },
        true,
        [=](const CellKind& kind, const Variant& v) {
          const EnsightFiles files = ensight_files(kind, binary, v.big);
          return Files{{"a.geo", files.geometry}, {"a.vec", files.variable}};
        }};
  };
  const auto plot3d = [](const char* encoding, Plot3dKind values, bool text,
                         const std::vector<Variant>& variants) {
    return Dialect{"PLOT3D",
                   encoding,
                   "a.p3d",
                   variants,
                   [=](const CellKind& kind, const Variant&) { return plot3d_list(kind, values); },
                   true,
                   [=](const CellKind& kind, const Variant& v) {
                     return Files{{"a.xyz", plot3d_grid(kind, v.wide, v.big, text)},
                                  {"a.q", plot3d_values(kind, values, v.wide, v.big, text)}};
                   }};
  };
  const auto foam = [](const char* encoding, bool binary, const std::vector<Variant>& variants) {
    return Dialect{"OpenFOAM",
                   encoding,
                   "system/controlDict",
                   variants,
                   [=](const CellKind& kind, const Variant& v) {
                     return foam_files(kind, binary, v.wide).empty() ? "" : foam_control_file();
                   },
                   false,
                   [=](const CellKind& kind, const Variant& v) { return foam_files(kind, binary, v.wide); }};
  };
  return {
      {"VTK legacy", "ascii", "a.vtk", text,
       [](const CellKind& kind, const Variant& v) { return legacy_file(kind, v, false); }},
      {"VTK legacy", "binary", "a.vtk", text,
       [](const CellKind& kind, const Variant& v) { return legacy_file(kind, v, true); }},
      {"VTK XML", "ascii", "a.vtu", text, vtu(Xml::kAscii)},
      {"VTK XML", "base64", "a.vtu", all, vtu(Xml::kBase64)},
      {"VTK XML", "appended", "a.vtu", all, vtu(Xml::kAppended)},
      {"Gmsh 2.2", "ascii", "a.msh", one, gmsh(false, false)},
      {"Gmsh 2.2", "binary", "a.msh", orders, gmsh(false, true)},
      {"Gmsh 4.1", "ascii", "a.msh", one, gmsh(true, false)},
      {"Gmsh 4.1", "binary", "a.msh", orders, gmsh(true, true)},
      {"Tecplot", "ascii, POINT", "a.dat", one,
       [](const CellKind& kind, const Variant&) { return tecplot_file(kind, false); }},
      {"Tecplot", "ascii, BLOCK", "a.dat", one,
       [](const CellKind& kind, const Variant&) { return tecplot_file(kind, true); }},
      {"AVS UCD", "ascii", "a.inp", one, [](const CellKind& kind, const Variant&) { return ucd_file(kind); }},
      {"SU2", "mesh alone", "a.su2", one, [](const CellKind& kind, const Variant&) { return su2_file(kind); },
       false},
      {"GAMBIT", "mesh alone", "a.neu", one,
       [](const CellKind& kind, const Variant&) { return gambit_file(kind); }, false},
      {"CGNS", "HDF5", "a.cgns", text,
       [](const CellKind& kind, const Variant& v) { return cgns_file(kind, v.wide); }},
      {"VTKHDF", "1 and 2", "a.vtkhdf", text,
       [](const CellKind& kind, const Variant& v) { return vtkhdf_file(kind, v.wide); }},
      {"XDMF", "text", "a.xdmf", text,
       [](const CellKind& kind, const Variant& v) { return xdmf_file(kind, v.wide, false); }},
      {"XDMF", "HDF5", "a.xdmf", text,
       [](const CellKind& kind, const Variant& v) { return xdmf_file(kind, v.wide, true); }, true,
       [](const CellKind& kind, const Variant& v) {
         return Files{{"a.h5", xdmf_numbers(kind, v.wide)}};
       }},
      {"Fluent", "mesh alone", "a.cas", one,
       [](const CellKind& kind, const Variant&) { return fluent_file(kind); }, false,
       [](const CellKind&, const Variant&) {
         return Files{{"a.dat", fluent_values_file()}};
       }},
      {"Fluent", "binary, mesh alone", "a.cas", text,
       [](const CellKind& kind, const Variant& v) { return fluent_in_binary(kind, v.wide); }, false,
       [](const CellKind&, const Variant&) {
         return Files{{"a.dat", fluent_values_file()}};
       }},
      plot3d("binary", Plot3dKind::kSolution, false, all),
      plot3d("text", Plot3dKind::kSolution, true, one),
      plot3d("OVERFLOW", Plot3dKind::kOverflow, false, all),
      plot3d("functions, binary", Plot3dKind::kFunctions, false, all),
      plot3d("functions, text", Plot3dKind::kFunctions, true, one),
      {"STAR-CD", "mesh alone", "a.vrt", one,
       [](const CellKind& kind, const Variant&) { return star_vertices_file(kind); }, false,
       [](const CellKind& kind, const Variant&) {
         return Files{{"a.cel", star_cells_file(kind)}};
       }},
      ensight("ascii", false, one),
      ensight("C Binary", true, orders),
      {"EnSight 6", "ascii", "a.case", one,
       [](const CellKind& kind, const Variant&) { return ensight6_files(kind).flow_case; }, true,
       [](const CellKind& kind, const Variant&) {
         const EnsightFiles files = ensight6_files(kind);
         return Files{{"a.geo", files.geometry}, {"a.vec", files.variable}};
       }},
      {"Exodus II", "netCDF", "a.exo", text,
       [](const CellKind& kind, const Variant& v) { return exodus_file(kind, v.wide); }},
      foam("ascii, values of cells", false, one),
      foam("binary, values of cells", true, text)};
}

/// The edges of a cell by the places of their ends, lower one first.
std::set<std::array<double, 6>> edges_of(const CellKind& kind, const std::vector<Vec3>& corners) {
  std::set<std::array<double, 6>> out;
  for (const std::vector<int>& face : faces_of(kind)) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      Vec3 a = corners[static_cast<std::size_t>(face[i])];
      Vec3 b = corners[static_cast<std::size_t>(face[(i + 1) % face.size()])];
      if (std::tuple(a.x, a.y, a.z) > std::tuple(b.x, b.y, b.z)) std::swap(a, b);
      out.insert({a.x, a.y, a.z, b.x, b.y, b.z});
    }
  }
  return out;
}

/// A grid of one cell as a mesh.
UnstructuredTopology mesh_of(const StructuredTopology& grid) {
  UnstructuredTopology mesh;
  mesh.positions = grid.positions;
  mesh.connectivity = {0, 1, 3, 2, 4, 5, 7, 6};
  mesh.offsets = {0, 8};
  mesh.types = {12};
  return mesh;
}

/// Empty: the cell is of that kind, its nodes lie between its corners as VTK has them, and have their values.
std::string wrong(const std::filesystem::path& file, const CellKind& kind, bool has_values) {
  Source source = Source::open({{file}, {}});
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  DataSet block = source.read(names).at(0);
  if (const auto* const grid = std::get_if<StructuredTopology>(&block.topology);
      grid != nullptr && grid->points == Index3{2})
    block.topology = mesh_of(*grid);
  const auto* const mesh = std::get_if<UnstructuredTopology>(&block.topology);
  if (mesh == nullptr || mesh->types.size() != 1) return "no single cell";
  if (mesh->types[0] != kind.vtk) return "a cell of type " + std::to_string(mesh->types[0]);
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  if (mesh->connectivity.size() != nodes.size()) return std::to_string(mesh->connectivity.size()) + " nodes";
  // Some formats list faces, and VTK's readers turn some cells the other way: the corners may come in any order that
  // makes the same cell, and then the nodes between them in that order.
  std::vector<Vec3> there, values;
  const DataArray* const velocity = block.find(
      block.find("Momentum", Association::kPoint) != nullptr ? "Momentum" : "Velocity", Association::kPoint);
  const DataArray* const named = block.find("U", Association::kPoint);
  const DataArray* const whole = velocity != nullptr ? velocity
                                 : named != nullptr  ? named
                                                     : block.find("U_", Association::kPoint);
  for (const std::int64_t id : mesh->connectivity) {
    const auto point = static_cast<std::size_t>(id);
    there.emplace_back(mesh->positions.at(point, 0), mesh->positions.at(point, 1),
                       mesh->positions.at(point, 2));
    Vec3 v{NAN};
    for (int c = 0; c < 3; ++c) {
      const DataArray* const part = block.find(std::string(1, "UVW"[c]), Association::kPoint);
      if (whole != nullptr && whole->components == 3) v[c] = whole->at(point, c);
      if (whole != nullptr && whole->components == 1 && part != nullptr) v[c] = part->at(point);
    }
    values.push_back(v);
  }
  for (std::size_t i = 0; i < there.size(); ++i) {
    const auto due =
        std::ranges::min_element(nodes, {}, [&](const Vec3& x) { return glm::distance(x, there[i]); });
    if (glm::distance(*due, there[i]) > 1e-6) return "node " + std::to_string(i) + " lies elsewhere";
    there[i] = *due;  // which has all digits
    // Texts of EnSight have six digits.
    if (has_values && !(glm::distance(values[i], flow_at(*due)) <= 1e-5))
      return "node " + std::to_string(i) + " has another value";
  }
  if (edges_of(kind, there) != edges_of(kind, nodes)) return "other edges";
  const std::size_t corners = kind.corners.size();
  for (std::size_t i = corners; i < there.size(); ++i) {
    Vec3 middle{0.0};
    for (const int corner : kind.vtk_nodes[i - corners]) {
      middle +=
          there[static_cast<std::size_t>(corner)] / static_cast<double>(kind.vtk_nodes[i - corners].size());
    }
    if (glm::distance(middle, there[i]) > 1e-6) return "node " + std::to_string(i) + " lies between others";
  }
  return {};
}

std::string table_of(const std::vector<std::vector<std::string>>& rows) {
  std::string text = "| format | encoding |";
  for (const CellKind& kind : cell_kinds()) text += std::string(" ") + kind.name + " |";
  text += "\n|---|---|";
  for (std::size_t k = 0; k < cell_kinds().size(); ++k) text += "---|";
  text += "\n";
  for (const auto& row : rows) {
    text += "|";
    for (const std::string& cell : row) text += " " + cell + " |";
    text += "\n";
  }
  return text;
}

TEST(FlowMatrix, EveryKindOfCellIsRightOrRefusedInEveryDialect) {
  const TempFolder folder;
  std::vector<std::vector<std::string>> rows;
  for (const Dialect& dialect : dialects()) {
    std::vector<std::string> row{dialect.format, dialect.encoding};
    for (const CellKind& kind : cell_kinds()) {
      std::size_t right = 0, refused = 0;
      for (const Variant& variant : dialect.variants) {
        const std::string content = dialect.write(kind, variant);
        if (content.empty()) continue;
        const auto put = [&folder](const std::string& name, const std::string& bytes) {
          std::filesystem::create_directories(folder.path(name).parent_path());
          return folder.write(name, bytes);
        };
        const auto path = put(dialect.name, content);
        if (dialect.beside) {
          for (const auto& [name, text] : dialect.beside(kind, variant)) (void)put(name, text);
        }
        const std::string what = std::string(dialect.format) + ", " + dialect.encoding + ", " + kind.name +
                                 (variant.wide ? ", double" : ", float") +
                                 (variant.big ? ", big" : ", little");
        try {
          const std::string fault = wrong(path, kind, dialect.has_values);
          EXPECT_EQ(fault, "") << what;
          right += fault.empty() ? 1 : 0;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ExitCode::kBadInput) << what << ": " << error.what();
          ++refused;
          RecordProperty(what, error.what());
        }
      }
      EXPECT_TRUE(right == 0 || refused == 0)
          << dialect.format << ", " << dialect.encoding << ", " << kind.name;
      row.emplace_back(right > 0 ? "right" : refused > 0 ? "refused" : "-");
    }
    rows.push_back(std::move(row));
  }

  const auto page = source_folder() / "loaders" / "README.md";
  std::string text = read_file(page);
  const std::string begin = "<!-- cells -->\n", end = "<!-- end of cells -->\n";
  const std::size_t from = text.find(begin), to = text.find(end);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  const std::string there = text.substr(from + begin.size(), to - from - begin.size());
  if (std::getenv("PALPATE_WRITE_PAGES") != nullptr) {
    std::ofstream(page) << text.replace(from + begin.size(), there.size(), table_of(rows));
  } else {
    EXPECT_EQ(there, table_of(rows)) << "write it again: PALPATE_WRITE_PAGES=1 ctest -R flow_matrix_test";
  }
}

}  // namespace
}  // namespace palpate::test
