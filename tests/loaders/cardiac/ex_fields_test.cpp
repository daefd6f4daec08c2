// EX models with more than coordinates and fibres: other fields, groups, strings, places in elements.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "loaders/cardiac/ex/ex_times.h"
#include "tests/support/temp_folder.h"

namespace palpate::ex {
namespace {

/// A field of `components` in the nodes' header.
std::string node_field(int number, const std::string& name, int components, const std::string& type) {
  std::string text = std::to_string(number) + ") " + name + ", field, " + type +
                     ", #Components=" + std::to_string(components) + "\n";
  for (int c = 1; c <= components; ++c) text += " " + std::to_string(c) + ". #Values=1 (value)\n";
  return text;
}

std::string element_field(int number, const std::string& name, int components) {
  std::string text = std::to_string(number) + ") " + name +
                     ", field, rectangular cartesian, real, #Components=" + std::to_string(components) + "\n";
  for (int c = 1; c <= components; ++c) {
    text += " " + std::to_string(c) +
            ". l.Lagrange*l.Lagrange*l.Lagrange, no modify, standard node based.\n  #Nodes=8\n";
    for (int n = 1; n <= 8; ++n) text += "  " + std::to_string(n) + ". #Values=1\n   Value labels: value\n";
  }
  return text;
}

double pressure(const Vec3& x) { return 80.0 + 3.0 * x.x - 5.0 * x.y + 7.0 * x.z + 11.0 * x.x * x.y * x.z; }

/// Two boxes beside each other along x, from 0 to 2: nodes 1 to 12, elements 1 and 2.
std::string nodes(const std::string& more_fields, int more_count,
                  const std::function<std::string(int, const Vec3&)>& more_values) {
  std::string text = "!#nodeset nodes\nShape. Dimension=0\n#Fields=" + std::to_string(1 + more_count) + "\n" +
                     node_field(1, "coordinates", 3, "rectangular cartesian, real") + more_fields;
  for (int n = 0; n < 12; ++n) {
    const Vec3 x{n % 3, n / 3 % 2, n / 6};
    text += "Node: " + std::to_string(n + 1) + "\n " + std::to_string(x.x) + " " + std::to_string(x.y) + " " +
            std::to_string(x.z) + "\n" + more_values(n + 1, x);
  }
  return text;
}

std::string elements(const std::string& more_fields, int more_count) {
  std::string text =
      "!#mesh mesh3d, dimension=3, nodeset=nodes\nShape. Dimension=3, line*line*line\n#Scale factor sets=0\n"
      "#Nodes=8\n#Fields=" +
      std::to_string(1 + more_count) + "\n" + element_field(1, "coordinates", 3) + more_fields;
  for (int e = 0; e < 2; ++e) {
    text += "Element: " + std::to_string(e + 1) + "\n Nodes:\n";
    for (const int n : {1, 2, 4, 5, 7, 8, 10, 11}) text += " " + std::to_string(n + e);
    text += "\n";
  }
  return text;
}

const char* const kHead = "EX Version: 2\nRegion: /\n";

SampledModel sampled(const std::string& text) {
  const test::TempFolder folder;
  Model model;
  read_ex_file(folder.write("a.exf", text).string(), model);
  return sample(model, 3, "a.exf");
}

void expect_pressure(const SampledModel& model, const char* name = "pressure") {
  const DataArray* array = model.mesh.find(name, Association::kPoint);
  ASSERT_NE(array, nullptr);
  ASSERT_EQ(array->tuples, 7U * 4U * 4U);
  const auto& positions = std::get<UnstructuredTopology>(model.mesh.topology).positions;
  for (std::size_t p = 0; p < array->tuples; ++p)
    EXPECT_NEAR(array->at(p), pressure({positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)}), 1e-5);
}

bool says(const SampledModel& model, const std::string& words) {
  return std::any_of(model.notes.begin(), model.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string pressure_text(const Vec3& x) { return " " + std::to_string(pressure(x)) + "\n"; }

// A trilinear field is its own interpolation in boxes of side one: x y z is linear along each axis.
TEST(ExFields, FieldsOfNumbersAreSampledUnderTheirNames) {
  for (const char* name : {"pressure", "layer", "surface"}) {
    const SampledModel model = sampled(
        kHead +
        nodes(node_field(2, name, 1, "rectangular cartesian, real") + node_field(3, "velocity", 3, "real"), 2,
              [](int, const Vec3& x) { return pressure_text(x) + " 1 2 3\n"; }) +
        elements(element_field(2, name, 1) + element_field(3, "velocity", 3), 2));
    // What it would be taken for has another name.
    expect_pressure(model, std::string(name) == "pressure" ? name : ("field " + std::string(name)).c_str());
    const DataArray* velocity = model.mesh.find("velocity", Association::kPoint);
    ASSERT_NE(velocity, nullptr);
    EXPECT_EQ(velocity->components, 3);
    EXPECT_EQ(velocity->at(17, 2), 3.0);
  }
}

/// The values of `name` at the points where x is in [from, to], all of which must be what `value` says; NaN: no data.
void expect_values(const SampledModel& model, const std::string& name, double from, double to,
                   const std::function<double(const Vec3&)>& value) {
  const DataArray* array = model.mesh.find(name, Association::kPoint);
  ASSERT_NE(array, nullptr) << name;
  const auto& positions = std::get<UnstructuredTopology>(model.mesh.topology).positions;
  int found = 0;
  for (std::size_t p = 0; p < array->tuples; ++p) {
    const Vec3 x{positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)};
    if (x.x < from || x.x > to) continue;
    ++found;
    const double wanted = value(x);
    if (std::isnan(wanted)) {
      EXPECT_TRUE(std::isnan(array->at(p))) << x.x;
    } else {
      EXPECT_NEAR(array->at(p), wanted, 1e-5) << x.x;
    }
  }
  EXPECT_GT(found, 0);
}

const auto kNoData = [](const Vec3&) { return std::nan(""); };

TEST(ExFields, ThoseOfAPartHaveNoDataElsewhereAndThatIsSaid) {
  // Node 12 is of the second element alone, and has no pressure.
  std::string text = kHead + nodes("", 0, [](int, const Vec3&) { return std::string(); });
  text += "Shape. Dimension=0\n#Fields=1\n" + node_field(1, "pressure", 1, "real");
  for (int n = 1; n < 12; ++n) text += "Node: " + std::to_string(n) + "\n 5\n";
  const SampledModel model = sampled(text + elements(element_field(2, "pressure", 1), 1));
  expect_values(model, "pressure", 0.0, 1.0, [](const Vec3&) { return 5.0; });
  expect_values(model, "pressure", 1.1, 2.0, kNoData);
  EXPECT_TRUE(says(model, "\"pressure\": no data in 1 of 2 elements"));

  // Of the second element, which comes later: where both meet it has data.
  std::string second =
      kHead +
      nodes(node_field(2, "pressure", 1, "real"), 1, [](int, const Vec3& x) { return pressure_text(x); }) +
      elements("", 0);
  second = second.substr(0, second.find("Element: 2"));
  std::string rest = elements(element_field(2, "pressure", 1), 1);
  rest.erase(rest.find("Element: 1"), rest.find("Element: 2") - rest.find("Element: 1"));
  const SampledModel other = sampled(second + rest);
  expect_values(other, "pressure", 1.0, 2.0, pressure);
  expect_values(other, "pressure", 0.0, 0.9, kNoData);

  const SampledModel nodes_alone = sampled(
      kHead +
      nodes(node_field(2, "pressure", 1, "real"), 1, [](int, const Vec3& x) { return pressure_text(x); }) +
      elements("", 0));
  EXPECT_TRUE(says(nodes_alone, "\"pressure\" of nodes left out"));
}

TEST(ExFields, FibresOfAPartAreThoseOfThatPart) {
  const std::string whole = kHead +
                            nodes(node_field(2, "fibres", 3, "fibre, real"), 1,
                                  [](int, const Vec3&) { return std::string(" 0.5 0 0\n"); }) +
                            elements("", 0);
  std::string rest = elements(element_field(2, "fibres", 3), 1);
  rest.erase(rest.find("Element: 1"), rest.find("Element: 2") - rest.find("Element: 1"));
  const SampledModel model = sampled(whole.substr(0, whole.find("Element: 2")) + rest);
  expect_values(model, "fibre angle", 1.0, 2.0, [](const Vec3&) { return 0.5 * 180.0 / 3.14159265358979; });
  expect_values(model, "fibre angle", 0.0, 0.9, kNoData);
  expect_values(model, "fibre", 1.0, 2.0, [](const Vec3&) { return std::cos(0.5); });
  expect_values(model, "fibre", 0.0, 0.9, kNoData);
  EXPECT_TRUE(says(model, "fibres: no data in 1 of 2 elements"));
}

/// Values at places of the elements' own: `intervals` along each axis, 0 where they are constant.
std::string grid_field(int number, const std::string& name, int intervals, bool by_element = false) {
  const std::string basis = intervals > 0 ? "l.Lagrange" : "constant";
  std::string text = std::to_string(number) + ") " + name +
                     ", field, rectangular cartesian, real, #Components=1\n 1. " + basis + "*" + basis + "*" +
                     basis + ", no modify, " + (by_element ? "element" : "grid") + " based.\n";
  const std::string n = std::to_string(intervals);
  if (!by_element) text += " #xi1=" + n + ", #xi2=" + n + ", #xi3=" + n + "\n";
  return text;
}

/// Two boxes as elements(), with values behind their nodes.
std::string elements_with_values(const std::string& fields, int count, int intervals,
                                 const std::function<double(const Vec3&)>& value) {
  std::string text = elements(fields, count);
  for (int e = 2; e >= 1; --e) {
    std::string values = " Values :\n";
    for (int k = 0; k <= intervals; ++k)
      for (int j = 0; j <= intervals; ++j)
        for (int i = 0; i <= intervals; ++i) {
          const double h = intervals > 0 ? 1.0 / intervals : 0.0;
          values += " " + std::to_string(value(Vec3{e - 1 + h * i, h * j, h * k}));
        }
    const std::size_t at = text.find("Nodes:\n", text.find("Element: " + std::to_string(e)));
    text.insert(text.find('\n', at + 8) + 1, values + "\n");
  }
  return text;
}

TEST(ExFields, ValuesAtGridPointsOfElementsAreThoseThere) {
  const std::string points = kHead + nodes("", 0, [](int, const Vec3&) { return std::string(); });
  // Linear between grid points: places of the sampling by threes are grid points, or half-way.
  const auto bent = [](const Vec3& x) { return 100.0 * x.x + x.y * x.y - 3.0 * x.z; };
  const SampledModel three = sampled(points + elements_with_values(grid_field(2, "vm", 3), 1, 3, bent));
  expect_values(three, "vm", 0.0, 2.0, bent);
  EXPECT_FALSE(says(three, "--refine"));
  const SampledModel one = sampled(points + elements_with_values(grid_field(2, "vm", 1), 1, 1, pressure));
  expect_values(one, "vm", 0.0, 2.0, pressure);
  const SampledModel five = sampled(points + elements_with_values(grid_field(2, "vm", 5), 1, 5, bent));
  EXPECT_TRUE(
      says(five, "\"vm\" has values at 6 places along an axis of an element, 4 are sampled: --refine 5"));

  // One value an element is one of its cells, and what jumps between elements is said.
  for (const bool by_element : {false, true}) {
    const SampledModel flat = sampled(points + elements_with_values(grid_field(2, "tag", 0, by_element), 1, 0,
                                                                    [](const Vec3& x) { return 7.0 + x.x; }));
    const DataArray* tag = flat.mesh.find("tag", Association::kCell);
    ASSERT_NE(tag, nullptr);
    ASSERT_EQ(tag->tuples, 2U * 27U);
    EXPECT_EQ(tag->at(0), 7.0);
    EXPECT_EQ(tag->at(53), 8.0);
  }
  std::string jump = elements_with_values(grid_field(2, "vm", 1), 1, 1, [](const Vec3&) { return 1.0; });
  jump.replace(jump.rfind("1.000000"), 8, "2.000000");
  EXPECT_FALSE(says(sampled(points + jump), "disagree")) << "a corner of the second element alone";
  std::string step = elements_with_values(grid_field(2, "vm", 1), 1, 1, [](const Vec3&) { return 1.0; });
  const std::size_t second = step.find("1.000000", step.find("Values", step.find("Element: 2")));
  step.replace(second, 8, "2.000000");
  // x = 1: a corner that both have, with what falls off from it over the face: 4 x 4 places less those at zero.
  EXPECT_TRUE(says(sampled(points + step), "\"vm\": 9 points where elements disagree"));

  std::string short_by_one = elements_with_values(grid_field(2, "vm", 1), 1, 1, pressure);
  short_by_one.erase(short_by_one.rfind(' '));
  EXPECT_THROW((void)sampled(points + short_by_one), Error);
}

TEST(ExFields, ElementsThatAreListedAgainHaveTheFieldsOfBothLists) {
  const std::string points = kHead + nodes(node_field(2, "pressure", 1, "real"), 1,
                                           [](int, const Vec3& x) { return pressure_text(x); });
  // The other list has its own nodes, with the pressure alone, or with the coordinates again.
  const std::string alone =
      "Shape. Dimension=3, line*line*line\n#Scale factor sets=0\n#Nodes=8\n#Fields=1\n" +
      element_field(1, "pressure", 1) +
      "Element: 2\n Nodes:\n 2 3 5 6 8 9 11 12\nElement: 1\n Nodes:\n 1 2 4 5 7 8 10 11\n";
  for (const std::string& again : {alone, elements(element_field(2, "pressure", 1), 1)}) {
    const SampledModel model = sampled(points + elements("", 0) + again);
    expect_pressure(model);
    EXPECT_EQ(model.mesh.cell_count(), 2U * 27U) << "each element once";
  }
  std::string other = elements("", 0);
  other.replace(other.rfind(" 12"), 3, " 11");
  try {
    (void)sampled(points + elements("", 0) + other);
    ADD_FAILURE() << "two shapes of one element were accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("with another \"coordinates\""), std::string::npos)
        << error.what();
  }
}

