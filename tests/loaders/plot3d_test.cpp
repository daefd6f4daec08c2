// PLOT3D files of every layout, written here byte by byte after the manual (NASA TM-101067, ch. 8).
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "common/load/plot3d_layout.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

struct Layout {
  bool big = false;
  bool marks = false;
  bool multi = false;
  bool blanking = false;
  bool doubles = false;
  bool flat = false;  ///< two-dimensional
  bool text = false;
};

std::string name(const Layout& l) {
  return std::string(l.big ? "big" : "little") + (l.marks ? " marks" : "") + (l.multi ? " multi" : "") +
         (l.blanking ? " blanking" : "") + (l.doubles ? " doubles" : "") + (l.flat ? " flat" : "") +
         (l.text ? " text" : "");
}

/// Builds a file item by item.
class Writer {
 public:
  explicit Writer(const Layout& layout) : layout_(layout) {}

  template <typename T>
  void put(T value) {
    if (layout_.text) {
      std::array<char, 40> text{};
      const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
      record_.append(text.data(), end).append(record_.size() % 7 == 0 ? "\n" : " ");
      return;
    }
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (layout_.big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
    record_.append(bytes.data(), bytes.size());
  }
  void number(double value) {
    if (layout_.doubles) {
      put(value);
    } else {
      put(static_cast<float>(value));
    }
  }
  void end_record() {
    std::string record;
    record.swap(record_);
    const auto bytes = static_cast<std::int32_t>(record.size());
    if (layout_.marks) put(bytes);
    record_ += record;
    if (layout_.marks) put(bytes);
    file_ += record_;
    record_.clear();
  }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  Layout layout_;
  std::string record_;
  std::string file_;
};

std::vector<Index3> dims_of(const Layout& l) {
  std::vector<Index3> dims{{5, 4, 3}, {3, 6, 2}};
  if (!l.multi) dims.resize(1);
  for (Index3& n : dims) {
    if (l.flat) n.z = 1;
  }
  return dims;
}

int axes_of(const Layout& l) { return l.flat ? 2 : 3; }

void put_dimensions(Writer& w, const Layout& l) {
  if (l.multi) {
    w.put(static_cast<std::int32_t>(dims_of(l).size()));
    w.end_record();
  }
  for (const Index3& n : dims_of(l)) {
    for (int axis = 0; axis < axes_of(l); ++axis) w.put(static_cast<std::int32_t>(n[axis]));
  }
  w.end_record();
}

double coordinate(std::size_t grid, int axis, int i, int j, int k) {
  const std::array<int, 3> index{i, j, k};
  return 10.0 * static_cast<double>(grid) + index[static_cast<std::size_t>(axis)] * (1.0 + axis) +
         0.125 * (i + j + k);
}

template <typename Visit>
void for_points(const Index3& n, const Visit& visit) {
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) visit(i, j, k);
    }
  }
}

std::string grid_file(const Layout& l) {
  Writer w(l);
  put_dimensions(w, l);
  for (std::size_t g = 0; g < dims_of(l).size(); ++g) {
    for (int axis = 0; axis < axes_of(l); ++axis) {
      for_points(dims_of(l)[g], [&](int i, int j, int k) { w.number(coordinate(g, axis, i, j, k)); });
    }
    if (l.blanking) {
      for_points(dims_of(l)[g], [&](int i, int, int) { w.put(static_cast<std::int32_t>(i == 1 ? 0 : 1)); });
    }
    w.end_record();
  }
  return w.file();
}

double value(std::size_t grid, int variable, int i, int j, int k) {
  return 1.0 + variable + 0.25 * i + 0.5 * j - 0.125 * k + static_cast<double>(grid);
}

std::string solution_file(const Layout& l) {
  Writer w(l);
  put_dimensions(w, l);
  for (std::size_t g = 0; g < dims_of(l).size(); ++g) {
    for (const double condition : {2.95, 0.0, 2.1e6, 0.5}) w.number(condition);
    w.end_record();
    for (int variable = 0; variable < 5; ++variable) {
      if (l.flat && variable == 3) continue;  // no momentum along z
      for_points(dims_of(l)[g], [&](int i, int j, int k) { w.number(value(g, variable, i, j, k)); });
    }
    w.end_record();
  }
  return w.file();
}

