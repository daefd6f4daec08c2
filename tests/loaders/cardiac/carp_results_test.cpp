// Results on openCARP meshes (.igb, .dat) through the helper program.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

/// A .igb file of four points; `big` in the other byte order than x86.
std::string igb(const std::string& words, const std::vector<float>& values, bool big) {
  std::string file = "# made by a test\r\n" + words +
                     " type:float systeme:" + (big ? "big_endian" : "little_endian") + "\r\n";
  file.resize(1023, ' ');
  file += '\f';
  for (const float value : values) {
    std::array<char, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    file.append(bytes.data(), bytes.size());
  }
  return file;
}

class CarpResults : public testing::Test {
 protected:
  CarpResults() {
    folder_.write("m.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
    folder_.write("m.elem", "1\nTt 0 1 2 3 9\n");
  }
  [[nodiscard]] Source together(const std::string& result) const {
    return Source::open({.files = {folder_.path("m.pts"), folder_.path(result)}, .solution = {}, .raw = {}});
  }
  void expect_result_refused(const std::string& name, const std::string& content,
                             const std::string& word) const {
    folder_.write(name, content);
    test::expect_refused([&] { return together(name); }, {word, name});
  }
  test::TempFolder folder_;
};

TEST_F(CarpResults, PotentialsAreReadAStepAtATime) {
  const std::vector<float> values{-85.0F, -80.0F, NAN, 20.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F};
  for (const bool big : {false, true}) {
    folder_.write(
        "vm.igb",
        igb("x:4 y:1 z:1 t:3 org_t:10 dim_t:4 inc_t:2 units_t:ms unites:mV facteur:2 zero:1", values, big));
    Source source = together("vm.igb");
    EXPECT_EQ(source.info().times, (std::vector<double>{10.0, 12.0, 14.0}));
    for (const std::size_t step : {2U, 0U, 1U}) {  // in any order
      const auto blocks = source.read({"vm"}, step);
      const DataArray* vm = blocks.at(0).find("vm", Association::kPoint);
      ASSERT_NE(vm, nullptr);
      for (std::size_t p = 0; p < 4; ++p) {
        const double stored = static_cast<double>(values[4 * step + p]);
        if (std::isnan(stored))
          EXPECT_TRUE(std::isnan(vm->at(p)));
        else
          EXPECT_DOUBLE_EQ(vm->at(p), 2.0 * stored + 1.0) << step << " " << p;
      }
    }
  }
  // One of the mesh's own name comes along without being named.
  folder_.write("m.igb", igb("x:4 t:3", values, false));
  EXPECT_EQ(Source::open({.files = {folder_.path("m.elem")}}).info().times.size(), 3U);
}

TEST_F(CarpResults, HeadersThatDoNotFitAreNamed) {
  const std::vector<float> values(12, 1.0F);
  expect_result_refused("a.igb", igb("x:5 t:2", values, false), "4");
  expect_result_refused("b.igb", igb("x:4 t:4", values, false).substr(0, 1030), "one that is whole");
  expect_result_refused("c.igb", igb("x:4 t:10000000000000", values, false), "t:");
  expect_result_refused("d.igb", igb("x:4 t:3 inc_t:-1", values, false), "rise");
  expect_result_refused("e.igb", igb("x:4 t:3 inc_t:0", values, false), "rise");
  expect_result_refused("f.igb", igb("x:4 t:nan", values, false), "t:");
  expect_result_refused("g.igb", igb("x:4 t:3", values, false).substr(0, 500), "1024");
}

/// A number as bytes of a type, little endian.
template <typename Number>
std::string bytes_as(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    const auto number = static_cast<Number>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

// Sizes as in openCARP's IGB library: long has 8 bytes.
TEST_F(CarpResults, EveryTypeOfNumberIsReadByItsSize) {
  struct Case {
    const char* type;
    int components;
    std::string (*bytes)(const std::vector<double>&);
  };
  const std::vector<Case> cases{{"byte", 1, bytes_as<std::uint8_t>},  {"char", 1, bytes_as<std::int8_t>},
                                {"short", 1, bytes_as<std::int16_t>}, {"ushort", 1, bytes_as<std::uint16_t>},
                                {"int", 1, bytes_as<std::int32_t>},   {"uint", 1, bytes_as<std::uint32_t>},
                                {"long", 1, bytes_as<std::int64_t>},  {"float", 1, bytes_as<float>},
                                {"double", 1, bytes_as<double>},      {"complex", 2, bytes_as<float>},
                                {"rgba", 4, bytes_as<std::uint8_t>},  {"vec3f", 3, bytes_as<float>},
                                {"vec3d", 3, bytes_as<double>},       {"vec4f", 4, bytes_as<float>},
                                {"vec4d", 4, bytes_as<double>}};
  for (const Case& each : cases) {
    std::vector<double> values(3 * 4 * static_cast<std::size_t>(each.components));
    for (std::size_t n = 0; n < values.size(); ++n) values[n] = static_cast<double>(n % 100);
    std::string file = std::string("x:4 t:3 systeme:little_endian inc_t:5 type:") + each.type;
    file.resize(1024, ' ');
    folder_.write("vm.igb", file + each.bytes(values));
    Source source = together("vm.igb");
    ASSERT_EQ(source.info().times, (std::vector<double>{0.0, 5.0, 10.0})) << each.type;
    for (const std::size_t step : {2U, 0U}) {
      const auto blocks = source.read({"vm"}, step);
      const DataArray* vm = blocks.at(0).find("vm", Association::kPoint);
      ASSERT_NE(vm, nullptr) << each.type;
      ASSERT_EQ(vm->components, each.components) << each.type;
      const std::size_t first = step * 4 * static_cast<std::size_t>(each.components);
      for (std::size_t p = 0; p < 4; ++p)
        for (int c = 0; c < each.components; ++c)
          EXPECT_EQ(
              vm->at(p, c),
              values[first + p * static_cast<std::size_t>(each.components) + static_cast<std::size_t>(c)])
              << each.type;
    }
  }
  expect_result_refused("s.igb", igb("x:4 t:1", {1.0F, 1.0F, 1.0F, 1.0F}, false).replace(30, 0, "type:list "),
                        "type:");
}

TEST_F(CarpResults, OfARunThatWasCutOffTheWholeStepsAreThere) {
  const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::string whole = igb("x:4 t:6 dim_t:50", values, false);
  for (const std::size_t lost : {0U, 1U, 5U, 15U, 16U}) {
    folder_.write("vm.igb", whole.substr(0, whole.size() - lost));
    Source source = together("vm.igb");
    const std::size_t steps = lost == 0 ? 3 : 2;
    EXPECT_EQ(source.info().times.size(), steps) << lost;
    EXPECT_EQ(source.info().times.back(), 10.0 * static_cast<double>(steps - 1)) << "of six over 50";
    EXPECT_TRUE(says(source.info().notes, "promises 6 time steps")) << lost;
    EXPECT_EQ(source.read({"vm"}, steps - 1).at(0).find("vm", Association::kPoint)->at(3), 4.0 * steps);
  }
  // More than the header says is left out, and said.
  folder_.write("vm.igb", igb("x:4 t:2 inc_t:1", values, false));
  Source source = together("vm.igb");
  EXPECT_EQ(source.info().times.size(), 2U);
  EXPECT_TRUE(says(source.info().notes, "16 bytes more"));
}

// Of text of several times 1024 bytes, the last of which ends with a form feed.
TEST_F(CarpResults, HeadersMayBeLonger) {
  const std::string plain = igb("x:4 t:2 inc_t:1", {1, 2, 3, 4, 5, 6, 7, 8}, false);
  for (const std::size_t blocks : {1U, 2U, 5U}) {
    std::string longer = plain;
    longer.insert(1023, (blocks - 1) * 1024, ' ');
    folder_.write("vm.igb", longer);
    Source source = together("vm.igb");
    EXPECT_EQ(source.info().times.size(), 2U);
    EXPECT_FALSE(says(source.info().notes, "bytes more")) << blocks;
    EXPECT_EQ(source.read({"vm"}, 1).at(0).find("vm", Association::kPoint)->at(2), 7.0) << blocks;
  }
  // Without one it has 1024, whatever follows: this number is text with a form feed at its end.
  std::string without = plain;
  without[1023] = ' ';
  for (std::size_t i = 1024; i < without.size(); ++i) without[i] = 'A';
  folder_.write("vm.igb", without);
  EXPECT_EQ(together("vm.igb").info().times.size(), 2U);
}

TEST_F(CarpResults, SeveralResultsKeepTheirOwnTimes) {
  folder_.write("a.igb", igb("x:4 t:3 inc_t:5", {1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3}, false));
  folder_.write("b.igb", igb("x:4 t:2 inc_t:10", {7, 7, 7, 7, 9, 9, 9, 9}, false));
  folder_.write("c.igb", igb("x:1 t:1 org_t:99", {4}, false));
  Source source = Source::open(
      {.files = {folder_.path("m.pts"), folder_.path("a.igb"), folder_.path("b.igb"), folder_.path("c.igb")},
       .solution = {},
       .raw = {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 5.0, 10.0}));
  EXPECT_TRUE(says(source.info().notes, "b has no step at 1 time"));
  const auto at = [&](const char* name, std::size_t step, Association association) {
    const auto blocks = source.read({name}, step);
    const DataArray* array = blocks.at(0).find(name, association);
    return array == nullptr ? -1.0 : array->at(0);
  };
  EXPECT_EQ(at("a", 1, Association::kPoint), 2.0);
  EXPECT_EQ(at("b", 0, Association::kPoint), 7.0);
  EXPECT_TRUE(std::isnan(at("b", 1, Association::kPoint)));
  EXPECT_EQ(at("b", 2, Association::kPoint), 9.0);
  EXPECT_EQ(at("c", 2, Association::kCell), 4.0) << "of the only element, at every time";
}

TEST_F(CarpResults, TimesThatAreStatedTwiceAndDifferAreSaid) {
  const std::vector<float> values{1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  for (const auto& [words, step, said] : {std::tuple{"inc_t:5 dim_t:10", 5.0, false},
                                          {"inc_t:5 dim_t:15", 5.0, false},
                                          {"inc_t:5 dim_t:100", 5.0, true},
                                          {"inc_t:5 fac_t:5", 5.0, false},
                                          {"inc_t:5 fac_t:1", 5.0, true},
                                          {"dim_t:10 fac_t:7", 5.0, true},
                                          {"fac_t:7", 7.0, false}}) {
    folder_.write("vm.igb", igb(std::string("x:4 t:3 ") + words, values, false));
    const Source source = together("vm.igb");
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, step, 2.0 * step})) << words;
    EXPECT_EQ(says(source.info().notes, "the header states steps 5 apart"), said) << words;
  }
}

