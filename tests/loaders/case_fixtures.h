/// Small cases of solver formats, written by hand after the formats' own descriptions.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "tests/support/temp_folder.h"

namespace palpate::test {

/// Corners of the unit cube in the order of a hexahedron.
inline constexpr std::array<std::array<int, 3>, 8> kCube{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// The velocity at a corner of the cube in step `step`.
inline std::array<double, 3> cube_velocity(std::size_t corner, int step) {
  return {static_cast<double>(corner), 2.0 * static_cast<double>(corner) + step, -1.0};
}

/// EnSight Gold, text, one hexahedron, two time steps (0 and 0.5). EnSight User Manual, ch. 9.
inline std::filesystem::path write_ensight_text(const TempFolder& folder) {
  std::string geometry =
      "one cube\ntwo\nnode id off\nelement id off\npart\n         1\ncube\ncoordinates\n         8\n";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const auto& corner : kCube) geometry += " " + std::to_string(corner[axis]) + ".00000e+00\n";
  }
  geometry +=
      "hexa8\n         1\n         1         2         3         4         5         6         7         8\n";
  folder.write("cube.geo", geometry);
  for (int step = 0; step < 2; ++step) {
    std::string velocity = "velocity\npart\n         1\ncoordinates\n";
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t corner = 0; corner < 8; ++corner) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%12.5e\n", cube_velocity(corner, step)[c]);
        velocity += text.data();
      }
    }
    folder.write("cube.vel" + std::to_string(step), velocity);
    folder.write(
        "cube.p" + std::to_string(step),
        "pressure\npart\n         1\nhexa8\n" + std::string(step == 0 ? " 7.00000e+00\n" : " 8.00000e+00\n"));
  }
  return folder.write("cube.case",
                      "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: cube.geo\n\nVARIABLE\nvector per node: "
                      "1 velocity cube.vel*\n"
                      "scalar per element: 1 pressure cube.p*\n\nTIME\ntime set: 1\nnumber of steps: "
                      "2\nfilename start number: 0\n"
                      "filename increment: 1\ntime values: 0.0 0.5\n");
}

/// EnSight Gold, binary, one hexahedron that claims `points` points.
inline std::filesystem::path write_ensight_binary(const TempFolder& folder, std::int32_t points) {
  std::string geometry;
  const auto text = [&geometry](std::string line) {
    line.resize(80, ' ');
    geometry += line;
  };
  const auto put = [&geometry](auto value) {
    std::array<char, sizeof(value)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(value));
    geometry.append(bytes.data(), bytes.size());
  };
  for (const char* line : {"C Binary", "one cube", "two", "node id off", "element id off", "part"})
    text(line);
  put(std::int32_t{1});
  text("cube");
  text("coordinates");
  put(points);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const auto& corner : kCube) put(static_cast<float>(corner[axis]));
  }
  text("hexa8");
  put(std::int32_t{1});
  for (std::int32_t corner = 1; corner <= 8; ++corner) put(corner);
  folder.write("binary.geo", geometry);
  return folder.write("binary.case", "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: binary.geo\n");
}

/// Numbers and lines of 80 characters as EnSight's binary files hold them.
class EnsightBinary {
 public:
  explicit EnsightBinary(bool big_endian) : swap_(big_endian != (std::endian::native == std::endian::big)) {}

  EnsightBinary& line(std::string text) {
    text.resize(80, ' ');
    bytes_ += text;
    return *this;
  }
  template <typename T>
  EnsightBinary& put(T value) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  bool swap_;
  std::string bytes_;
};

/// EnSight Gold, binary throughout, one hexahedron, three time steps (0, 0.5 and 2): a vector at the nodes
/// and a scalar a cell.
inline std::filesystem::path write_ensight_binary_steps(const TempFolder& folder, bool big_endian) {
  EnsightBinary geometry(big_endian);
  for (const char* text : {"C Binary", "one cube", "two", "node id off", "element id off", "part"})
    geometry.line(text);
  geometry.put(std::int32_t{1}).line("cube").line("coordinates").put(std::int32_t{8});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const auto& corner : kCube) geometry.put(static_cast<float>(corner[axis]));
  }
  geometry.line("hexa8").put(std::int32_t{1});
  for (std::int32_t corner = 1; corner <= 8; ++corner) geometry.put(corner);
  folder.write("b.geo", geometry.bytes());
  for (int step = 0; step < 3; ++step) {
    EnsightBinary velocity(big_endian);
    velocity.line("velocity").line("part").put(std::int32_t{1}).line("coordinates");
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t corner = 0; corner < 8; ++corner)
        velocity.put(static_cast<float>(cube_velocity(corner, step)[c]));
    }
    folder.write("b.vel" + std::to_string(step), velocity.bytes());
    EnsightBinary pressure(big_endian);
    pressure.line("pressure").line("part").put(std::int32_t{1}).line("hexa8");
    pressure.put(7.0F + static_cast<float>(step));
    folder.write("b.p" + std::to_string(step), pressure.bytes());
  }
  return folder.write(
      "b.case",
      "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: b.geo\n\nVARIABLE\nvector per node: 1 "
      "velocity b.vel*\nscalar per element: 1 pressure b.p*\n\nTIME\ntime set: 1\nnumber of "
      "steps: 3\nfilename start number: 0\nfilename increment: 1\ntime values: 0.0 0.5 2.0\n");
}

inline std::string foam_header(const std::string& type, const std::string& object) {
  return "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " + type + ";\n    object " + object +
         ";\n}\n";
}

/// OpenFOAM, one hexahedral cell, two times (0 and 0.5). OpenFOAM User Guide, "Mesh description".
inline std::filesystem::path write_openfoam(const TempFolder& folder) {
  std::string points = foam_header("vectorField", "points") + "8\n(\n";
  for (const auto& x : kCube)
    points += "(" + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + ")\n";
  folder.write("constant/polyMesh/points", points + ")\n");
  folder.write("constant/polyMesh/faces",
               foam_header("faceList", "faces") +
                   "6\n(\n4(0 3 2 1)\n4(4 5 6 7)\n4(0 1 5 4)\n4(2 3 7 6)\n4(0 4 7 3)\n4(1 2 6 5)\n)\n");
  folder.write("constant/polyMesh/owner", foam_header("labelList", "owner") + "6\n(\n0\n0\n0\n0\n0\n0\n)\n");
  folder.write("constant/polyMesh/neighbour", foam_header("labelList", "neighbour") + "0\n(\n)\n");
  folder.write("constant/polyMesh/boundary",
               foam_header("polyBoundaryMesh", "boundary") +
                   "1\n(\nwalls\n{\n type wall;\n nFaces 6;\n startFace 0;\n}\n)\n");
  for (const char* time : {"0", "0.5"}) {
    const std::string value = std::string(time) == "0" ? "(1 2 3)" : "(4 5 6)";
    folder.write(std::string(time) + "/U",
                 foam_header("volVectorField", "U") + "dimensions [0 1 -1 0 0 0 0];\ninternalField uniform " +
                     value + ";\nboundaryField\n{\n walls\n {\n type zeroGradient;\n }\n}\n");
  }
  folder.write("system/controlDict", foam_header("dictionary", "controlDict") +
                                         "startFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime "
                                         "0.5;\ndeltaT 0.5;\nwriteControl timeStep;\n"
                                         "writeInterval 1;\n");
  return folder.write("case.foam", "");
}

}  // namespace palpate::test
