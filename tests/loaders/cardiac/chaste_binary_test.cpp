// Binary meshes of Chaste, written here as it writes them, against the same mesh in text; and damaged.
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

/// Numbers with their lowest byte first, as all machines of Chaste's have them.
template <typename T>
std::string bytes(const std::vector<T>& values) {
  std::string text(values.size() * sizeof(T), '\0');
  std::memcpy(text.data(), values.data(), text.size());
  return text;
}
std::string numbers(const std::vector<double>& values) { return bytes(values); }
std::string nodes(const std::vector<std::uint32_t>& values) { return bytes(values); }

constexpr const char* kRemark = "#\n# Created by a test\n";

class ChasteBinaries : public testing::Test {
 protected:
  void write_binary() const {
    folder_.write("b.node", "5\t3\t1\t0\tBIN\n" +
                                numbers({0, 0, 0, 10, 1, 0, 0, 11, 0, 1, 0, 12, 0, 0, 1, 13, 1, 1, 1, 14}) +
                                kRemark);
    folder_.write("b.ele", "2\t4\t1\tBIN\n" + nodes({0, 1, 2, 3}) + numbers({7}) + nodes({1, 2, 3, 4}) +
                               numbers({8}) + kRemark);
    folder_.write("b.axi", "2\tBIN\n" + numbers({1, 0, 0, 0, 0, 0}));
  }
  [[nodiscard]] Source open(const char* name) const {
    return Source::open({.files = {folder_.path(name)}, .solution = {}, .raw = {}});
  }
  void expect_refused(const std::string& name, const std::string& content, const std::string& word) const {
    write_binary();
    folder_.write(name, content);
    test::expect_refused([this] { return open("b.ele"); }, {word, name});
  }
  test::TempFolder folder_;
};

TEST_F(ChasteBinaries, AreTheMeshesOfTheirText) {
  write_binary();
  folder_.write("t.node", "5 3 1 0\n0 0 0 0 10\n1 1 0 0 11\n2 0 1 0 12\n3 0 0 1 13\n4 1 1 1 14\n");
  folder_.write("t.ele", "2 4 1\n0 0 1 2 3 7\n1 1 2 3 4 8\n");
  folder_.write("t.axi", "2\n1 0 0\n0 0 0\n");
  Source binary = open("b.ele"), text = open("t.ele");
  const std::vector<std::string> names{"fibre", "region", "attribute 1"};
  const DataSet a = binary.read(names).at(0), b = text.read(names).at(0);
  const auto& cells = std::get<UnstructuredTopology>(a.topology);
  EXPECT_EQ(cells.connectivity, std::get<UnstructuredTopology>(b.topology).connectivity);
  EXPECT_EQ(cells.types, std::get<UnstructuredTopology>(b.topology).types);
  EXPECT_EQ(cells.positions.at(4, 2), 1.0);
  ASSERT_EQ(a.arrays.size(), b.arrays.size());
  for (std::size_t i = 0; i < a.arrays.size(); ++i) {
    EXPECT_EQ(a.arrays[i].name, b.arrays[i].name);
    ASSERT_EQ(a.arrays[i].bytes.size(), b.arrays[i].bytes.size());
    EXPECT_EQ(std::memcmp(a.arrays[i].bytes.data(), b.arrays[i].bytes.data(), a.arrays[i].bytes.size()), 0)
        << a.arrays[i].name;
  }
  EXPECT_EQ(a.find("attribute 1", Association::kPoint)->at(3), 13.0);
}

TEST_F(ChasteBinaries, MarkersOfFacesAreLeftOutAndSaid) {
  write_binary();
  folder_.write("b.face", "1\t1\tBIN\n" + nodes({0, 1, 2}) + numbers({1}));
  bool said = false;
  const Source source = open("b.ele");
  for (const std::string& note : source.info().notes)
    said = said || note.find("b.face is binary: its markers are left out") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST_F(ChasteBinaries, WhatIsOffIsNamed) {
  expect_refused("b.node", "5\t3\t1\t0\tBIN\n" + numbers({0, 0, 0, 10}), "is cut off after 1 row");
  expect_refused("b.node", "1\t2\t0\t0\tBIN\n" + numbers({0, 0}), "has nodes of 2 dimensions");
  expect_refused("b.ele", "1\t4\t0\tBIN\n" + nodes({0, 1, 2, 5}), "of node 5");
  expect_refused("b.ele", "1\t4\t0\tBIN\n" + nodes({0, 1, 2, 3, 9}), "goes on after 1 row of 16 bytes");
  expect_refused("b.ele", "1\t3\t0\tBIN\n" + nodes({0, 1, 2}), "has elements of 3 nodes");
  expect_refused("b.ele", "1\t-4\t0\tBIN\n" + nodes({0, 1, 2, 3}), "has \"-4\"");
  expect_refused("b.axi", "3\tBIN\n" + numbers({1, 0, 0, 1, 0, 0, 1, 0, 0}), "has 3 directions");
}

}  // namespace
}  // namespace palpate