std::vector<Layout> all_layouts() {
  std::vector<Layout> layouts;
  for (int bits = 0; bits < 64; ++bits) {
    layouts.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0,
                       (bits & 32) != 0});
  }
  return layouts;
}

std::optional<Plot3dLayout> find(const std::string& file, Plot3dFile kind) {
  const auto bytes = std::as_bytes(std::span(file));
  return find_plot3d_layout({bytes, bytes.last(std::min(bytes.size(), kPlot3dTailBytes)), bytes.size()},
                            kind);
}

TEST(Plot3dLayout, EveryLayoutIsFoundFromTheFileSize) {
  for (const Layout& l : all_layouts()) {
    const std::string file = grid_file(l);
    const auto found = find(file, Plot3dFile::kGrid);
    ASSERT_TRUE(found) << name(l);
    EXPECT_EQ(found->big_endian, l.big) << name(l);
    EXPECT_EQ(found->record_marks, l.marks) << name(l);
    EXPECT_EQ(found->multi_grid, l.multi) << name(l);
    EXPECT_EQ(found->blanking, l.blanking) << name(l);
    EXPECT_EQ(found->double_precision, l.doubles) << name(l);
    EXPECT_EQ(found->two_dimensional, l.flat) << name(l);
    EXPECT_EQ(found->grids, dims_of(l)) << name(l);
  }
}

TEST(Plot3dLayout, ATruncatedFileFitsNoLayout) {
  for (const Layout& l : all_layouts()) {
    const std::string file = grid_file(l);
    for (const std::size_t size :
         {file.size() - 4, file.size() / 2, std::size_t{12}, std::size_t{3}, std::size_t{0}}) {
      const std::string cut = file.substr(0, size);
      EXPECT_FALSE(find(cut, Plot3dFile::kGrid)) << name(l) << " cut to " << size;
    }
  }
}

TEST(Plot3dLayout, DimensionsWhoseProductOverflowsFitNoLayout) {
  Writer w({});
  for (int axis = 0; axis < 3; ++axis) w.put(std::int32_t{0x7fffffff});
  w.end_record();
  const std::string file = w.file() + std::string(4096, '\0');
  EXPECT_FALSE(find(file, Plot3dFile::kGrid));
}

std::vector<Layout> text_layouts() {
  std::vector<Layout> layouts;
  for (int bits = 0; bits < 8; ++bits) {
    layouts.push_back(
        {.multi = (bits & 1) != 0, .blanking = (bits & 2) != 0, .flat = (bits & 4) != 0, .text = true});
  }
  return layouts;
}

TEST(Plot3dLayout, TextIsFoundFromTheCountOfItsNumbers) {
  for (const Layout& l : text_layouts()) {
    const std::string file = grid_file(l);
    const auto found = find_plot3d_text_layout(file, Plot3dFile::kGrid);
    ASSERT_TRUE(found) << name(l);
    EXPECT_EQ(found->multi_grid, l.multi) << name(l);
    EXPECT_EQ(found->blanking, l.blanking) << name(l);
    EXPECT_EQ(found->two_dimensional, l.flat) << name(l);
    EXPECT_EQ(found->grids, dims_of(l)) << name(l);
    for (const std::string& wrong : {file + "1", file.substr(0, file.size() / 2), file + "x"})
      EXPECT_FALSE(find_plot3d_text_layout(wrong, Plot3dFile::kGrid)) << name(l);
  }
  EXPECT_FALSE(find_plot3d_text_layout("2147483647 2147483647 2147483647 1 2 3", Plot3dFile::kGrid));
}