TEST(ExFields, ElementsOfFewerDimensionsAreLeftOutWithAWord) {
  std::string faces =
      "!#mesh mesh2d, dimension=2, nodeset=nodes\nShape. Dimension=2, line*line\n#Scale factor sets=0\n"
      "#Nodes=4\n#Fields=1\n1) coordinates, coordinate, rectangular cartesian, real, #Components=3\n";
  for (const char* name : {"1", "2", "3"}) {
    faces +=
        " " + std::string(name) + ". l.Lagrange*l.Lagrange, no modify, standard node based.\n  #Nodes=4\n";
    for (int n = 1; n <= 4; ++n) faces += "  " + std::to_string(n) + ". #Values=1\n   Value labels: value\n";
  }
  faces += "Element: 1\n Nodes:\n 1 2 4 5\nElement: 2\n Nodes:\n 2 3 5 6\n";
  const std::string whole = kHead + nodes(node_field(2, "pressure", 1, "real"), 1,
                                          [](int, const Vec3& x) { return pressure_text(x); });
  const SampledModel model = sampled(whole + faces + elements(element_field(2, "pressure", 1), 1));
  expect_pressure(model);
  EXPECT_TRUE(says(model, "2 elements of 2 dimensions left out"));
}

TEST(ExFields, NodesThatAreListedAgainHaveTheFieldsOfBothLists) {
  std::string text = kHead + nodes("", 0, [](int, const Vec3&) { return std::string(); });
  text += "Shape. Dimension=0\n#Fields=1\n" + node_field(1, "pressure", 1, "real");
  for (int n = 0; n < 12; ++n)
    text += "Node: " + std::to_string(n + 1) + "\n" + pressure_text({n % 3, n / 3 % 2, n / 6});
  expect_pressure(sampled(text + elements(element_field(2, "pressure", 1), 1)));
}

