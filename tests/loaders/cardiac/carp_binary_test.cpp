// openCARP's binary meshes, written here as its tools write them, against the text of the same mesh; and damaged.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

/// A binary file: a header of 1024 bytes and numbers of 4 bytes.
class Bytes {
 public:
  Bytes(const std::string& header, bool big) : big_(big), text_(header) { text_.resize(1024, '\0'); }
  template <typename T>
  Bytes& add(std::initializer_list<T> numbers) {
    for (const T number : numbers) {
      auto raw = std::bit_cast<std::array<char, sizeof(T)>>(number);
      if (big_ != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
      text_.append(raw.data(), raw.size());
    }
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  bool big_;
  std::string text_;
};

std::string order(bool big) { return big ? "1" : "0"; }

Bytes points(bool big, const std::string& count = "6") {
  return Bytes(count + " " + order(big) + " 666", big)
      .add({0.0F, 0.0F, 0.0F, 1000.0F, 0.0F, 0.0F, 0.0F, 1000.0F, 0.0F, 0.0F, 0.0F, 1000.0F})
      .add({1000.0F, 0.0F, 1000.0F, 0.0F, 1000.0F, 1000.0F});
}
/// A prism, one tetrahedron of it, and a triangle and a line on it. Kinds count from Tt, with Oc between.
Bytes elements(bool big, const std::string& count = "4") {
  return Bytes(count + " " + order(big) + " 666", big)
      .add<std::int32_t>({4, 0, 1, 2, 3, 5, 4, 7})
      .add<std::int32_t>({0, 0, 1, 2, 3, -9})
      .add<std::int32_t>({6, 0, 1, 2, 2'000'000'000})
      .add<std::int32_t>({7, 0, 1, 0});
}
Bytes fibres(bool big, const std::string& counts = "2 4") {
  return Bytes(counts + " " + order(big) + " 666", big)
      .add({2.0F, 0.0F, 0.0F, 0.0F, 3.0F, 0.0F})
      .add({0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
      .add({0.0F, 0.0F, 1.0F, 0.0F, 1.0F, 0.0F})
      .add({0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F});
}

Source open(const std::filesystem::path& file) {
  return Source::open({.files = {file}, .solution = {}, .raw = {}});
}

void expect_refused(const std::filesystem::path& file, const std::string& words) {
  try {
    (void)open(file);
    ADD_FAILURE() << words << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

void expect_same(const DataSet& a, const DataSet& b) {
  const auto& x = std::get<UnstructuredTopology>(a.topology);
  const auto& y = std::get<UnstructuredTopology>(b.topology);
  EXPECT_EQ(x.types, y.types);
  EXPECT_EQ(x.connectivity, y.connectivity);
  ASSERT_EQ(x.positions.tuples, y.positions.tuples);
  for (std::size_t p = 0; p < x.positions.tuples; ++p)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(x.positions.at(p, c), y.positions.at(p, c));
  ASSERT_EQ(a.arrays.size(), b.arrays.size());
  for (const DataArray& array : a.arrays) {
    const DataArray* other = b.find(array.name, array.association);
    ASSERT_NE(other, nullptr) << array.name;
    for (std::size_t t = 0; t < array.tuples; ++t)
      for (int c = 0; c < array.components; ++c)
        EXPECT_TRUE(array.at(t, c) == other->at(t, c) ||
                    (std::isnan(array.at(t, c)) && std::isnan(other->at(t, c))))
            << array.name << " " << t;
  }
}

TEST(CarpBinary, HoldsWhatTheTextOfTheSameMeshHolds) {
  const test::TempFolder text;
  text.write("m.pts", "6\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n1000 0 1000\n0 1000 1000\n");
  text.write("m.elem", "4\nPr 0 1 2 3 5 4 7\nTt 0 1 2 3 -9\nTr 0 1 2 2000000000\nLn 0 1 0\n");
  text.write("m.lon", "2\n2 0 0 0 3 0\n0 0 0 0 1 0\n0 0 1 0 1 0\n0 1 0 0 0 1\n");
  const std::vector<std::string> arrays{"fibre", "sheet", "normal", "region"};
  const DataSet wanted = open(text.path("m.pts")).read(arrays).at(0);
  for (const bool big : {false, true}) {
    for (const bool packed : {false, true}) {
      const test::TempFolder folder;
      const auto write = [&](const std::string& name, const std::string& bytes) {
        if (!packed) {
          folder.write(name, bytes);
          return;
        }
        gzFile file = gzopen(folder.path(name + ".gz").c_str(), "wb");
        gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
        gzclose(file);
      };
      write("m.bpts", points(big).text());
      write("m.belem", elements(big).text());
      write("m.blon", fibres(big).text());
      for (const char* named : {"m.bpts", "m.belem", "m.blon"}) {
        Source source = open(folder.path(named + std::string(packed ? ".gz" : "")));
        EXPECT_EQ(source.info().format, "openCARP");
        expect_same(source.read(arrays).at(0), wanted);
      }
    }
  }
}

// Text and numbers of one name may lie beside each other: what is named says which, and the other fills gaps.
TEST(CarpBinary, PartsOfOneKindBelongTogether) {
  const test::TempFolder folder;
  folder.write("m.bpts", points(false).text());
  folder.write("m.belem", elements(false).text());
  folder.write("m.pts", "4\n0 0 0\n5000 0 0\n0 5000 0\n0 0 5000\n");
  folder.write("m.elem", "1\nTt 0 1 2 3 1\n");
  EXPECT_EQ(open(folder.path("m.bpts")).read({}).at(0).cell_count(), 4U);
  EXPECT_EQ(open(folder.path("m.elem")).read({}).at(0).cell_count(), 1U);
  std::filesystem::remove(folder.path("m.elem"));
  std::filesystem::remove(folder.path("m.bpts"));
  folder.write("m.pts", "6\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n1000 0 1000\n0 1000 1000\n");
  for (const char* named : {"m.pts", "m.belem"})
    EXPECT_EQ(open(folder.path(named)).read({}).at(0).cell_count(), 4U) << named;
}

TEST(CarpBinary, PointsMayCountFromOne) {
  const test::TempFolder folder;
  folder.write("m.bpts", points(false).text());
  const auto elem = folder.write(
      "m.belem", Bytes("2 0 666", false).add<std::int32_t>({0, 1, 2, 3, 4, 1, 0, 3, 4, 5, 6, 1}).text());
  const DataSet mesh = open(elem).read({}).at(0);
  EXPECT_EQ(std::get<UnstructuredTopology>(mesh.topology).connectivity,
            (std::vector<std::int64_t>{0, 1, 2, 3, 2, 3, 4, 5}));
}

TEST(CarpBinary, CutAndUntrueFilesAreRefusedWithALine) {
  const test::TempFolder folder;
  const auto pts = folder.write("m.bpts", points(false).text());
  const auto elem = folder.write("m.belem", elements(false).text());
  const auto lon = folder.write("m.blon", fibres(false).text());
  const auto refused = [&](const std::filesystem::path& file, const std::string& bytes,
                           const std::string& words) {
    const std::string whole = file == pts    ? points(false).text()
                              : file == elem ? elements(false).text()
                                             : fibres(false).text();
    folder.write(file.filename().string(), bytes);
    expect_refused(pts, words);
    folder.write(file.filename().string(), whole);
  };
  const auto cut = [](const std::string& text, std::size_t bytes) {
    return text.substr(0, text.size() - bytes);
  };
  refused(pts, cut(points(false).text(), 1), "m.bpts: is cut off after 5 points; expected 6 points");
  refused(pts, points(false).text() + "1234", "m.bpts: goes on for 4 bytes after 6 points");
  refused(pts, points(false, "7").text(), "is cut off after 6 points");
  refused(pts, points(false, "4611686018427387904").text(), "is cut off after 6 points");
  refused(pts, points(false, "99999999999999999999999").text(), "m.bpts: header: begins with");
  refused(pts, points(false, "6.5").text(), "header: begins with \"6.5 0 666\"");
  refused(pts, points(false).text().substr(0, 700), "header: is cut off after 700 bytes");
  refused(pts, Bytes("6 2 666", false).text() + points(false).text().substr(1024), "byte order 2");
  refused(pts, Bytes("6", false).text() + points(false).text().substr(1024), "header: begins with \"6\"");
  refused(pts,
          Bytes("6 0 666", false).text() +
              Bytes("", false).add({std::nanf(""), 0.0F, 0.0F}).text().substr(1024) +
              points(false).text().substr(1036),
          "point 0: has a coordinate that is not finite");
  for (const std::size_t bytes : {1U, 4U, 16U, 20U})
    refused(elem, cut(elements(false).text(), bytes), "m.belem: is cut off after");
  refused(elem, elements(false).text() + std::string(16, '\0'), "goes on for 16 bytes after 4 elements");
  refused(elem, elements(false, "5").text(), "is cut off after 4 elements");
  refused(elem, elements(false, "1000000000000").text(), "header: promises 1000000000000 elements");
  refused(elem, Bytes("1 0 666", false).add<std::int32_t>({0, 0, 1, 2, 6, 1}).text(),
          "element 0: names point 6");
  refused(elem, Bytes("1 0 666", false).add<std::int32_t>({0, 0, 1, 2, -1, 1}).text(),
          "element 0: names point -1");
  refused(elem, Bytes("1 0 666", false).add<std::int32_t>({2, 0, 1, 2, 3, 4, 5, 1}).text(),
          "element 0: is of kind 2");
  // Stated in the wrong order.
  refused(elem, Bytes("4 0 666", false).text() + elements(true).text().substr(1024), "byte order");
  refused(lon, cut(fibres(false).text(), 8), "m.blon: is cut off after 3 elements");
  refused(lon, fibres(false, "1 4").text(), "goes on for 48 bytes after 4 elements");
  refused(lon, fibres(false, "2 3").text(), "speaks of 3 elements; expected 4");
  refused(lon, fibres(false, "3 4").text(), "speaks of 3 directions");
  EXPECT_EQ(open(pts).read({}).at(0).cell_count(), 4U);
}

// Tools write zeros where a mesh has no fibres.
TEST(CarpBinary, ZeroDirectionsAreNone) {
  const test::TempFolder folder;
  const auto pts = folder.write("m.bpts", points(false).text());
  folder.write("m.belem", elements(false).text());
  for (const bool binary : {true, false}) {
    std::filesystem::remove(folder.path("m.blon"));
    if (binary) {
      folder.write("m.blon", Bytes("1 4 0 666", false).text() + std::string(4 * 12, '\0'));
    } else {
      folder.write("m.lon", "1\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n");
    }
    const Source source = open(pts);
    for (const ArrayInfo& array : source.info().blocks.at(0).arrays) EXPECT_NE(array.name, "fibre");
    EXPECT_TRUE(
        std::any_of(source.info().notes.begin(), source.info().notes.end(), [](const std::string& note) {
          return note.find("holds no direction but zeros") != std::string::npos;
        }));
  }
}

}  // namespace
}  // namespace palpate