TEST_F(CarpResults, TimesInOtherUnitsAreTurned) {
  const std::vector<float> values{1, 1, 1, 1, 2, 2, 2, 2};
  folder_.write("a.igb", igb("x:4 t:2 inc_t:5 unites_t:ms", values, false));
  folder_.write("b.igb", igb("x:4 t:2 inc_t:0.005 unites_t:s", values, false));
  folder_.write("c.igb", igb("x:4 t:2 inc_t:5 unites_t:beats", values, false));
  const auto with = [this](const char* other) {
    return Source::open({.files = {folder_.path("m.pts"), folder_.path("a.igb"), folder_.path(other)},
                         .solution = {},
                         .raw = {}})
        .info();
  };
  EXPECT_EQ(with("b.igb").times, (std::vector<double>{0.0, 5.0}));
  EXPECT_TRUE(says(with("b.igb").notes, "in s, turned into ms"));
  EXPECT_TRUE(says(with("c.igb").notes, "are in beats, those of"));
}

TEST_F(CarpResults, NumbersThatMakeSenseInTheOtherByteOrderAloneAreSaid) {
  const std::vector<float> potentials{-85.5F, -80.25F, 12.125F, 20.3F};
  for (const bool big : {false, true}) {
    std::string file = igb("x:4 t:1", potentials, big);
    folder_.write("vm.igb", file);
    EXPECT_FALSE(says(together("vm.igb").info().notes, "byte order")) << big;
    const std::string stated = big ? "big_endian   " : "little_endian";
    file.replace(file.find(stated.substr(0, stated.find(' '))), stated.size(),
                 big ? "little_endian" : "big_endian   ");
    folder_.write("vm.igb", file);
    EXPECT_TRUE(says(together("vm.igb").info().notes, "make no sense as")) << big;
  }
  folder_.write("vm.igb", igb("x:4 t:1", {0, 0, 0, 0}, false));
  EXPECT_FALSE(says(together("vm.igb").info().notes, "byte order"));
}