TEST(ExFields, GroupsListTheirMembersAgain) {
  const std::string whole =
      kHead +
      nodes(node_field(2, "pressure", 1, "real"), 1, [](int, const Vec3& x) { return pressure_text(x); }) +
      elements(element_field(2, "pressure", 1), 1);
  const std::string members =
      "Group name: apex\n!#nodeset nodes\nShape. Dimension=0\n#Fields=0\nNode: 1\nNode: 2\n"
      "!#mesh mesh3d, dimension=3, nodeset=nodes\nShape. Dimension=3, line*line*line\n#Scale factor sets=0\n"
      "#Nodes=0\n#Fields=0\nElement: 2\n";
  expect_pressure(sampled(whole + members + members));
  // A list with the same values again says nothing new; one with others is a mistake.
  const std::string again = "Group name: rest\nShape. Dimension=0\n#Fields=1\n" +
                            node_field(1, "coordinates", 3, "rectangular cartesian, real") + "Node: 3\n 2 0 ";
  expect_pressure(sampled(whole + again + "0\n"));
  try {
    (void)sampled(whole + again + "1\n");
    ADD_FAILURE() << "two places of one node were accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("other values of \"coordinates\""), std::string::npos);
  }
}

TEST(ExFields, StringsAndPlacesInElementsAreLeftOutWithAWord) {
  for (const std::string& place : {std::string("1 0.25 0.5 0.75"), std::string("E 1 3 0.25 0.5 0.75"),
                                   std::string("/heart E 1 3 0.25 0.5 0.75")}) {
    for (const std::string& name :
         {std::string("apex"), std::string("\"apex of heart\""), std::string("'a, \"b\" c'"),
          std::string("\"one \\\" two\""), std::string("\"\n\""), std::string("\"Node: 7\"")}) {
      const auto values = [&](int, const Vec3& x) {
        return " " + place + "\n " + name + "\n" + pressure_text(x);
      };
      const std::string fields =
          "2) where, field, element_xi, #Components=1; mesh=mesh3d, #xi=3\n 1. #Values=1 (value)\n" +
          node_field(3, "name", 1, "string") + node_field(4, "pressure", 1, "real");
      const SampledModel model =
          sampled(kHead + nodes(fields, 3, values) + elements(element_field(2, "pressure", 1), 1));
      expect_pressure(model);
      EXPECT_TRUE(says(model, "name (string)")) << name;
      EXPECT_TRUE(says(model, "where (places in elements)")) << name;
    }
  }
  // Points of data, too.
  const SampledModel model = sampled(
      kHead + nodes("", 0, [](int, const Vec3&) { return std::string(); }) + elements("", 0) +
      "!#nodeset datapoints\nShape. Dimension=0\n#Fields=2\n1) where, field, element_xi, #Components=1; "
      "mesh=mesh3d, #xi=3\n 1. #Values=1 (value)\n" +
      node_field(2, "name", 1, "string") + "Node: 1\n1 0.5 0.5 0.5\n\"apex of heart\"\n");
  EXPECT_TRUE(says(model, "1 data point left out"));
  EXPECT_TRUE(says(model, "name (string)"));
}

