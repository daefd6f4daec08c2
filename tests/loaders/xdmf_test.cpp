// XDMF: meshes and grids with values in text and in HDF5, times, and files that lead elsewhere.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "loaders/xdmf/xdmf_text.h"
#include "tests/loaders/hdf5_file.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::string item(const std::string& counts, const std::string& values, bool whole = false) {
  return "<DataItem Dimensions=\"" + counts + "\" NumberType=\"" + (whole ? "Int" : "Float") +
         "\" Precision=\"8\" Format=\"XML\">" + values + "</DataItem>";
}
std::string heavy(const std::string& counts, const std::string& place, bool whole = false) {
  return "<DataItem Dimensions=\"" + counts + "\" NumberType=\"" + (whole ? "Int" : "Float") +
         "\" Precision=\"8\" Format=\"HDF\">" + place + "</DataItem>";
}
std::string document(const std::string& domain) {
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\" xmlns:xi=\"http://www.w3.org/2001/XInclude\"><Domain>" +
         domain + "</Domain></Xdmf>\n";
}

std::string words(const std::vector<Vec3>& all) {
  std::string out;
  for (const Vec3& v : all) out += words_of(v) + " ";
  return out;
}

/// A hexahedron and a tetrahedron on its top, as a mixed mesh in HDF5, at two times.
TEST(Xdmf, MeshesWithTimesAreRead) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},    {0, 0, 1},
                                 {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}};
  const TempFolder folder;
  const Hdf5File file;
  file.set("/cells", std::vector<std::int64_t>{9, 0, 1, 2, 3, 4, 5, 6, 7, 6, 4, 5, 6, 8});
  file.set("/points", tuples_of(points), {points.size(), 3});
  file.set("/u0", tuples_of(flows_at(points)), {points.size(), 3});
  std::vector<Vec3> later = flows_at(points);
  for (Vec3& v : later) v *= 2.0;
  file.set("/u1", tuples_of(later), {points.size(), 3});
  std::ofstream(folder.path("a.h5"), std::ios::binary) << file.bytes();
  const std::string mesh = "<Topology TopologyType=\"Mixed\" NumberOfElements=\"2\">" +
                           heavy("14", "a.h5:/cells", true) + "</Topology><Geometry GeometryType=\"XYZ\">" +
                           heavy("9 3", "a.h5:/points") + "</Geometry>";
  const auto u = [](const std::string& at) {
    return "<Attribute Name=\"u\" AttributeType=\"Vector\" Center=\"Node\">" + heavy("9 3", "a.h5:/u" + at) +
           "</Attribute>";
  };
  const std::string p =
      "<Attribute Name=\"p\" AttributeType=\"Scalar\" Center=\"Cell\">" + item("2", "3 4") + "</Attribute>";
  const auto path = folder.write(
      "a.xdmf",
      document(
          "<Grid Name=\"mesh\" GridType=\"Uniform\">" + mesh + "</Grid>" +
          "<Grid Name=\"T\" GridType=\"Collection\" CollectionType=\"Temporal\"><Grid Name=\"one\" GridType=\"Uniform\">" +
          mesh + "<Time Value=\"0.5\"/>" + u("0") + p + "</Grid><Grid Name=\"two\" GridType=\"Uniform\">" +
          "<xi:include xpointer=\"xpointer(//Grid[@Name=&quot;T&quot;]/Grid[1]/*[self::Topology or self::Geometry])\"/>" +
          "<Time Value=\"1.5\"/>" + u("1") + p + "</Grid></Grid>"));
  Source source = Source::open({{path}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.5, 1.5}));
  ASSERT_EQ(source.info().blocks.size(), 1U);
  EXPECT_EQ(source.info().blocks[0].arrays.size(), 2U);
  for (std::size_t step = 0; step < 2; ++step) {
    const auto blocks = source.read({"u", "p"}, step);
    const auto& cells = std::get<UnstructuredTopology>(blocks.at(0).topology);
    EXPECT_EQ(cells.types, (std::vector<std::uint8_t>{12, 10}));
    EXPECT_EQ(cells.connectivity, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 8}));
    const DataArray* const v = blocks[0].find("u", Association::kPoint);
    const DataArray* const pressure = blocks[0].find("p", Association::kCell);
    ASSERT_TRUE(v != nullptr && pressure != nullptr);
    for (std::size_t n = 0; n < points.size(); ++n)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(v->at(n, c), (step == 0 ? 1.0 : 2.0) * flow_at(points[n])[c]);
    EXPECT_EQ(pressure->at(1), 4.0);
  }
}

