// The main() of every test program. A program holds the tests of many files, and ctest runs them file by file:
//   common_ode_tests --file=tests/common/ode/root_test.cpp
// runs that file's tests alone, whatever --gtest_filter says.
#include <cstdio>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace {

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

/// Names of the tests whose file's path ends in `file`, as --gtest_filter takes them: a suite that lies in one
/// file by its name.
std::string tests_of(std::string_view file) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    std::string names;
    int found = 0;
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const testing::TestInfo& test = *suite.GetTestInfo(j);
      if (!ends_with(test.file(), file)) continue;
      names += std::string(suite.name()) + "." + test.name() + ":";
      ++found;
    }
    filter += found == suite.total_test_count() ? std::string(suite.name()) + ".*:" : names;
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  constexpr std::string_view kFile = "--file=";
  const std::string_view argument = argc > 1 ? argv[1] : "";
  if (argument.substr(0, kFile.size()) == kFile) {
    const std::string_view file = argument.substr(kFile.size());
    const std::string tests = tests_of(file);
    if (tests.empty()) {
      std::fprintf(stderr, "no test of this program stands in %s\n", argv[1] + kFile.size());
      return 2;
    }
    testing::FLAGS_gtest_filter = tests;
  }
  return RUN_ALL_TESTS();
}
