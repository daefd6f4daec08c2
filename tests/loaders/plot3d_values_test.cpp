// Function files of PLOT3D and solutions of OVERFLOW, written here number by number in every layout.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/load.h"
#include "tests/support/refusal.h"
#include "tests/support/samples.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

struct Layout {
  bool big = false, marks = false, multi = false, doubles = false, flat = false, text = false;
};

class Writer {
 public:
  explicit Writer(const Layout& layout) : layout_(layout) {}
  void whole(std::int32_t value) {
    if (layout_.text) {
      record_ += std::to_string(value) + " ";
    } else {
      put(record_, value);
    }
  }
  void number(double value) {
    if (layout_.text) {
      record_ += exact_number(value) + "\n";
    } else if (layout_.doubles) {
      put(record_, value);
    } else {
      put(record_, static_cast<float>(value));
    }
  }
  void end_record() {
    const auto bytes = static_cast<std::int32_t>(record_.size());
    if (layout_.marks) put(file_, bytes);
    file_ += record_;
    if (layout_.marks) put(file_, bytes);
    record_.clear();
  }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  template <typename T>
  void put(std::string& out, T value) const {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (layout_.big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
    out += bytes;
  }
  Layout layout_;
  std::string file_, record_;
};

std::vector<Index3> grids_of(const Layout& l) {
  std::vector<Index3> grids{{4, 3, 2}, {2, 3, 5}};
  if (!l.multi) grids.resize(1);
  for (Index3& n : grids) n.z = l.flat ? 1 : n.z;
  return grids;
}
int points_of(const Index3& n) { return n.x * n.y * n.z; }
double value(std::size_t grid, int variable, int point) {
  return 1.0 + static_cast<double>(grid) + 0.5 * variable + 0.25 * point;
}

/// @param more whole numbers behind the dimensions of each grid, and of all.
void put_dimensions(Writer& w, const Layout& l, const std::vector<int>& of_each,
                    const std::vector<int>& of_all) {
  if (l.multi) {
    w.whole(static_cast<std::int32_t>(grids_of(l).size()));
    w.end_record();
  }
  for (const Index3& n : grids_of(l)) {
    for (int axis = 0; axis < (l.flat ? 2 : 3); ++axis) w.whole(n[axis]);
    for (const int number : of_each) w.whole(number);
  }
  for (const int number : of_all) w.whole(number);
  w.end_record();
}

void put_values(Writer& w, const Layout& l, std::size_t grid, int count) {
  for (int variable = 0; variable < count; ++variable) {
    for (int p = 0; p < points_of(grids_of(l)[grid]); ++p) w.number(value(grid, variable, p));
  }
  w.end_record();
}

std::string grid_file(const Layout& l) {
  Writer w(l);
  put_dimensions(w, l, {}, {});
  for (const Index3& n : grids_of(l)) {
    for (int axis = 0; axis < (l.flat ? 2 : 3); ++axis) {
      for (int p = 0; p < points_of(n); ++p)
        w.number(axis == 0 ? p % n.x : axis == 1 ? p / n.x % n.y : p / n.x / n.y);
    }
    w.end_record();
  }
  return w.file();
}

std::string function_file(const Layout& l, int count) {
  Writer w(l);
  put_dimensions(w, l, {count}, {});
  for (std::size_t g = 0; g < grids_of(l).size(); ++g) put_values(w, l, g, count);
  return w.file();
}

/// @param later the conditions of newer versions, FSMACH, TVREF, DTVREF, are there.
std::string overflow_file(const Layout& l, int count, int species, bool later) {
  Writer w(l);
  put_dimensions(w, l, {}, {count, species});
  for (std::size_t g = 0; g < grids_of(l).size(); ++g) {
    for (int i = 0; i < 7; ++i) w.number(0.5);
    w.whole(1);
    for (int i = 0; i < 3 + std::max(2, species) + (later ? 3 : 0); ++i) w.number(1.4);
    w.end_record();
    put_values(w, l, g, count);
  }
  return w.file();
}

void expect_values(Source& source, const std::string& name, int first, int components) {
  const auto blocks = source.read({name});
  for (std::size_t g = 0; g < blocks.size(); ++g) {
    const DataArray* const array = blocks[g].find(name, Association::kPoint);
    ASSERT_NE(array, nullptr) << name;
    ASSERT_EQ(array->tuples, blocks[g].point_count());
    for (std::size_t p = 0; p < array->tuples; ++p) {
      for (int c = 0; c < components; ++c)
        ASSERT_EQ(array->at(p, c), value(g, first + c, static_cast<int>(p))) << name;
    }
  }
}

std::vector<Layout> all_layouts() {
  std::vector<Layout> out;
  for (int bits = 0; bits < 32; ++bits)
    out.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0});
  return out;
}

