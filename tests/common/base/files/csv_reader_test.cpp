#include "common/base/files/csv_reader.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr std::array<std::string_view, 2> kRequired{"x", "y"};
constexpr std::array<std::string_view, 1> kOptional{"b0"};
using Row = std::array<double, 3>;

std::vector<Row> rows_of(const std::string& file) {
  CsvReader table(file, kRequired, kOptional, "a table x,y");
  std::vector<Row> rows;
  for (Row row{}; table.next(row);) rows.push_back(row);
  return rows;
}

class CsvReaderTest : public testing::Test {
 protected:
  std::vector<Row> read(const std::string& text) { return rows_of(folder_.write("t.csv", text).string()); }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      const std::string line = error.what();
      return line.substr(line.find("t.csv: ") + 7);
    }
    return "accepted";
  }
  TempFolder folder_;
};

TEST_F(CsvReaderTest, FindsColumnsByNameAndPassesOverBlanksAndComments) {
  const auto rows =
      read("\xEF\xBB\xBF# made by hand\r\n\r\nname,\"Y\", b0 ,x\r\na,2,1,+1\r\n# b\r\n\r\nb, 4 ,0,3");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0], (Row{1.0, 2.0, 1.0}));
  EXPECT_EQ(rows[1], (Row{3.0, 4.0, 0.0}));
}

TEST_F(CsvReaderTest, GivesNanForAMissingOptionalColumnAndKeepsNumbersThatAreNotFinite) {
  const auto rows = read("x,y\nnan,-inf\n");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(std::isnan(rows[0][0]));
  EXPECT_EQ(rows[0][1], -HUGE_VAL);
  EXPECT_TRUE(std::isnan(rows[0][2]));
}

TEST_F(CsvReaderTest, NamesTheLineAndWhatWasExpected) {
  EXPECT_EQ(refusal(""), "is empty; expected a table x,y");
  EXPECT_EQ(refusal("# only\n\n"), "is empty; expected a table x,y");
  EXPECT_EQ(refusal("\n1,2\n"), "line 2: has no column x; expected a table x,y");
  EXPECT_EQ(refusal("x,y\n1,2\n\n1\n"), "line 4: has 1 field; expected 2 as in the header x,y");
  EXPECT_EQ(refusal("x,y\n1,2,3\n"), "line 2: has 3 fields; expected 2 as in the header x,y");
  EXPECT_EQ(refusal("x,y\n1,two\n"), "line 2: no number in column y; expected a number");
  EXPECT_EQ(refusal("x,y\n1,\n"), "line 2: no number in column y; expected a number");
  EXPECT_EQ(refusal(std::string("x,y\n1,2\0\n", 9)), "line 2: no number in column y; expected a number");
}

TEST_F(CsvReaderTest, ReadsNoMoreOfALineThanItsLimit) {
  const std::string longest(LineReader::kLongestLine - 4, ' ');
  EXPECT_EQ(read("x,y\n1,2" + longest + "\n").size(), 1U);
  EXPECT_EQ(refusal("x,y\n1,2" + longest + "   \n").substr(0, 22), "line 2: is longer than");
  EXPECT_THROW((void)rows_of("/dev/zero"), Error);
  EXPECT_THROW((void)rows_of(folder_.path().string()), Error);
  EXPECT_THROW((void)rows_of(folder_.path("missing.csv").string()), Error);
}

TEST_F(CsvReaderTest, SaysWhetherTheLastLineWasEnded) {
  for (const bool ended : {true, false}) {
    LineReader lines(folder_.write("a.txt", ended ? "one\ntwo\n" : "one\ntwo").string(), "text");
    ASSERT_TRUE(lines.next());
    EXPECT_TRUE(lines.complete());
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.line(), "two");
    EXPECT_EQ(lines.number(), 2U);
    EXPECT_EQ(lines.complete(), ended);
    EXPECT_FALSE(lines.next());
  }
}

}  // namespace
}  // namespace palpate::test