TEST(Plot3d, EveryLayoutReadsBackGridAndSolution) {
  const test::TempFolder folder;
  std::vector<Layout> layouts = all_layouts();
  for (const Layout& l : text_layouts()) layouts.push_back(l);
  for (const Layout& l : layouts) {
    const auto grid = folder.write("grid.xyz", grid_file(l));
    const auto solution = folder.write("solution.q", solution_file(l));
    Source source = Source::open({{grid}, solution});
    const auto blocks = source.read({"Density", "Momentum", "StagnationEnergy"});
    ASSERT_EQ(blocks.size(), dims_of(l).size()) << name(l);
    for (std::size_t g = 0; g < blocks.size(); ++g) {
      const auto& topology = std::get<StructuredTopology>(blocks[g].topology);
      ASSERT_EQ(topology.points, dims_of(l)[g]) << name(l);
      EXPECT_EQ(source.info().blocks[g].not_volume.empty(), !l.flat) << name(l);
      ASSERT_EQ(blocks[g].arrays.size(), 3U) << name(l);
      std::size_t p = 0;
      for_points(dims_of(l)[g], [&](int i, int j, int k) {
        for (int axis = 0; axis < axes_of(l); ++axis) {
          ASSERT_EQ(topology.positions.at(p, axis), coordinate(g, axis, i, j, k)) << name(l);
          ASSERT_EQ(blocks[g].find("Momentum", Association::kPoint)->at(p, axis), value(g, 1 + axis, i, j, k))
              << name(l);
        }
        if (l.flat) {
          ASSERT_EQ(topology.positions.at(p, 2), 0.0) << name(l);
          ASSERT_EQ(blocks[g].find("Momentum", Association::kPoint)->at(p, 2), 0.0) << name(l);
        }
        ASSERT_EQ(blocks[g].find("Density", Association::kPoint)->at(p), value(g, 0, i, j, k)) << name(l);
        ASSERT_EQ(blocks[g].find("StagnationEnergy", Association::kPoint)->at(p), value(g, 4, i, j, k))
            << name(l);
        ASSERT_EQ(blocks[g].visible.empty(), !l.blanking) << name(l);
        if (l.blanking) {
          ASSERT_EQ(blocks[g].visible[p] != 0, i != 1) << name(l);
        }
        ++p;
      });
    }
  }
}

TEST(Plot3d, TextIsReadInDoublePrecisionAndAsFortranWritesIt) {
  const test::TempFolder folder;
  // 3 x 2 x 2 points 1e-9 apart at 1e6, of which a float holds none.
  const auto x = [](int i) { return 1e6 + 1e-9 * i; };
  struct Dialect {
    const char* name;
    bool repeats, exponent_d, commas;
  };
  for (const Dialect& d : {Dialect{"plain", false, false, false},
                           {"repeats", true, false, false},
                           {"D", false, true, false},
                           {"commas", false, false, true},
                           {"all", true, true, true}}) {
    const std::string gap = d.commas ? ", " : " ";
    std::string grid = d.repeats ? "3" + gap + "2*2\n" : "3" + gap + "2" + gap + "2\n";
    for (int p = 0; p < 12; ++p) {
      std::array<char, 40> text{};
      (void)std::snprintf(text.data(), text.size(), "%.17e", x(p % 3));
      std::string word = text.data();
      if (d.exponent_d) std::replace(word.begin(), word.end(), 'e', 'D');
      grid += word + gap + (p % 4 == 3 ? "\n" : "");
    }
    for (const int divisor : {3, 6}) {
      for (int p = 0; p < 12; p += divisor) {
        const std::string value = std::to_string(p / divisor % 2) + ".5";
        if (d.repeats) {
          grid += std::to_string(divisor) + "*" + value + gap;
        } else {
          for (int i = 0; i < divisor; ++i) grid += value + gap;
        }
      }
    }
    Source source = Source::open({{folder.write("grid.xyz", grid)}, {}});
    const auto blocks = source.read({});
    const auto& topology = std::get<StructuredTopology>(blocks.at(0).topology);
    for (int p = 0; p < 12; ++p) {
      const auto at = static_cast<std::size_t>(p);
      EXPECT_EQ(topology.positions.at(at, 0), x(p % 3)) << d.name;
      EXPECT_EQ(topology.positions.at(at, 1), 0.5 + p / 3 % 2) << d.name;
      EXPECT_EQ(topology.positions.at(at, 2), 0.5 + p / 6) << d.name;
    }
  }
  // A count that no memory holds is refused.
  EXPECT_FALSE(find_plot3d_text_layout("2000 2000 2000 24000000000*0.5", Plot3dFile::kGrid));
  EXPECT_FALSE(find_plot3d_text_layout("2 2 2 18446744073709551615*0.5", Plot3dFile::kGrid));
}

