#include "common/base/error.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(Error, InputErrorNamesFilePlaceFindingExpectationAndRemedyInOneLine) {
  const Error error = input_error({.file = "heart.vtk",
                                   .place = "line 7",
                                   .found = "'velocity' has 2 components",
                                   .expected = "3",
                                   .remedy = "choose another field with --field"});
  EXPECT_STREQ(
      error.what(),
      "heart.vtk: line 7: 'velocity' has 2 components; expected 3; choose another field with --field");
  EXPECT_EQ(error.code(), ExitCode::kBadInput);
}

TEST(Error, LeavesOutEmptyParts) {
  EXPECT_STREQ(input_error({.file = "a.vtk", .found = "no such file"}).what(), "a.vtk: no such file");
}

TEST(Error, CancelledCarriesTheShellsCodeForAnInterrupt) {
  EXPECT_EQ(static_cast<int>(Cancelled().code()), 130);
}

TEST(InputError, ShowsControlCharactersOfFilesAsText) {
  const Error error = input_error({"a\nb.vtk", "array '\x1b[31m'", "is r\xc3\xa4tselhaft\x7f", "", ""});
  EXPECT_STREQ(error.what(), "a\\x0ab.vtk: array '\\x1b[31m': is r\xc3\xa4tselhaft\\x7f");
}

}  // namespace
}  // namespace palpate::test
