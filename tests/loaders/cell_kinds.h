/// Cells of every kind by what the manuals say of their nodes, and files of one such cell in the dialects of meshes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "common/math/vec.h"

namespace palpate::test {

/// A node lies in the middle of some corners.
using NodeOf = std::vector<int>;

struct CellKind {
  const char* name;
  std::uint8_t vtk;
  int gmsh;
  std::vector<Vec3> corners;
  std::vector<NodeOf> vtk_nodes;   ///< behind the corners ("VTK File Formats", and its headers)
  std::vector<NodeOf> gmsh_nodes;  ///< behind the corners ("Node ordering" of its manual)
  const char* ucd;
  std::vector<int> ucd_corners;  ///< in its order
  int cgns = 0;
  std::vector<NodeOf> cgns_nodes = {};  ///< behind the corners (SIDS, "Unstructured grid element numbering")
};

inline const std::vector<CellKind>& cell_kinds() {
  const std::vector<Vec3> tet{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Vec3> hex{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                              {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<Vec3> wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const std::vector<Vec3> pyramid{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
  static const std::vector<NodeOf> kHexVtk{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                           {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  static const std::vector<NodeOf> kHexGmsh{{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3},
                                            {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  static const std::vector<NodeOf> kHexCgns{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5},
                                            {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
  static const std::vector<NodeOf> kWedgeCgns{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4},
                                              {2, 5}, {3, 4}, {4, 5}, {5, 3}};
  static const std::vector<NodeOf> kWedgeVtk{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                             {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  static const std::vector<NodeOf> kWedgeGmsh{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4},
                                              {2, 5}, {3, 4}, {3, 5}, {4, 5}};
  const auto with = [](std::vector<NodeOf> nodes, const std::vector<NodeOf>& more) {
    nodes.insert(nodes.end(), more.begin(), more.end());
    return nodes;
  };
  static const std::vector<CellKind> kKinds{
      {"tetrahedron", 10, 4, tet, {}, {}, "tet", {0, 1, 2, 3}, 10},
      {"hexahedron", 12, 5, hex, {}, {}, "hex", {4, 5, 6, 7, 0, 1, 2, 3}, 17},
      {"wedge", 13, 6, wedge, {}, {}, "prism", {0, 1, 2, 3, 4, 5}, 14},
      {"pyramid", 14, 7, pyramid, {}, {}, "pyr", {4, 0, 1, 2, 3}, 12},
      {"tetrahedron, 10 nodes",
       24,
       11,
       tet,
       {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
       {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {2, 3}, {1, 3}},
       nullptr,
       {},
       11,
       {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
      {"hexahedron, 20", 25, 17, hex, kHexVtk, kHexGmsh, nullptr, {}, 18, kHexCgns},
      {"hexahedron, 27",
       29,
       12,
       hex,
       with(kHexVtk, {{0, 3, 4, 7},
                      {1, 2, 5, 6},
                      {0, 1, 4, 5},
                      {2, 3, 6, 7},
                      {0, 1, 2, 3},
                      {4, 5, 6, 7},
                      {0, 1, 2, 3, 4, 5, 6, 7}}),
       with(kHexGmsh, {{0, 1, 2, 3},
                       {0, 1, 4, 5},
                       {0, 3, 4, 7},
                       {1, 2, 5, 6},
                       {2, 3, 6, 7},
                       {4, 5, 6, 7},
                       {0, 1, 2, 3, 4, 5, 6, 7}}),
       nullptr,
       {},
       19,
       with(kHexCgns, {{0, 1, 2, 3},
                       {0, 1, 4, 5},
                       {1, 2, 5, 6},
                       {2, 3, 6, 7},
                       {0, 3, 4, 7},
                       {4, 5, 6, 7},
                       {0, 1, 2, 3, 4, 5, 6, 7}})},
      {"wedge, 15", 26, 18, wedge, kWedgeVtk, kWedgeGmsh, nullptr, {}, 15, kWedgeCgns},
      {"wedge, 18",
       32,
       13,
       wedge,
       with(kWedgeVtk, {{0, 1, 3, 4}, {1, 2, 4, 5}, {2, 0, 5, 3}}),
       with(kWedgeGmsh, {{0, 1, 3, 4}, {0, 2, 3, 5}, {1, 2, 4, 5}}),
       nullptr,
       {},
       16,
       with(kWedgeCgns, {{0, 1, 3, 4}, {1, 2, 4, 5}, {2, 0, 5, 3}})},
      {"pyramid, 13",
       27,
       19,
       pyramid,
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
       {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}},
       nullptr,
       {},
       21,
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}}};
  return kKinds;
}

/// Where the nodes of a cell lie, its corners first, turned and sheared; exact in single precision.
inline std::vector<Vec3> places(const CellKind& kind, const std::vector<NodeOf>& nodes) {
  std::vector<Vec3> out = kind.corners;
  for (const NodeOf& node : nodes) {
    Vec3 sum{0.0};
    for (const int corner : node)
      sum += kind.corners[static_cast<std::size_t>(corner)] / static_cast<double>(node.size());
    out.push_back(sum);
  }
  for (Vec3& x : out)
    x = Vec3{1.0, -2.0, 0.5} + Vec3{2.0 * x.x + 0.5 * x.y, x.y + 0.25 * x.z, 1.5 * x.z - 0.25 * x.x};
  return out;
}

/// The flow at a node, exact in single precision.
inline Vec3 flow_at(const Vec3& x) { return {x.x + 2.0 * x.y, x.y - x.z, 1.0 + x.x * x.z}; }

template <typename T>
std::string raw(T value, bool big) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

inline std::string words_of(const Vec3& v) {
  return exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z);
}

/// One cell in Gmsh's file of that version. Nodes have the numbers 10, 20, ...; a surface lies in front of the cell.
inline std::string gmsh_file(const CellKind& kind, bool version4, bool binary, bool big) {
  const std::vector<Vec3> nodes = places(kind, kind.gmsh_nodes);
  const auto count = nodes.size();
  std::string out =
      std::string("$MeshFormat\n") + (version4 ? "4.1 " : "2.2 ") + (binary ? "1 8\n" : "0 8\n");
  if (binary) out += raw<std::int32_t>(1, big) + "\n";
  out += "$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"fluid\"\n$EndPhysicalNames\n$Nodes\n";
  const auto tag = [](std::size_t n) { return static_cast<std::int64_t>(10 * (n + 1)); };
  const auto whole = [&](std::int64_t n, bool wide) {
    if (!binary) return std::to_string(n) + " ";
    return wide ? raw<std::uint64_t>(static_cast<std::uint64_t>(n), big)
                : raw<std::int32_t>(static_cast<std::int32_t>(n), big);
  };
  const auto place = [&](const Vec3& x) {
    return binary ? raw(x.x, big) + raw(x.y, big) + raw(x.z, big) : words_of(x) + "\n";
  };
  const auto n = static_cast<std::int64_t>(count);
  if (version4) {
    out += whole(1, true) + whole(n, true) + whole(10, true) + whole(tag(count - 1), true);
    out += whole(3, false) + whole(1, false) + whole(0, false) + whole(n, true);
    for (std::size_t i = 0; i < count; ++i) out += whole(tag(i), true);
    for (const Vec3& x : nodes) out += place(x);
  } else {
    out += std::to_string(count) + "\n";
    for (std::size_t i = 0; i < count; ++i) out += whole(tag(i), false) + place(nodes[i]);
  }
  out += std::string(binary ? "\n" : "") + "$EndNodes\n$Elements\n";
  if (version4) {
    out += whole(2, true) + whole(2, true) + whole(1, true) + whole(7, true);
    out += whole(2, false) + whole(1, false) + whole(2, false) + whole(1, true);
    out += whole(1, true) + whole(10, true) + whole(20, true) + whole(30, true);
    out += whole(3, false) + whole(1, false) + whole(kind.gmsh, false) + whole(1, true) + whole(7, true);
    for (std::size_t i = 0; i < count; ++i) out += whole(tag(i), true);
  } else {
    out += "2\n";
    const auto element = [&](std::int64_t number, int type, std::size_t nodes_of) {
      out += binary ? whole(type, false) + whole(1, false) + whole(2, false) + whole(number, false)
                    : whole(number, false) + whole(type, false) + whole(2, false);
      out += whole(1, false) + whole(1, false);
      for (std::size_t i = 0; i < nodes_of; ++i) out += whole(tag(i), false);
      if (!binary) out += "\n";
    };
    element(1, 2, 3);
    element(7, kind.gmsh, count);
  }
  out += "\n$EndElements\n$NodeData\n1\n\"U\"\n1\n0.0\n3\n0\n3\n" + std::to_string(count) + "\n";
  for (std::size_t i = 0; i < count; ++i) out += whole(tag(i), false) + place(flow_at(nodes[i]));
  return out + std::string(binary ? "\n" : "") + "$EndNodeData\n";
}

/// One cell as Tecplot has it: a tetrahedron, or a brick some of whose corners coincide.
inline std::string tecplot_file(const CellKind& kind, bool block) {
  const std::vector<Vec3> nodes = places(kind, {});
  std::vector<int> corners;
  switch (kind.vtk) {
    case 10:
      corners = {0, 1, 2, 3};
      break;
    case 12:
      corners = {0, 1, 2, 3, 4, 5, 6, 7};
      break;
    case 13:
      corners = {0, 1, 2, 2, 3, 4, 5, 5};
      break;
    case 14:
      corners = {0, 1, 2, 3, 4, 4, 4, 4};
      break;
    default:
      return {};
  }
  std::string out =
      "TITLE = \"one cell\"\nVARIABLES = \"X\", \"Y\" \"Z\"\n\"U\" \"V\" \"W\"\n# a comment\nZONE T=\"a zone, named\"\n NODES=" +
      std::to_string(nodes.size()) +
      ", ELEMENTS=1, ZONETYPE=" + (kind.vtk == 10 ? "FETETRAHEDRON" : "FEBRICK") +
      "\n DATAPACKING=" + (block ? "BLOCK" : "POINT") + " DT=(SINGLE SINGLE SINGLE DOUBLE DOUBLE DOUBLE)\n";
  const auto number = [&](std::size_t node, int variable) {
    return exact_number(variable < 3 ? nodes[node][variable] : flow_at(nodes[node])[variable - 3]) + " ";
  };
  for (std::size_t i = 0; i < 6 * nodes.size(); ++i) {
    out += block ? number(i % nodes.size(), static_cast<int>(i / nodes.size()))
                 : number(i / 6, static_cast<int>(i % 6));
    if (i % 5 == 4) out += "\n";
  }
  out += "\n";
  for (const int corner : corners) out += std::to_string(corner + 1) + " ";
  return out + "\n";
}

inline std::string ucd_file(const CellKind& kind) {
  if (kind.ucd == nullptr) return {};
  const std::vector<Vec3> nodes = places(kind, {});
  std::string out = "# one cell\n" + std::to_string(nodes.size()) + " 1 3 0 0\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out += std::to_string(i + 5) + " " + words_of(nodes[i]) + "\n";
  out += std::string("9 1 ") + kind.ucd;
  for (const int corner : kind.ucd_corners) out += " " + std::to_string(corner + 5);
  out += "\n1 3\nU, m/s\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out += std::to_string(i + 5) + " " + words_of(flow_at(nodes[i])) + "\n";
  return out;
}

inline std::string su2_file(const CellKind& kind) {
  if (kind.vtk > 14) return {};
  const std::vector<Vec3> nodes = places(kind, {});
  std::string out = "% one cell\nNDIME= 3\nNELEM= 1\n" + std::to_string(kind.vtk);
  for (std::size_t i = 0; i < nodes.size(); ++i) out += " " + std::to_string(i);
  out += " 0\nNPOIN= " + std::to_string(nodes.size()) + "\n";
  for (std::size_t i = 0; i < nodes.size(); ++i) out += words_of(nodes[i]) + " " + std::to_string(i) + "\n";
  return out + "NMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5 0 1 2\n";
}

/// One cell of a GAMBIT neutral file, whose corners go along rows.
inline std::string gambit_file(const CellKind& kind) {
  int type = 0;
  std::vector<int> order;
  if (kind.vtk == 10) type = 6, order = {0, 1, 2, 3};
  if (kind.vtk == 12) type = 4, order = {0, 1, 3, 2, 4, 5, 7, 6};
  if (kind.vtk == 13) type = 5, order = {0, 1, 2, 3, 4, 5};
  if (kind.vtk == 14) type = 7, order = {0, 1, 3, 2, 4};
  if (type == 0) return {};
  const std::vector<Vec3> nodes = places(kind, {});
  std::string out =
      "        CONTROL INFO 2.3.16\n** GAMBIT NEUTRAL FILE\none cell\n"
      "PROGRAM:                Gambit     VERSION:  2.3.16\n Jan 2009\n"
      "     NUMNP     NELEM     NGRPS    NBSETS     NDFCD     NDFVL\n         " +
      std::to_string(nodes.size()) + " 1 1 0 3 3\nENDOFSECTION\n   NODAL COORDINATES 2.3.16\n";
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out += std::to_string(i + 1) + " " + words_of(nodes[i]) + "\n";
  out += "ENDOFSECTION\n      ELEMENTS/CELLS 2.3.16\n1 " + std::to_string(type) + " " +
         std::to_string(nodes.size());
  for (const int corner : order) out += " " + std::to_string(corner + 1);
  return out +
         "\nENDOFSECTION\n       ELEMENT GROUP 2.3.16\nGROUP:          1 ELEMENTS:          1 MATERIAL:          "
         "2 NFLAGS:          1\n                           fluid\n       0\n       1\nENDOFSECTION\n";
}

/// Outer faces by their corners, seen from outside against the clock.
inline std::vector<std::vector<int>> faces_of(const CellKind& kind) {
  switch (kind.corners.size()) {
    case 4:
      return {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
    case 8:
      return {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    case 6:
      return {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    case 5:
      return {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    default:
      return {};
  }
}

/// One cell of a Fluent case, by its faces, whose corners turn so that their normal leads into the cell.
inline std::string fluent_file(const CellKind& kind) {
  constexpr int kLastLinear = 14;
  if (kind.vtk > kLastLinear) return {};
  const std::vector<std::vector<int>> faces = faces_of(kind);
  const std::vector<Vec3> nodes = places(kind, {});
  const std::string n = std::to_string(nodes.size()),
                    f = std::to_string(faces.size());  // below ten: as in hex
  const int shape = kind.vtk == 10 ? 2 : kind.vtk == 12 ? 4 : kind.vtk == 13 ? 6 : 5;
  std::string out = "(0 \"one cell\")\n(2 3)\n(10 (0 1 " + n + " 0 3))\n(10 (1 1 " + n + " 1 3)(\n";
  for (const Vec3& x : nodes) out += words_of(x) + "\n";
  out += "))\n(12 (0 1 1 0))\n(12 (2 1 1 1 " + std::to_string(shape) + "))\n(13 (0 1 " + f +
         " 0))\n(13 (3 1 " + f + " 3 0)(\n";
  for (const std::vector<int>& face : faces) {
    out += std::to_string(face.size());
    for (auto corner = face.rbegin(); corner != face.rend(); ++corner)
      out += " " + std::to_string(*corner + 1);
    out += " 1 0\n";
  }
  return out + "))\n(45 (2 fluid fluid-2)())\n(45 (3 wall wall-3)())\n";
}
/// Its values: one of the cell.
inline std::string fluent_values_file() {
  return "(0 \"one cell\")\n(33 (1 1 1))\n(300 (111 2 1 0 0 1 1)(\n0.5\n))\n";
}

/// One cell in STAR-CD's files of vertices and cells.
inline std::string star_vertices_file(const CellKind& kind) {
  constexpr int kLastLinear = 14;
  if (kind.vtk > kLastLinear) return {};
  std::string out = "PROSTAR_VERTEX\n 4000 0 0 0 0 0 0 0\n";
  const std::vector<Vec3> nodes = places(kind, {});
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out += std::to_string(i + 1) + " " + words_of(nodes[i]) + "\n";
  return out;
}
inline std::string star_cells_file(const CellKind& kind) {
  const int shape = kind.vtk == 10 ? 13 : kind.vtk == 12 ? 11 : kind.vtk == 13 ? 12 : 14;
  std::string out = "PROSTAR_CELL\n 4000 0 0 0 0 0 0 0\n1 " + std::to_string(shape) + " " +
                    std::to_string(kind.corners.size()) + " 1 1\n1";
  for (std::size_t i = 0; i < kind.corners.size(); ++i) out += " " + std::to_string(i + 1);
  return out + "\n";
}

/// One cell of EnSight Gold, in text or "C Binary": what the case, geometry and variable files hold. EnSight User
/// Manual, "EnSight Gold": its quadratic elements have their nodes in VTK's order.
struct EnsightFiles {
  std::string flow_case, geometry, variable;
};
inline EnsightFiles ensight_files(const CellKind& kind, bool binary, bool big) {
  const char* const name = kind.vtk == 10   ? "tetra4"
                           : kind.vtk == 12 ? "hexa8"
                           : kind.vtk == 13 ? "penta6"
                           : kind.vtk == 14 ? "pyramid5"
                           : kind.vtk == 24 ? "tetra10"
                           : kind.vtk == 25 ? "hexa20"
                           : kind.vtk == 26 ? "penta15"
                           : kind.vtk == 27 ? "pyramid13"
                                            : nullptr;
  if (name == nullptr) return {};
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  const auto line = [&](std::string text) {
    constexpr std::size_t kLine = 80;
    if (!binary) return text + "\n";
    text.resize(kLine, ' ');
    return text;
  };
  const auto padded = [](std::string text, std::size_t width) {
    return std::string(width - std::min(width, text.size()), ' ') + text;
  };
  const auto whole = [&](std::size_t n, bool ends = true) {
    constexpr std::size_t kWidth = 10;
    return binary ? raw(static_cast<std::int32_t>(n), big)
                  : padded(std::to_string(n), kWidth) + (ends ? "\n" : "");
  };
  const auto columns = [&](const std::vector<Vec3>& all) {
    std::string out;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3& v : all) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%12.5e\n", v[axis]);
        out += binary ? raw(static_cast<float>(v[axis]), big) : text.data();
      }
    }
    return out;
  };
  EnsightFiles out;
  out.flow_case = "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\nvector per node: U a.vec\n";
  out.geometry = (binary ? line("C Binary") : "") + line("one cell") + line("by formula") +
                 line("node id off") + line("element id off") + line("part") + whole(1) + line("fluid") +
                 line("coordinates") + whole(nodes.size()) + columns(nodes) + line(name) + whole(1);
  for (std::size_t n = 1; n <= nodes.size(); ++n) out.geometry += whole(n, n == nodes.size());
  std::vector<Vec3> values;
  for (const Vec3& x : nodes) values.push_back(flow_at(x));
  out.variable = line("U") + line("part") + whole(1) + line("coordinates") + columns(values);
  return out;
}

}  // namespace palpate::test
