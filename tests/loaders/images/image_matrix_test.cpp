// Images of one formula in every dialect that the formats have: encoding x type of number x byte order, in turn along
// axes that are straight, mirrored, exchanged and oblique. Each file is written here byte by byte, so that no reader or
// writer vouches for another, and each is right or refused. The table is part of loaders/README.md:
//   PALPATE_WRITE_PAGES=1 ctest --preset release -R image_matrix_test

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/load.h"
#include "tests/loaders/images/image_dialects.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test::matrix {
namespace {

/// Empty: every voxel lies where it should and has its value.
std::string wrong(const std::filesystem::path& file, const Dialect& dialect, const Wanted& wanted) {
  Source source = Source::open({{file}, {}});
  if (source.info().anatomical != dialect.patient) return "coordinates are a patient's, or not";
  const DataSet block = source.read({source.arrays().at(0).name}).at(0);
  const auto& lattice = std::get<UniformTopology>(block.topology);
  const DataArray& values = block.arrays.at(0);
  if (values.tuples != kCount) return std::to_string(values.tuples) + " values";
  const Mat3 back = glm::inverse(wanted.placement.axes());
  std::size_t at = 0;
  for (int k = 0; k < lattice.points.z; ++k)
    for (int j = 0; j < lattice.points.y; ++j)
      for (int i = 0; i < lattice.points.x; ++i, ++at) {
        const Vec3 x = lattice.origin + lattice.axes * Vec3(i, j, k);
        const Vec3 voxel = back * (x - wanted.placement.origin);
        if (glm::distance(voxel, glm::round(voxel)) > 1e-5) return "a voxel lies beside its place";
        const double value = value_at(wanted.type, glm::round(voxel));
        if (values.at(at) != value)
          return exact_number(values.at(at)) + " in place of " + exact_number(value);
      }
  return {};
}

std::string table_of(const std::vector<std::vector<std::string>>& rows) {
  std::string text = "| format | encoding |";
  for (const NumberType& type : kTypes) text += std::string(" ") + type.name + " |";
  text += "\n|---|---|";
  for (std::size_t t = 0; t < kTypes.size(); ++t) text += "---|";
  text += "\n";
  for (const auto& row : rows) {
    text += "|";
    for (const std::string& cell : row) text += " " + cell + " |";
    text += "\n";
  }
  return text;
}

TEST(ImageMatrix, EveryDialectIsRightOrRefused) {
  const TempFolder folder;
  std::vector<std::vector<std::string>> rows;
  std::size_t turn = 0;
  for (const Dialect& dialect : dialects()) {
    std::vector<std::string> row{dialect.format, dialect.encoding};
    for (const NumberType& type : kTypes) {
      std::size_t right = 0, refused = 0;
      for (std::size_t run = 0; run < 4; ++run, ++turn) {
        // Both byte orders, and of placements two, others for the next type.
        const Wanted wanted{type, run % 2 == 1, kPlacements[(turn / 2) % kPlacements.size()]};
        std::optional<File> file = dialect.write(wanted);
        if (!file) file = dialect.write({type, run % 2 == 1, kPlacements[0]});
        if (!file) continue;
        const Wanted written = dialect.write(wanted) ? wanted : Wanted{type, wanted.big, kPlacements[0]};
        for (const auto& [name, content] : file->beside) folder.write(name, content);
        const auto path = folder.write(file->name, file->content);
        const std::string what = std::string(dialect.format) + ", " + dialect.encoding + ", " + type.name +
                                 ", " + (written.big ? "big" : "little") + ", " + written.placement.name;
        try {
          const std::string fault = wrong(path, dialect, written);
          EXPECT_EQ(fault, "") << what;
          right += fault.empty() ? 1 : 0;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ExitCode::kBadInput) << what << ": " << error.what();
          ++refused;
          RecordProperty(what, error.what());
        }
        std::filesystem::remove(path);
        for (const auto& [name, content] : file->beside) std::filesystem::remove(folder.path(name));
      }
      EXPECT_TRUE(right == 0 || refused == 0)
          << dialect.format << ", " << dialect.encoding << ", " << type.name;
      row.emplace_back(right > 0 ? "right" : refused > 0 ? "refused" : "-");
    }
    rows.push_back(std::move(row));
  }

  const auto page = source_folder() / "loaders" / "README.md";
  std::string text = read_file(page);
  const std::string begin = "<!-- images -->\n", end = "<!-- end of images -->\n";
  const std::size_t from = text.find(begin), to = text.find(end);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  const std::string there = text.substr(from + begin.size(), to - from - begin.size());
  if (std::getenv("PALPATE_WRITE_PAGES") != nullptr) {
    std::ofstream(page) << text.replace(from + begin.size(), there.size(), table_of(rows));
  } else {
    EXPECT_EQ(there, table_of(rows)) << "write it again: PALPATE_WRITE_PAGES=1 ctest -R image_matrix_test";
  }
}

/// Text that the type does not hold as it is written is refused, or is that number: never the part of it that a reader
/// takes for one.
TEST(ImageMatrix, WordsThatAreNoNumbersOfTheTypeAreNotTakenForOthers) {
  const TempFolder folder;
  struct Case {
    std::size_t type;
    const char* word;
    double value;  ///< NaN: it is none of that type
  };
  const double none = std::nan("");
  for (const Case& one :
       {Case{2, "1.5", none},   Case{2, "2e3", 2000.0}, Case{2, "40000", none}, Case{2, "-32769", none},
        Case{3, "-1", none},    Case{3, "65536", none}, Case{1, "256", none},   Case{1, "0x10", none},
        Case{4, "12.", 12.0},   Case{4, "1_000", none}, Case{5, "4e9", 4e9},    Case{6, "1e-1", none},
        Case{8, "0.5x", none},  Case{8, "1.5.2", none}, Case{9, "1,5", none},   Case{9, "--3", none},
        Case{4, "seven", none}, Case{8, "1d3", none},   Case{2, "+7", 7.0},     Case{9, "+0.25", 0.25}}) {
    for (const Dialect& dialect : dialects()) {
      const std::string encoding = dialect.encoding;
      if (encoding.find("ascii") == std::string::npos && encoding.find("text") == std::string::npos) continue;
      const NumberType& type = kTypes[one.type];
      const auto file = dialect.write({type, false, kPlacements[0]});
      if (!file) continue;
      std::string content = file->content;
      const std::string first = number_text(type, value_at(type, Vec3{0.0})) + " ";
      content.replace(content.rfind(first + number_text(type, value_at(type, {1.0, 0.0, 0.0}))),
                      first.size() - 1, one.word);
      const auto path = folder.write(file->name, content);
      const std::string what =
          std::string(dialect.format) + ", " + encoding + ", " + type.name + ": " + one.word;
      try {
        Source source = Source::open({{path}, {}});
        const double found = source.read({source.arrays().at(0).name}).at(0).arrays.at(0).at(0);
        EXPECT_EQ(found, one.value) << what;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput) << what;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test::matrix
