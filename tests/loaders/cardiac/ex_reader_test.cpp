// EX files of later versions, and what is said of mistakes in them.
#include "loaders/cardiac/ex/ex_reader.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "loaders/cardiac/ex/ex_element.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "tests/loaders/cardiac/ex_box.h"
#include "tests/support/temp_folder.h"

namespace palpate::ex {
namespace {

/// The unit box with x = xi_1^3, as Zinc writes it: nodes with a second version of x, Hermite polynomials
/// whose derivatives are halved and have a scale factor of two, lines and faces without fields, a group and
/// points of data. @param templates whether headers have names (version 3).
std::string labelled_box(bool templates) {
  std::string text = std::string("EX Version: ") + (templates ? "3" : "2") + "\nRegion: /\n!#nodeset nodes\n";
  if (templates) text += "Define node template: node1\n";
  text +=
      "Shape. Dimension=0\n#Fields=1\n1) coordinates, coordinate, rectangular cartesian, real, "
      "#Components=3\n"
      " x. #Values=3 (value(2),d/ds1)\n y. #Values=1 (value)\n z. #Values=1 (value)\n";
  if (templates) text += "Node template: node1\n";
  for (int n = 0; n < 8; ++n) {
    const bool end = (n & 1) != 0;
    text += "Node: " + std::to_string(n + 1) + "\n  99 " + (end ? "1 1.5" : "0 0") + "\n  " +
            std::to_string((n >> 1) & 1) + "\n  " + std::to_string(n >> 2) + "\n";
  }
  text +=
      "!#nodeset datapoints\nShape. Dimension=0\n#Fields=1\n1) mark, field, rectangular cartesian, real, "
      "#Components=1\n mark. #Values=1 (value)\nNode: 1\n 5\n";
  text +=
      "!#mesh mesh2d, dimension=2, face mesh=mesh1d, nodeset=nodes\nShape. Dimension=2, line*line\n"
      "#Scale factor sets=0\n#Nodes=0\n#Fields=0\nElement: 1\n Faces:\n 3 7 2 10\n";
  text += "!#mesh mesh3d, dimension=3, face mesh=mesh2d, nodeset=nodes\n";
  if (templates) text += "Define element template: element1\n";
  text +=
      "Shape. Dimension=3, line*line*line\n#Scale factor sets=1\n  scaling1, #Scale factors=1, "
      "identifiers=\"element_general(0)\"\n#Nodes=8\n#Fields=1\n1) coordinates, coordinate, rectangular "
      "cartesian, real, #Components=3\n x. c.Hermite*l.Lagrange*l.Lagrange, no modify, standard node based. "
      "scale factor set=scaling1\n  #Nodes=8\n";
  for (int n = 1; n <= 8; ++n) {
    const std::string node = std::to_string(n);
    if (n == 3) {  // parts of one corner may stand by themselves, and a slope of zero may be none
      text +=
          "  3. #Values=1\n   Value labels: value(2)\n   Scale factor indices: 0\n  0. #Values=1\n   Value "
          "labels: zero\n   Scale factor indices: 0\n";
      continue;
    }
    text += "  " + node + ". #Values=2\n   Value labels: value(2) d/ds1\n   Scale factor indices: 0 1\n";
  }
  for (const char* component : {"y", "z"}) {
    text += std::string(" ") + component +
            ". l.Lagrange*l.Lagrange*l.Lagrange, no modify, standard node based.\n  #Nodes=8\n";
    for (int n = 1; n <= 8; ++n) text += "  " + std::to_string(n) + ". #Values=1\n   Value labels: value\n";
  }
  if (templates) text += "Element template: element1\n";
  return text +
         "Element: 1\n Faces:\n 1 2 3 4 5 -1\n Nodes:\n 1 2 3 4 5 6 7 8\n Scale factors:\n 2.0\n"
         "Group name: all\n!#nodeset nodes\nNode group:\n1..8\n";
}

TEST(ExReader, LaterVersionsNameTheirParametersByLabels) {
  const test::TempFolder folder;
  for (const bool templates : {false, true}) {
    Model model;
    read_ex_file(folder.write("a.exf", labelled_box(templates)).string(), model);
    ASSERT_EQ(model.elements.size(), 1U) << templates;
    EXPECT_EQ(model.nodes.size(), 8U);
    const Element& element = model.elements.front();
    const ElementShape shape(model, element, field_of(model, element, "coordinates"), nullptr, "box");
    for (const Vec3& xi : {Vec3{0.5, 0.25, 0.75}, Vec3{0.2, 0.0, 1.0}, Vec3{1.0}}) {
      EXPECT_LT(glm::distance(shape.at(xi).x, Vec3(xi.x * xi.x * xi.x, xi.y, xi.z)), 1e-14) << templates;
      EXPECT_NEAR(shape.at(xi).tangents[0].x, 3.0 * xi.x * xi.x, 1e-14);
    }
    EXPECT_NEAR(exact_volume(model, 5, "box"), 1.0, 1e-12);
  }
}

TEST(ExReader, WhatLaterVersionsHaveMoreIsNamed) {
  const test::TempFolder folder;
  const std::string good = labelled_box(true);
  for (const auto& [what, by, word] : std::vector<std::array<std::string, 3>>{
           {"labels: value(2) d/ds1", "labels: value(2) d/ds1+d/ds2", "sums"},
           {"  1. #Values=2", "  1+2. #Values=2", "sums"},
           {"labels: value(2) d/ds1", "labels: value(3) d/ds1", "version 3"},
           {"labels: value(2) d/ds1", "labels: value(2) d/ds9", "d/ds9"},
           {"#Values=3 (value(2),d/ds1)", "#Values=4 (value(2),d/ds1)", "lists 3"},
           {"indices: 0 1", "indices: 0 1*2", "one scale factor"},
           {"scale factor set=scaling1", "scale factor set=scaling7", "scaling7"},
           {"  1. #Values=2", "  1. #Values=90", "more values"},
           {"Element template: element1\nElement: 1", "Element template: other\nElement: 1", "template"},
           {"3. #Values=1\n   Value labels: value(2)", "0. #Values=1\n   Value labels: value(2)", "zero"}}) {
    std::string text = good;
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
    const auto file = folder.write("b.exf", text);
    try {
      Model model;
      read_ex_file(file.string(), model);
      (void)sample(model, 2, file.string());
      ADD_FAILURE() << by << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("b.exf"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

TEST(ExReader, MistakesAreNamedWithFileAndLine) {
  const test::TempFolder folder;
  std::array<Vec3, 8> places{};
  const std::string nodes = node_file("rectangular cartesian", places, {0.0});
  const std::string elements = element_file("rectangular cartesian");
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::runtime_error("no " + what);
    return text.replace(at, what.size(), by);
  };
  const std::pair<std::string, std::string> wrong[] = {
      {replaced(nodes, "Node: 3", "Node: 2"), elements},
      {replaced(nodes, "Value index= 2", "Value index= 5"), elements},
      {replaced(nodes, "#Components=3", "#Components=99999999999"), elements},
      {nodes.substr(0, nodes.size() - 12), elements},
      {nodes, replaced(elements, "l.Lagrange*l.Lagrange*l.Lagrange", "l.simplex(2)*l.simplex*l.Lagrange")},
      {nodes, replaced(elements, "Dimension=3", "Dimension=3, polygon(5;2)*polygon*line")},
      {nodes, replaced(elements, " 1 2 3 4 5 6 7 8", " 1 2 3 4 5 6 7 88")},
      {nodes, replaced(elements, " 1 2 3 4 5 6 7 8", " 1 2 3 4")},
      {nodes, replaced(elements, "Value indices:     1", "Value indices:     2")},
      {nodes, replaced(elements, "Scale factor indices:   0", "Scale factor indices:   9")},
      {nodes, replaced(elements, "Value indices:     1", "Value indices     1")},
      {nodes, replaced(elements, "rectangular cartesian", "oblate spheroidal")},
      {nodes, replaced(elements, "#Nodes= 8", "#Nodes= nan")},
      {"EX Version: 9\n" + nodes, elements},
      {nodes, "word salad\n"}};
  for (const auto& [n, e] : wrong) {
    try {
      (void)sample(made(folder, n, e), 2, (folder.path() / "a.exelem").string());
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("a.ex"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace palpate::ex