TEST(Plot3d, GridAndSolutionMayHaveLayoutsOfTheirOwn) {
  const test::TempFolder folder;
  const std::vector<Layout> layouts = all_layouts();
  for (std::size_t n = 0; n < layouts.size() / 2; n += 3) {  // the second half is flat
    const Layout& l = layouts[n];
    for (int differs = 0; differs < 4; ++differs) {
      Layout of_solution = l;
      if (differs == 0) of_solution.doubles = !l.doubles;
      if (differs == 1) of_solution.big = !l.big;
      if (differs == 2) of_solution.marks = !l.marks;
      if (differs == 3) of_solution.text = of_solution.doubles = true, of_solution.marks = false;
      const std::string what = name(l) + ", solution " + name(of_solution);
      Source source = Source::open(
          {{folder.write("grid.xyz", grid_file(l))}, folder.write("solution.q", solution_file(of_solution))});
      const auto blocks = source.read({"Density", "Momentum"});
      ASSERT_EQ(blocks.size(), dims_of(l).size()) << what;
      for (std::size_t g = 0; g < blocks.size(); ++g) {
        std::size_t p = 0;
        for_points(dims_of(l)[g], [&](int i, int j, int k) {
          const auto& topology = std::get<StructuredTopology>(blocks[g].topology);
          ASSERT_EQ(topology.positions.at(p, 1), coordinate(g, 1, i, j, k)) << what;
          ASSERT_EQ(blocks[g].find("Momentum", Association::kPoint)->at(p, 0), value(g, 1, i, j, k)) << what;
          if (l.blanking) {
            ASSERT_EQ(blocks[g].visible.at(p) != 0, i != 1) << what;
          }
          ++p;
        });
      }
    }
  }
}

TEST(Plot3d, ListsOfParaViewAreSeries) {
  const test::TempFolder folder;
  std::filesystem::create_directories(folder.path("run"));
  Layout doubles;
  doubles.doubles = true;
  (void)folder.write("run/a.xyz", grid_file({}));
  (void)folder.write("run/a.q", solution_file({}));
  (void)folder.write("run/b.q", solution_file(doubles));
  const auto list = folder.write(
      "all.p3d",
      R"({"auto-detect-format": true, "filenames": [{"time": 0.5, "xyz": "run/a.xyz", "q": "run/a.q"},)"
      R"( {"time": 2, "xyz": "run/a.xyz", "q": "run/b.q"}]})");
  Source source = Source::open({{list}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.5, 2.0}));
  for (const std::size_t step : {0, 1, 0})
    EXPECT_EQ(source.read({"Density"}, step).at(0).find("Density", Association::kPoint)->at(1),
              value(0, 0, 1, 0, 0));
  const auto refused = [&](const std::string& text, const std::string& why) {
    try {
      (void)Source::open({{folder.write("bad.p3d", text)}, {}});
      FAIL() << "was accepted: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused(R"({"filenames": [{"time": 0.5, "xyz": "run/gone.xyz"}]})", "gone.xyz");
  refused(R"({"filenames": [{"q": "run/a.q"}]})", "without a grid");
  refused(R"({"filenames": [{"time": 1, "xyz": "run/a.xyz"}, {"time": 1, "xyz": "run/a.xyz"}]})",
          "do not rise");
  refused(R"({"filenames": [{"time": 1)", "no list");
}

TEST(Plot3d, ASolutionOfAnotherGridIsRefused) {
  const test::TempFolder folder;
  const auto grid = folder.write("grid.xyz", grid_file({}));
  Layout multi;
  multi.multi = true;
  const auto solution = folder.write("solution.q", solution_file(multi));
  try {
    (void)Source::open({{grid}, solution});
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("solution.q"), std::string::npos) << error.what();
  }
}

TEST(Plot3d, ASolutionAloneSaysHowToOpenIt) {
  const test::TempFolder folder;
  const auto solution = folder.write("solution.q", solution_file({}));
  try {
    (void)Source::open({{solution}, {}});
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--solution"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate
