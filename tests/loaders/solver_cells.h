/// Files of one cell (cell_kinds.h) in the dialects of solvers: EnSight 6, Exodus II and OpenFOAM.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tests/loaders/cell_kinds.h"

namespace palpate::test {

/// EnSight 6 in text: one list of nodes for all parts, rows of x, y, z, six values a line. EnSight User Manual, ch. 9.
inline EnsightFiles ensight6_files(const CellKind& kind) {
  EnsightFiles out = ensight_files(kind, false, false);
  if (out.flow_case.empty()) return {};
  const std::string gold = "type: ensight gold";
  out.flow_case.replace(out.flow_case.find(gold), gold.size(), "type: ensight");
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  const auto number = [](double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%12.5e", value);
    return std::string(text.data());
  };
  const auto whole = [](std::size_t n) {
    constexpr std::size_t kWidth = 8;
    const std::string text = std::to_string(n);
    return std::string(kWidth - text.size(), ' ') + text;
  };
  // The name of the cell is the line before its count.
  const std::string& geometry = out.geometry;
  const std::size_t name = geometry.find_first_of("htp", geometry.rfind("e+") + 4);
  const std::string shape = geometry.substr(name, geometry.find('\n', name) - name);
  std::string text =
      "one cell\nby formula\nnode id assign\nelement id assign\ncoordinates\n" + whole(nodes.size()) + "\n";
  std::string values = "U\n";
  std::size_t on_line = 0;
  for (const Vec3& x : nodes) {
    for (int c = 0; c < 3; ++c) {
      text += number(x[c]);
      values += number(flow_at(x)[c]);
      if (++on_line % 6 == 0) values += "\n";
    }
    text += "\n";
  }
  text += "part 1\nfluid\n" + shape + "\n" + whole(1) + "\n";
  for (std::size_t n = 1; n <= nodes.size(); ++n) text += whole(n);
  out.geometry = text + "\n";
  out.variable = values + "\n";
  return out;
}

/// An OpenFOAM case: its files by their names, the mesh and U of the cell. OpenFOAM User Guide, "Mesh description".
inline std::vector<std::pair<std::string, std::string>> foam_files(const CellKind& kind, bool binary,
                                                                   bool wide) {
  constexpr int kLastLinear = 14;
  if (kind.vtk > kLastLinear) return {};
  const std::vector<Vec3> nodes = places(kind, {});
  const std::vector<std::vector<int>> faces = faces_of(kind);
  const auto head = [&](const char* type, const char* object) {
    return std::string("FoamFile\n{\n version 2.0;\n format ") + (binary ? "binary" : "ascii") +
           ";\n arch \"LSB;label=32;scalar=" + (wide ? "64" : "32") + "\";\n class " + type + ";\n object " +
           object + ";\n}\n";
  };
  const auto vector = [&](const Vec3& v) {
    std::string out = binary ? "" : "(";
    for (int c = 0; c < 3; ++c)
      out += !binary ? exact_number(v[c]) + " "
             : wide  ? raw(v[c], false)
                     : raw(static_cast<float>(v[c]), false);
    return out + (binary ? "" : ")\n");
  };
  const auto list = [&](const std::vector<int>& all) {
    std::string out = std::to_string(all.size()) + "\n(";
    for (const int n : all)
      out += binary ? raw(static_cast<std::int32_t>(n), false) : std::to_string(n) + " ";
    return out + ")\n";
  };
  std::string points = head("vectorField", "points") + std::to_string(nodes.size()) + "\n(";
  for (const Vec3& x : nodes) points += vector(x);
  std::string shapes;
  std::vector<int> begins{0}, corners;
  for (const std::vector<int>& face : faces) {
    corners.insert(corners.end(), face.begin(), face.end());
    begins.push_back(static_cast<int>(corners.size()));
    shapes += std::to_string(face.size()) + "(";
    for (const int corner : face) shapes += std::to_string(corner) + " ";
    shapes += ")\n";
  }
  shapes = binary ? list(begins) + list(corners) : std::to_string(faces.size()) + "\n(\n" + shapes + ")\n";
  const std::string n = std::to_string(faces.size());
  return {
      {"constant/polyMesh/points", points + ")\n"},
      {"constant/polyMesh/faces", head(binary ? "faceCompactList" : "faceList", "faces") + shapes},
      {"constant/polyMesh/owner", head("labelList", "owner") + list(std::vector<int>(faces.size(), 0))},
      {"constant/polyMesh/neighbour", head("labelList", "neighbour") + list({})},
      {"constant/polyMesh/boundary", head("polyBoundaryMesh", "boundary") +
                                         "1\n(\nborder\n{\n type patch;\n nFaces " + n +
                                         ";\n startFace 0;\n}\n)\n"},
      {"1/U",
       head("volVectorField", "U") +
           "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform (1 2 3);\nboundaryField\n{\nborder\n{\n type "
           "zeroGradient;\n}\n}\n"}};
}
inline std::string foam_control_file() {
  return "FoamFile\n{\n version 2.0;\n format ascii;\n class dictionary;\n object controlDict;\n}\nstartFrom "
         "startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\n";
}

/// Exodus II in a netCDF classic file with offsets of 64 bits: one block, one time. L. A. Schoof and V. R. Yarberry,
/// EXODUS II: A Finite Element Data Model, SAND92-2137.
inline std::string exodus_file(const CellKind& kind, bool wide) {
  constexpr std::size_t kNodesOfHex27 = 27;
  const char* const shape = kind.vtk == 10   ? "TETRA4"
                            : kind.vtk == 12 ? "HEX8"
                            : kind.vtk == 13 ? "WEDGE6"
                            : kind.vtk == 14 ? "PYRAMID5"
                            : kind.vtk == 24 ? "TETRA10"
                            : kind.vtk == 25 ? "HEX20"
                            : kind.vtk == 26 ? "WEDGE15"
                            : kind.vtk == 27 ? "PYRAMID13"
                            : kind.vtk == 29 ? "HEX27"
                                             : nullptr;
  if (shape == nullptr) return {};
  // Edges along the axis come before those of the top, as in CGNS; of 27 nodes the middle comes before the faces.
  std::vector<NodeOf> order = kind.cgns_nodes.empty() ? kind.vtk_nodes : kind.cgns_nodes;
  if (kind.corners.size() + order.size() == kNodesOfHex27) {
    order.resize(12);
    order.insert(order.end(), {{0, 1, 2, 3, 4, 5, 6, 7},
                               {0, 1, 2, 3},
                               {4, 5, 6, 7},
                               {0, 3, 4, 7},
                               {1, 2, 5, 6},
                               {0, 1, 4, 5},
                               {2, 3, 6, 7}});
  }
  const std::vector<Vec3> nodes = places(kind, order);
  constexpr std::uint32_t kChar = 2, kInt = 4, kFloat = 5, kDouble = 6;
  const std::uint32_t real = wide ? kDouble : kFloat;
  const auto number = [](std::uint32_t value) { return raw(value, true); };
  const auto padded = [](std::string bytes) {
    bytes.append((4 - bytes.size() % 4) % 4, '\0');
    return bytes;
  };
  const auto name_of = [&](const std::string& name) {
    return number(static_cast<std::uint32_t>(name.size())) + padded(name);
  };
  const auto attribute = [&](const std::string& name, std::uint32_t type, std::uint32_t count,
                             const std::string& bytes) {
    return name_of(name) + number(type) + number(count) + padded(bytes);
  };
  const auto reals = [&](const std::vector<double>& all) {
    std::string out;
    for (const double value : all) out += wide ? raw(value, true) : raw(static_cast<float>(value), true);
    return out;
  };
  enum Dimension : std::uint32_t {
    kTime,
    kString,
    kDim,
    kNodes,
    kElements,
    kBlocks,
    kInBlock,
    kPerElement,
    kValues
  };
  struct Variable {
    std::string name;
    std::vector<std::uint32_t> dimensions;
    std::uint32_t type;
    std::string bytes;
    std::string attributes;  ///< as they stand in the header, with their number
  };
  const std::string none = number(0) + number(0);
  std::vector<Variable> variables{
      {"eb_status", {kBlocks}, kInt, number(1), none},
      {"eb_prop1", {kBlocks}, kInt, number(1), number(12) + number(1) + attribute("name", kChar, 2, "ID")}};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> all;
    for (const Vec3& x : nodes) all.push_back(x[axis]);
    variables.push_back({std::string("coord") + "xyz" [axis], { kNodes }, real, reals(all), none});
  }
  std::string connect;
  for (std::uint32_t i = 1; i <= nodes.size(); ++i) connect += number(i);
  const std::string type = shape;
  variables.push_back({"connect1",
                       {kInBlock, kPerElement},
                       kInt,
                       connect,
                       number(12) + number(1) +
                           attribute("elem_type", kChar, static_cast<std::uint32_t>(type.size()), type)});
  constexpr std::size_t kName = 33;
  std::string names;
  for (const char* const name : {"U_x", "U_y", "U_z"}) {
    std::string one = name;
    one.resize(kName, '\0');
    names += one;
  }
  variables.push_back({"name_nod_var", {kValues, kString}, kChar, names, none});
  variables.push_back({"time_whole", {kTime}, real, reals({0.0}), none});
  for (int c = 0; c < 3; ++c) {
    std::vector<double> all;
    for (const Vec3& x : nodes) all.push_back(flow_at(x)[c]);
    variables.push_back({"vals_nod_var" + std::to_string(c + 1), {kTime, kNodes}, real, reals(all), none});
  }
  const auto count = static_cast<std::uint32_t>(nodes.size());
  const std::vector<std::pair<std::string, std::uint32_t>> dimensions{
      {"time_step", 0},  {"len_string", kName}, {"num_dim", 3},        {"num_nodes", count},
      {"num_elem", 1},   {"num_el_blk", 1},     {"num_el_in_blk1", 1}, {"num_nod_per_el1", count},
      {"num_nod_var", 3}};
  const auto header = [&](const std::vector<std::size_t>& begins) {
    constexpr std::uint32_t kDimensionList = 10, kVariableList = 11, kAttributeList = 12;
    std::string out = std::string("CDF\2", 4) + number(1) + number(kDimensionList) +
                      number(static_cast<std::uint32_t>(dimensions.size()));
    for (const auto& [name, length] : dimensions) out += name_of(name) + number(length);
    out += number(kAttributeList) + number(5) + attribute("api_version", kFloat, 1, raw(5.1F, true)) +
           attribute("version", kFloat, 1, raw(5.1F, true)) +
           attribute("floating_point_word_size", kInt, 1, number(wide ? 8 : 4)) +
           attribute("file_size", kInt, 1, number(1)) + attribute("title", kChar, 8, "one cell");
    out += number(kVariableList) + number(static_cast<std::uint32_t>(variables.size()));
    for (std::size_t v = 0; v < variables.size(); ++v) {
      out += name_of(variables[v].name) + number(static_cast<std::uint32_t>(variables[v].dimensions.size()));
      for (const std::uint32_t d : variables[v].dimensions) out += number(d);
      out += variables[v].attributes + number(variables[v].type) +
             number(static_cast<std::uint32_t>(padded(variables[v].bytes).size())) +
             raw(static_cast<std::uint64_t>(begins[v]), true);
    }
    return out;
  };
  std::vector<std::size_t> begins(variables.size(), 0);
  std::size_t at = header(begins).size();
  for (std::size_t v = 0; v < variables.size(); ++v) {
    begins[v] = at;
    at += padded(variables[v].bytes).size();
  }
  std::string out = header(begins);
  for (const Variable& variable : variables) out += padded(variable.bytes);
  return out;
}

}  // namespace palpate::test
