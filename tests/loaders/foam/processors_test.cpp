// OpenFOAM cases in the folders of processors, one each or collated.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "common/trace/trace.h"
#include "loaders/vtk/foam/foam_collated.h"
#include "loaders/vtk/foam/foam_text.h"
#include "tests/loaders/foam/foam_box.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

using test::border;
using test::FoamBox;
using test::helix;
using test::kFree;
using test::says;
using test::vectors_of_cells;
namespace fs = std::filesystem;

/// In 1, 2 or 4 parts.
void write_parts(const fs::path& folder, int parts, bool binary, const std::set<std::string>& times) {
  constexpr int kN = 6;
  const auto rank_of = [parts](const Index3& cube) {
    return parts == 1 ? 0 : (cube.x >= kN / 2 ? 1 : 0) + (parts == 4 && cube.y >= kN / 3 ? 2 : 0);
  };
  FoamBox::write_control(folder);
  fs::create_directories(folder / "constant");
  for (int rank = 0; rank < parts; ++rank) {
    const FoamBox box(kN, border, rank_of, rank);
    const fs::path part = parts == 1 ? folder : folder / ("processor" + std::to_string(rank));
    box.write_mesh(part, binary);
    for (const std::string& time : times) box.write_vectors(part / time / "U", binary, helix, kFree);
  }
}

/// Lines follow the helix to the border of the box.
void expect_helices(const std::vector<DataSet>& blocks) {
  const auto field = vectors_of_cells(blocks);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> side(-0.7, 0.7), up(0.05, 0.4);
  std::vector<Vec3> from;
  for (int i = 0; i < 40; ++i) {
    const double x = side(random), y = side(random);
    from.emplace_back(x, y, up(random));
  }
  TraceOptions options;
  options.integrator = Integrator::kExact;
  options.threads = 1;
  for (const Line& line : trace_lines(*field, from, options).lines) {
    const Vec3& x0 = from[line.seed];
    const LinePoint& last = line.points.back();
    EXPECT_EQ(line.end, End::kLeftDomain);
    const double out =
        std::max({std::abs(last.position.x), std::abs(last.position.y), last.position.z - 1.0});
    EXPECT_NEAR(out, 1.0, 3e-6) << line.seed;
    const double c = std::cos(last.time), s = std::sin(last.time);
    EXPECT_LE(
        glm::distance(last.position, {c * x0.x - s * x0.y, s * x0.x + c * x0.y, x0.z + 0.3 * last.time}),
        1e-6);
  }
}

TEST(FoamProcessors, AreOneCase) {
  for (const bool binary : {false, true}) {
    for (const int parts : {1, 2, 4}) {
      SCOPED_TRACE(parts);
      const test::TempFolder folder;
      write_parts(folder.path(), parts, binary, {"0", "1"});
      Source source = Source::open({{folder.path()}, {}});
      EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 1.0}));
      ASSERT_EQ(source.info().blocks.size(), static_cast<std::size_t>(parts));
      EXPECT_EQ(says(source.info().notes, "processor folders read as one case"), parts > 1);
      const auto blocks = source.read({"U"}, 1);
      ASSERT_EQ(blocks.size(), static_cast<std::size_t>(parts));
      if (parts > 1) {
        EXPECT_EQ(blocks[1].name.substr(0, 10), "processor1");
      }
      expect_helices(blocks);
    }
  }
}

TEST(FoamProcessors, TimesThatNotAllHaveAreLeftOut) {
  const test::TempFolder folder;
  write_parts(folder.path(), 2, false, {"0", "1", "2"});
  fs::remove_all(folder.path("processor1/1"));
  Source source = Source::open({{folder.path()}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 2.0}));
  EXPECT_TRUE(says(source.info().notes, "1 time left out: not all"));
  EXPECT_EQ(source.read({"U"}, 1).size(), 2U);
  // One of them has a single time.
  fs::remove_all(folder.path("processor1/0"));
  Source last = Source::open({{folder.path()}, {}});
  EXPECT_TRUE(says(last.info().notes, "2 times left out: not all"));
  expect_helices(last.read({"U"}, 0));
  fs::remove_all(folder.path("processor0/2"));
  EXPECT_THROW((void)Source::open({{folder.path()}, {}}), Error);
  // Both have.
  fs::remove_all(folder.path("processor0/0"));
  EXPECT_THROW((void)Source::open({{folder.path()}, {}}), Error);
}

TEST(FoamProcessors, AreReadWhereTheCaseHasOnlyItsStart) {
  const test::TempFolder folder;
  write_parts(folder.path(), 1, false, {"0"});
  write_parts(folder.path(), 2, false, {"0", "1"});
  Source source = Source::open({{folder.path()}, {}});
  EXPECT_TRUE(says(source.info().notes, "they go on after time 0"));
  expect_helices(source.read({"U"}, 1));
  write_parts(folder.path(), 1, false, {"1"});
  Source own = Source::open({{folder.path()}, {}});
  EXPECT_TRUE(says(own.info().notes, "the case's own times are read"));
  EXPECT_EQ(own.read({"U"}, 1).size(), 1U);
}