TEST(Xdmf, GridsAreRead) {
  std::vector<Vec3> points;
  for (int n = 0; n < 24; ++n)
    points.emplace_back(10.0 + n % 4, 20.0 + 2.0 * (n / 4 % 3), 30.0 + 3.0 * (n / 12));
  const std::string values = "<Attribute Name=\"u\" AttributeType=\"Vector\" Center=\"Node\">" +
                             item("2 3 4 3", words(flows_at(points))) + "</Attribute>";
  const std::string shape = " Dimensions=\"2 3 4\"/>";
  const std::vector<std::pair<std::string, std::string>> kinds{
      {"uniform", "<Topology TopologyType=\"3DCoRectMesh\"" + shape +
                      "<Geometry GeometryType=\"ORIGIN_DXDYDZ\">" + item("3", "30 20 10") +
                      item("3", "3 2 1") + "</Geometry>"},
      {"rectilinear", "<Topology TopologyType=\"3DRectMesh\"" + shape + "<Geometry GeometryType=\"VXVYVZ\">" +
                          item("4", "10 11 12 13") + item("3", "20 22 24") + item("2", "30 33") +
                          "</Geometry>"},
      {"curvilinear", "<Topology TopologyType=\"3DSMesh\"" + shape + "<Geometry GeometryType=\"XYZ\">" +
                          item("24 3", words(points)) + "</Geometry>"}};
  for (const auto& [kind, grid] : kinds) {
    SCOPED_TRACE(kind);
    const TempFolder folder;
    const auto path =
        folder.write("a.xmf", document("<Grid Name=\"g\" GridType=\"Uniform\">" + grid + values + "</Grid>"));
    Source source = Source::open({{path}, {}});
    EXPECT_EQ(source.info().blocks.at(0).grid, kind);
    EXPECT_EQ(source.info().blocks[0].points, (Index3{4, 3, 2}));
    EXPECT_EQ(source.info().blocks[0].bounds.lower, points.front());
    EXPECT_EQ(source.info().blocks[0].bounds.upper, points.back());
    const auto blocks = source.read({"u"});
    const DataArray* const v = blocks.at(0).find("u", Association::kPoint);
    ASSERT_NE(v, nullptr);
    for (std::size_t n = 0; n < points.size(); ++n)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(v->at(n, c), flow_at(points[n])[c]);
  }
}

