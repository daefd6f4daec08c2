#include "tests/docs/command_blocks.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(CommandBlocks, AreReadWithWhatTheyNeed) {
  const auto commands = printed_commands(
      "# Page\n\n```sh\nflow info a.vtk   # what it holds\n\n# a line for readers\nflow trace a.vtk \\\n"
      "  --seeds grid:2,2,2\n```\ntext\n```toml\nflow = 1\n```\n```sh window\n./run flow\n```\n");
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].text, "flow info a.vtk");
  EXPECT_EQ(commands[0].line, 4);
  EXPECT_EQ(commands[0].needs, "");
  EXPECT_EQ(commands[1].text, "flow trace a.vtk --seeds grid:2,2,2");
  EXPECT_EQ(commands[1].line, 7);
  EXPECT_EQ(commands[2].text, "./run flow");
  EXPECT_EQ(commands[2].needs, "window");
}

TEST(CommandBlocks, AreRefusedWhereNobodyWouldRunThem) {
  EXPECT_THROW((void)printed_commands("```sh dta\nflow\n```\n"), std::runtime_error);
  EXPECT_THROW((void)printed_commands("```sh\nflow\n"), std::runtime_error);
  EXPECT_THROW((void)printed_commands("text\n\n    ./run flow\n"), std::runtime_error);
}

}  // namespace
}  // namespace palpate::test