// The pressure doubles with each file; its coordinates are there once, or in each.
TEST(ExFields, NodesWithOtherValuesAreOtherTimes) {
  const test::TempFolder folder;
  const auto state = [](double factor, double shift) {
    return kHead + nodes(node_field(2, "pressure", 1, "real"), 1, [=](int, const Vec3& x) {
             return " " + std::to_string(factor * pressure(x) + shift) + "\n";
           });
  };
  const auto first = folder.write("heart_2.exnode", state(1.0, 0.0)),
             third = folder.write("heart_10.exnode", state(4.0, 0.0)),
             second = folder.write("heart_5.exnode", state(2.0, 0.0)),
             mesh = folder.write("heart.exelem", kHead + elements(element_field(2, "pressure", 1), 1));
  const TimedModel timed = read_ex_files({third.string(), first.string(), second.string(), mesh.string()});
  EXPECT_EQ(timed.times, (std::vector<double>{2.0, 5.0, 10.0}));
  SampledModel model = sample(timed.model, 3, "heart");
  expect_pressure(model);
  const auto later = sample_later(timed, model.mesh, 3, ~std::uint64_t{0}, model.notes);
  ASSERT_EQ(later.size(), 2U);
  for (std::size_t t = 0; t < 2; ++t) {
    ASSERT_EQ(later[t].size(), 1U) << "what stays is not there again";
    EXPECT_EQ(later[t][0].name, "pressure");
    const DataArray& before = *model.mesh.find("pressure", Association::kPoint);
    for (std::size_t p = 0; p < before.tuples; ++p)
      EXPECT_NEAR(later[t][0].at(p), (t == 0 ? 2.0 : 4.0) * before.at(p), 1e-4);
  }
  EXPECT_TRUE(says(model, "what changes: pressure"));

  // A file with the same values says nothing new; names without numbers are counted; what moves is refused.
  const auto again = folder.write("again.exnode", state(1.0, 0.0)),
             other = folder.write("other.exnode", state(3.0, 1.0));
  EXPECT_TRUE(read_ex_files({first.string(), again.string(), mesh.string()}).times.empty());
  EXPECT_EQ(read_ex_files({first.string(), other.string(), mesh.string()}).times,
            (std::vector<double>{0.0, 1.0}));
  std::string moved = state(1.0, 0.0);
  moved.replace(moved.find("Node: 3\n 2.0"), 12, "Node: 3\n 3.0");
  const auto away = folder.write("heart_7.exnode", moved);
  const TimedModel moving = read_ex_files({first.string(), away.string(), mesh.string()});
  SampledModel still = sample(moving.model, 3, "heart");
  try {
    (void)sample_later(moving, still.mesh, 3, ~std::uint64_t{0}, still.notes);
    ADD_FAILURE() << "a mesh that moves was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("other coordinates"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::ex