TEST(Xdmf, DamagedFilesAreRefused) {
  const TempFolder folder;
  const auto mesh = [](const std::string& kind, const std::string& cells, const std::string& u) {
    return document("<Grid Name=\"g\" GridType=\"Uniform\"><Topology TopologyType=\"" + kind +
                    "\" NumberOfElements=\"1\">" + item("1 4", cells, true) +
                    "</Topology><Geometry GeometryType=\"XYZ\">" + item("4 3", "0 0 0 1 0 0 0 1 0 0 0 1") +
                    "</Geometry><Attribute Name=\"u\" AttributeType=\"Vector\" Center=\"Node\">" + u +
                    "</Attribute></Grid>");
  };
  const std::string right = item("4 3", "1 2 3 1 2 3 1 2 3 1 2 3");
  EXPECT_NO_THROW((void)Source::open({{folder.write("a.xdmf", mesh("Tetrahedron", "0 1 2 3", right))}, {}}));
  EXPECT_NE(refusal(folder.write("b.xdmf", mesh("Tetrahedron", "0 1 2 9", right))).find("point 9 of 4"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("c.xdmf", mesh("Tetrahedron", "0 1 2 3", item("7", "1 2 3 4 5 6 7"))))
                .find("7 numbers"),
            std::string::npos);
  // Fewer than its Dimensions say, more, and what libxdmf would take for 1.
  for (const char* values : {"1 2 3 1 2 3 1 2 3", "1 2 3 1 2 3 1 2 3 1 2 3 4"})
    EXPECT_NE(refusal(folder.write("g.xdmf", mesh("Tetrahedron", "0 1 2 3", item("4 3", values))))
                  .find("12 by its Dimensions"),
              std::string::npos);
  EXPECT_NE(refusal(folder.write("h.xdmf", mesh("Tetrahedron", "0 1 2 3",
                                                item("4 3", "1 2 3 1 2 3 1 2 3 1 2 1.#QNAN"))))
                .find("'1.#QNAN'"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("d.xdmf", mesh("Tetrahedron", "0 1 2 3", heavy("4 3", "gone.h5:/u")))), "");
  EXPECT_NE(refusal(folder.write("e.xdmf", mesh("Wedge_15", "0 1 2 3", right))).find("Wedge_15"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("f.xdmf", document(""))).find("no grid"), std::string::npos);
  EXPECT_NE(refusal(folder.write("g.xdmf", "<Xdmf><Domain>")), "");
}

TEST(Xdmf, LeadsNowhereElse) {
  EXPECT_EQ(look_at_xdmf("<D>a.h5:/x</D><D> b.h5:/y</D><D>a.h5:/z</D>").hdf5,
            (std::vector<std::string>{"a.h5", "b.h5"}));
  EXPECT_EQ(look_at_xdmf("<Xdmf xmlns:xi=\"http://www.w3.org/\">").problem, "");
  EXPECT_NE(look_at_xdmf("<D>../a.h5:/x</D>").problem, "");
  EXPECT_NE(look_at_xdmf("<D>/etc/a.h5:/x</D>").problem, "");
  EXPECT_NE(look_at_xdmf("<xi:include href=\"/etc/passwd\" parse=\"text\"/>").problem, "");
  EXPECT_NE(look_at_xdmf("<!DOCTYPE x [<!ENTITY a SYSTEM \"b\">]>").problem, "");
}

/// An image of 4 x 3 x 2 points whose attribute u has the values of `item`.
std::string image(const std::string& values) {
  return document(
      "<Grid Name=\"g\" GridType=\"Uniform\"><Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"2 3 4\"/>"
      "<Geometry GeometryType=\"ORIGIN_DXDYDZ\">" +
      item("3", "0 0 0") + item("3", "1 1 1") +
      "</Geometry><Attribute Name=\"p\" AttributeType=\"Scalar\" Center=\"Node\">" +
      heavy("2 3 4", "a.h5:/p") +
      "</Attribute><Attribute Name=\"u\" AttributeType=\"Vector\" Center=\"Node\">" + values +
      "</Attribute></Grid>");
}
std::string slab(const std::string& place, const std::string& of, const std::string& counts) {
  return "<DataItem ItemType=\"HyperSlab\" Type=\"HyperSlab\" Dimensions=\"" + counts + "\">" +
         item("3 5", place, true) + of + "</DataItem>";
}

/// Writes a.h5: `all` of 3 x 2 x 3 x 4 x 3 numbers in order, p of as many as there are points.
void write_numbers(const TempFolder& folder) {
  const Hdf5File file;
  std::vector<double> all, few;
  for (int i = 0; i < 216; ++i) all.push_back(i);
  for (int i = 0; i < 24; ++i) few.push_back(1000.0 + i);
  file.set("/all", all, {3, 2, 3, 4, 3});
  file.set("/p", few, {2, 3, 4});
  std::ofstream(folder.path("a.h5"), std::ios::binary) << file.bytes();
}