TEST(Plot3dValues, FunctionFilesOfEveryLayoutAreRead) {
  const TempFolder folder;
  std::vector<Layout> layouts = all_layouts();
  for (const bool multi : {false, true}) layouts.push_back({.multi = multi, .doubles = true, .text = true});
  for (const Layout& l : layouts) {
    SCOPED_TRACE(testing::Message() << l.big << l.marks << l.multi << l.doubles << l.flat << l.text);
    const auto grid = folder.write("a.xyz", grid_file(l));
    Source source = Source::open({{grid}, folder.write("a.f", function_file(l, 4))});
    expect_values(source, "function 1", 0, 1);
    expect_values(source, "function 4", 3, 1);
    expect_values(source, "functions 2 to 4", 1, 3);
  }
}

TEST(Plot3dValues, SolutionsOfOverflowAreRead) {
  const TempFolder folder;
  for (const Layout& l : all_layouts()) {
    for (const bool later : {false, true}) {
      for (const int species : {0, 3}) {
        SCOPED_TRACE(testing::Message()
                     << l.big << l.marks << l.multi << l.doubles << l.flat << later << species);
        const auto grid = folder.write("a.xyz", grid_file(l));
        const int axes = l.flat ? 2 : 3;
        Source source = Source::open({{grid}, folder.write("a.q", overflow_file(l, 8, species, later))});
        expect_values(source, "Density", 0, 1);
        expect_values(source, "Momentum", 1, axes);
        expect_values(source, "StagnationEnergy", axes + 1, 1);
        expect_values(source, "Gamma", axes + 2, 1);
        expect_values(source, "value 8", 7, 1);
      }
    }
  }
}

TEST(Plot3dValues, NamesComeFromTheFileBesideOrTheList) {
  const TempFolder folder;
  const Layout l{.marks = true, .multi = true};
  (void)folder.write("a.xyz", grid_file(l));
  (void)folder.write("a.f", function_file(l, 4));
  (void)folder.write("a.nam", "pressure\nu-velocity ; velocity\nv-velocity\nw-velocity\n");
  Source source = Source::open({{folder.path("a.xyz")}, folder.path("a.f")});
  expect_values(source, "pressure", 0, 1);
  expect_values(source, "w-velocity", 3, 1);
  EXPECT_EQ(source.info().blocks.at(0).arrays.size(), 4U)
      << "no vector is made up where functions have names";
  (void)folder.write("b.f", function_file(l, 4));
  Source list = Source::open(
      {{folder.write(
           "all.p3d",
           R"({"filenames": [{"time": 1, "xyz": "a.xyz", "function": "b.f"}], "function-names": ["p"]})")},
       {}});
  expect_values(list, "p", 0, 1);
  expect_values(list, "functions 2 to 4", 1, 3);
  EXPECT_NE(
      refusal(folder.write("both.p3d", R"({"filenames": [{"xyz": "a.xyz", "q": "a.q", "function": "b.f"}]})"))
          .find("functions of one grid"),
      std::string::npos);
}

TEST(Plot3dValues, FilesThatAreCutOffOrOfAnotherGridAreRefused) {
  const TempFolder folder;
  const Layout l{.marks = true, .multi = true, .doubles = true};
  const auto grid = folder.write("a.xyz", grid_file(l));
  const auto refused = [&](std::string file) {
    const auto solution = folder.write("b.f", file);
    EXPECT_THROW((void)Source::open({{grid}, solution}), Error);
  };
  const std::string functions = function_file(l, 3), overflow = overflow_file(l, 6, 0, true);
  for (const std::string& whole : {functions, overflow}) {
    for (std::size_t size = 0; size < whole.size(); size += 164 / samples_of(4))
      refused(whole.substr(0, size));
    refused(whole + "x");
  }
  Layout single = l;
  single.multi = false;
  refused(function_file(single, 3));
}

}  // namespace
}  // namespace palpate::test