TEST_F(CarpResults, PlacesThatWereNeverActivatedHaveNoTime) {
  const auto at = [this](const char* text, std::size_t place) {
    folder_.write("act.dat", text);
    return together("act.dat").read({"act"}).at(0).find("act", Association::kPoint)->at(place);
  };
  EXPECT_TRUE(std::isnan(at("1.5\n-1\n0\n-1.0\n", 1)));
  EXPECT_TRUE(says(together("act.dat").info().notes, "2 places of -1"));
  EXPECT_EQ(at("1.5\n-1\n-2\n0\n", 1), -1.0) << "a potential";
  EXPECT_EQ(at("-1\n-1\n-1\n-1\n", 1), -1.0);
}

TEST_F(CarpResults, TablesOfNodesMayCountFromOne) {
  folder_.write("act.dat", "1 7\n3 5\n4 6\n");
  Source source = together("act.dat");
  EXPECT_TRUE(says(source.info().notes, "nodes count from 1"));
  const auto blocks = source.read({"act"});
  const DataArray* act = blocks.at(0).find("act", Association::kPoint);
  EXPECT_EQ(act->at(0), 7.0);
  EXPECT_TRUE(std::isnan(act->at(1)));
  EXPECT_EQ(act->at(3), 6.0);
}

TEST_F(CarpResults, ActivationTimesAreANumberALine) {
  folder_.write("act.dat", "1.5\nnan\n-2\n1e3\n");
  Source source = together("act.dat");
  EXPECT_TRUE(source.info().times.empty());
  const auto blocks = source.read({"act"});
  const DataArray* act = blocks.at(0).find("act", Association::kPoint);
  ASSERT_NE(act, nullptr);
  EXPECT_EQ(act->at(0), 1.5);
  EXPECT_TRUE(std::isnan(act->at(1)));
  EXPECT_EQ(act->at(3), 1000.0);
  folder_.write("strain.dat", "0.25\n");
  Source of_cells = together("strain.dat");
  const auto cell_blocks = of_cells.read({"strain"});
  EXPECT_NE(cell_blocks.at(0).find("strain", Association::kCell), nullptr);
  expect_result_refused("short.dat", "1\n2\n3\n", "ends after 3");
  expect_result_refused("long.dat", "1\n2\n3\n4\n5\n", "line 5");
  expect_result_refused("word.dat", "1\n2\n3\n4\nx\n", "line 5");
}