// libxdmf counts the axes of a slab from the last one on, and puts what is joined one behind the other.
TEST(Xdmf, SlabsAndJoinedScalarsAreWhatTheFormatMeans) {
  const TempFolder folder;
  write_numbers(folder);
  const std::string all = heavy("3 2 3 4 3", "a.h5:/all");
  std::vector<std::pair<std::string, std::vector<double>>> cases;
  for (int time = 0; time < 3; ++time) {
    std::vector<double> expected;
    for (int i = 0; i < 72; ++i) expected.push_back(72.0 * time + i);
    cases.emplace_back(slab(std::to_string(time) + " 0 0 0 0 1 1 1 1 1 1 2 3 4 3", all, "2 3 4 3"), expected);
  }
  std::vector<double> joined, swapped;
  for (int p = 0; p < 24; ++p) {
    for (const double value : {3.0 * p + 72.0, 1000.0 + p, 3.0 * p + 2.0}) joined.push_back(value);
    for (int c = 2; c >= 0; --c) swapped.push_back(3.0 * p + c);
  }
  const auto one = [&](int time, int component) {
    return slab(std::to_string(time) + " 0 0 0 " + std::to_string(component) + " 1 1 1 1 1 1 2 3 4 1", all,
                "2 3 4");
  };
  const auto join = [&](const std::string& a, const std::string& b, const std::string& c) {
    return "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, $2)\" Dimensions=\"2 3 4 3\">" + a + b +
           c + "</DataItem>";
  };
  cases.emplace_back(join(one(1, 0), heavy("2 3 4", "a.h5:/p"), one(0, 2)), joined);
  cases.emplace_back(join(one(0, 2), one(0, 1), one(0, 0)), swapped);
  for (const auto& [values, expected] : cases) {
    Source source = Source::open({{folder.write("a.xdmf", image(values))}, {}});
    const auto blocks = source.read({"u", "p"});
    const DataArray* const u = blocks.at(0).find("u", Association::kPoint);
    const DataArray* const p = blocks[0].find("p", Association::kPoint);
    ASSERT_TRUE(u != nullptr && p != nullptr);
    ASSERT_EQ(u->tuples * 3, expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_EQ(u->at(i / 3, static_cast<int>(i % 3)), expected[i]) << values << " at " << i;
    EXPECT_EQ(p->at(5), 1005.0);
  }
}

TEST(Xdmf, OtherFunctionsCostTheirAttributeAndAWord) {
  const TempFolder folder;
  write_numbers(folder);
  const auto path = folder.write(
      "a.xdmf", image("<DataItem ItemType=\"Function\" Function=\"2 * $0\" Dimensions=\"2 3 4 3\">" +
                      heavy("2 3 4", "a.h5:/p") + "</DataItem>"));
  Source source = Source::open({{path}, {}});
  ASSERT_EQ(source.info().notes.size(), 1U);
  EXPECT_NE(source.info().notes[0].find("attribute 'u' left out: line 2 is the function '2 * $0'"),
            std::string::npos)
      << source.info().notes[0];
  ASSERT_EQ(source.info().blocks.at(0).arrays.size(), 1U);
  EXPECT_EQ(source.info().blocks[0].arrays[0].name, "p");
  const std::string beyond = refusal(folder.write(
      "b.xdmf", image(slab("3 0 0 0 0 1 1 1 1 1 1 2 3 4 3", heavy("3 2 3 4 3", "a.h5:/all"), "2 3 4 3"))));
  EXPECT_NE(beyond.find("HyperSlab beyond its array along axis 1"), std::string::npos) << beyond;
}

}  // namespace
}  // namespace palpate::test