/// Puts the files of processor folders into collated ones of `each` processors, as OpenFOAM's fileHandler does: the
/// block of the first processor has the header of all.
void collate(const fs::path& folder, int parts, int each) {
  for (int first = 0; first < parts; first += each) {
    const std::string name =
        "processors" + std::to_string(parts) +
        (each < parts ? "_" + std::to_string(first) + "-" + std::to_string(first + each - 1) : "");
    const fs::path from = folder / ("processor" + std::to_string(first));
    for (const auto& entry : fs::recursive_directory_iterator(from)) {
      if (!entry.is_regular_file()) continue;
      const fs::path inside = fs::relative(entry.path(), from);
      std::string text =
          "FoamFile\n{\n version 2.0;\n format binary;\n class decomposedBlockData;\n object " +
          inside.filename().string() + ";\n}\n\n";
      for (int rank = first; rank < first + each; ++rank) {
        std::ifstream in(folder / ("processor" + std::to_string(rank)) / inside, std::ios::binary);
        std::string block((std::istreambuf_iterator<char>(in)), {});
        if (rank > first) block.erase(0, block.find("}\n") + 2);
        text += "\n// Processor" + std::to_string(rank) + "\n" + std::to_string(block.size()) + "\n(" +
                block + ")\n";
      }
      FoamBox::write(folder / name / inside, text);
    }
  }
  for (int rank = 0; rank < parts; ++rank) fs::remove_all(folder / ("processor" + std::to_string(rank)));
}

std::size_t temporary_folders() {
  std::size_t out = 0;
  for (const auto& entry : fs::directory_iterator(fs::temp_directory_path()))
    out += entry.path().filename().string().starts_with("palpate-foam-") ? 1 : 0;
  return out;
}

TEST(FoamProcessors, CollatedOnesAreParted) {
  for (const bool binary : {false, true}) {
    for (const int each : {4, 2, 1}) {
      SCOPED_TRACE(each);
      const test::TempFolder folder;
      write_parts(folder.path(), 4, binary, {"0", "1"});
      FoamBox::write(folder.path("processor0/1/uniform/time"), "value 1;\n");
      collate(folder.path(), 4, each);
      const std::size_t before = temporary_folders();
      {
        Source source = Source::open({{folder.path()}, {}});
        EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 1.0}));
        EXPECT_TRUE(says(source.info().notes, "4 processor folders read as one case"));
        EXPECT_TRUE(says(source.info().notes, "parted into temporary files"));
        const auto blocks = source.read({"U"}, 1);
        ASSERT_EQ(blocks.size(), 4U);
        EXPECT_EQ(blocks[3].name.substr(0, 10), "processor3");
        expect_helices(blocks);
      }
      // Whoever removes them learns that the helper has ended.
      for (int n = 0; n < 500 && temporary_folders() > before; ++n)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      EXPECT_EQ(temporary_folders(), before);
    }
  }
}

TEST(FoamProcessors, ADamagedCollatedFileIsNamed) {
  const test::TempFolder folder;
  write_parts(folder.path(), 2, false, {"0"});
  collate(folder.path(), 2, 2);
  fs::resize_file(folder.path("processors2/0/U"), fs::file_size(folder.path("processors2/0/U")) - 20);
  try {
    (void)Source::open({{folder.path()}, {}});
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("processors2/0/U"), std::string::npos) << error.what();
  }
}

TEST(FoamProcessors, BlocksHaveTheHeaderThatTheirFileSays) {
  const std::string outer =
      "FoamFile { format ascii; class decomposedBlockData; data.class volVectorField; "
      "data.format binary; object U; }\n";
  const auto blocks = part_foam_blocks(outer + "// Processor0\n3\n(abc)\n// Processor1\n0\n");
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_NE(blocks[0].find("class volVectorField"), std::string::npos);
  EXPECT_NE(blocks[1].find("format binary"), std::string::npos);
  EXPECT_EQ(blocks[0].substr(blocks[0].size() - 3), "abc");
  EXPECT_TRUE(part_foam_blocks("FoamFile { class volVectorField; }\n3(abc)").empty());
  EXPECT_THROW((void)part_foam_blocks(outer + "9\n(abc)"), FoamMalformed);
  EXPECT_EQ(foam_processors_of("processors8_4-7"), std::pair(4, 4));
  EXPECT_EQ(foam_processors_of("processors3"), std::pair(0, 3));
  EXPECT_EQ(foam_processors_of("processors2_1-5"), std::pair(0, 0));
}

TEST(FoamProcessors, NeedNoConstantBeside) {
  const test::TempFolder folder;
  write_parts(folder.path(), 2, false, {"0", "1"});
  fs::remove_all(folder.path("constant"));
  expect_helices(Source::open({{folder.path()}, {}}).read({"U"}, 1));
  std::ofstream(folder.path("a.foam")) << "";
  expect_helices(Source::open({{folder.path("a.foam")}, {}}).read({"U"}, 1));
}

}  // namespace
}  // namespace palpate
