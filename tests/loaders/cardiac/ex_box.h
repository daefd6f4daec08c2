/// EX models of one element, as text, whose answers are known.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "loaders/cardiac/ex/ex_reader.h"
#include "tests/support/temp_folder.h"

namespace palpate::ex {

inline const ElementField& field_of(const Model& model, const Element& element, const std::string& name) {
  for (const ElementField& field : model.element_headers[element.header])
    if (field.name == name) return field;
  throw std::runtime_error("no field " + name);
}

inline constexpr std::array<const char*, 3> kAngleNames{"fibre angle", "imbrication angle", "sheet angle"};

/// One element of unit size: coordinates in `system`, its eight nodes' values, their angles: one to three.
inline std::string node_file(const std::string& system, const std::array<Vec3, 8>& places,
                             const std::vector<double>& angles) {
  std::string text =
      " Group name: box\n #Fields=2\n 1) coordinates, coordinate, " + system +
      ", #Components=3\n   x. Value index= 1, #Derivatives= 0\n   y. Value index= 2, #Derivatives= "
      "0\n   z. Value index= 3, #Derivatives= 0\n 2) fibres, anatomical, fibre, #Components=" +
      std::to_string(angles.size()) + "\n";
  for (std::size_t a = 0; a < angles.size(); ++a)
    text += std::string("   ") + kAngleNames.at(a) + ". Value index= " + std::to_string(4 + a) +
            ", #Derivatives= 0\n";
  for (std::size_t n = 0; n < 8; ++n) {
    text += " Node: " + std::to_string(n + 1) + "\n";
    for (int c = 0; c < 3; ++c) text += " " + std::to_string(places[n][c]);
    for (const double angle : angles) text += "\n " + std::to_string(angle);
    text += "\n";
  }
  return text;
}
inline std::string component(const std::string& name, const std::string& modify = "no modify") {
  std::string text = "   " + name + ".  l.Lagrange*l.Lagrange*l.Lagrange, " + modify +
                     ", standard node based.\n     #Nodes= 8\n";
  for (int n = 1; n <= 8; ++n)
    text += "      " + std::to_string(n) +
            ".  #Values=1\n       Value indices:     1\n       Scale factor indices:   0\n";
  return text;
}
inline std::string element_file(const std::string& system, const std::string& modify = "no modify",
                                std::size_t angles = 1) {
  std::string of_angles;
  for (std::size_t a = 0; a < angles; ++a) of_angles += component(kAngleNames.at(a));
  return " Group name: box\n Shape.  Dimension=3\n #Scale factor sets= 0\n #Nodes= 8\n #Fields=2\n 1) "
         "coordinates, coordinate, " +
         system + ", #Components=3\n" + component("x") + component("y", modify) + component("z") +
         " 2) fibres, anatomical, fibre, #Components=" + std::to_string(angles) + "\n" + of_angles +
         " Element:     7 0 0\n   Faces:\n   0 1 0\n   Nodes:\n 1 2 3 4 5 6 7 8\n";
}

inline Model made(const test::TempFolder& folder, const std::string& nodes, const std::string& elements) {
  Model model;
  read_ex_file(folder.write("a.exnode", nodes).string(), model);
  read_ex_file(folder.write("a.exelem", elements).string(), model);
  return model;
}

}  // namespace palpate::ex