TEST_F(CarpResults, TablesOfNodesAndTimesHaveTheFirstOfEach) {
  folder_.write("act.dat", "# node time\n2 7.5\n0 3\n\n2\t5.5\n3 1e2\n0 4\n");
  Source source = together("act.dat");
  EXPECT_TRUE(says(source.info().notes, "2 left out"));
  EXPECT_TRUE(says(source.info().notes, "1 point without a time"));
  const auto blocks = source.read({"act"});
  const DataArray* act = blocks.at(0).find("act", Association::kPoint);
  ASSERT_NE(act, nullptr);
  EXPECT_EQ(act->at(0), 3.0);
  EXPECT_TRUE(std::isnan(act->at(1)));
  EXPECT_EQ(act->at(2), 5.5);
  EXPECT_EQ(act->at(3), 100.0);
  expect_result_refused("far.dat", "0 1\n4 1\n", "line 2: names node 4");
  expect_result_refused("farther.dat", "1 1\n5 1\n", "line 2: names node 5");
  expect_result_refused("half.dat", "0 1\n1 1\n2 1\n3 1\n0.5 1\n", "line 5: names node 0.5");
  expect_result_refused("three.dat", "0 1\n1 1\n2 1\n3 1\n0 1 2\n", "line 5");
}

TEST_F(CarpResults, HeadersOfOtherSpellingsAndPackedFilesOfAnyNameAreRead) {
  const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::string plain = igb("x:4 t:3 inc_t:5", values, false);
  for (const std::string words : {"x:4,y:1,z:1,t:3,inc_t:5,type:float,systeme:little_endian",
                                  "x:4; y:1; z:1; t:3; inc_t:5; type:float; systeme:little_endian;",
                                  "X:4 Y:1 Z:1 T:3 Inc_t:5 TYPE:FLOAT SYSTEME:Little_Endian"}) {
    std::string head = words + "\r\n";
    head.resize(1024, ' ');
    folder_.write("vm.igb", head + plain.substr(1024));
    Source source = together("vm.igb");
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 5.0, 10.0})) << words;
    EXPECT_EQ(source.read({"vm"}, 2).at(0).find("vm", Association::kPoint)->at(3), 12.0) << words;
  }
  const std::filesystem::path packed = folder_.path("vm.igb");
  gzFile file = gzopen(packed.c_str(), "wb");
  ASSERT_NE(file, nullptr);
  ASSERT_EQ(gzwrite(file, plain.data(), static_cast<unsigned>(plain.size())), static_cast<int>(plain.size()));
  gzclose(file);
  Source source = together("vm.igb");
  EXPECT_EQ(source.info().times.size(), 3U);
  EXPECT_EQ(source.read({"vm"}, 1).at(0).find("vm", Association::kPoint)->at(0), 5.0);
}

}  // namespace
}  // namespace palpate
