#include "common/scene/session.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/scene/sha256.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

Session sample_session(const TempFolder& folder) {
  Session session{.program = "flow"};
  session.inputs.push_back(describe_input(folder.write("data/flow \"1\".vtk", "abc"), false));
  session.inputs.push_back(describe_input(folder.write("q.bin", ""), true));
  session.options = {{"camera", "30,20,0,1"}, {"field", "velocity \\ \u00e9"}, {"seeds", "grid:2,2,2"}};
  return session;
}

TEST(Session, ComesBackAsItWasSaved) {
  const TempFolder folder;
  const Session saved = sample_session(folder);
  save_session(folder.path("s.toml"), saved);
  const Session read = load_session(folder.path("s.toml"));
  EXPECT_EQ(read.program, "flow");
  EXPECT_EQ(read.options, saved.options);
  ASSERT_EQ(read.inputs.size(), 2U);
  EXPECT_TRUE(std::filesystem::equivalent(read.inputs[0].file, saved.inputs[0].file));
  EXPECT_EQ(read.inputs[0].bytes, 3U);
  EXPECT_EQ(read.inputs[0].sha256, sha256_of("abc"));
  EXPECT_FALSE(read.inputs[0].solution);
  EXPECT_TRUE(read.inputs[1].solution);
  EXPECT_TRUE(changed_inputs(read).empty());
}

TEST(Session, HasTheLinesThatWereDrawnByHandBesideIt) {
  const TempFolder folder;
  Session saved = sample_session(folder);
  saved.lines = describe_input(folder.write("s.lines.csv", "lines"), false);
  save_session(folder.path("s.toml"), saved);
  EXPECT_EQ(read_file(folder.path("s.toml")).find(folder.path("s.lines.csv").string()), std::string::npos)
      << "it moves with it";
  const Session read = load_session(folder.path("s.toml"));
  ASSERT_TRUE(read.lines);
  EXPECT_TRUE(std::filesystem::equivalent(read.lines->file, folder.path("s.lines.csv")));
  EXPECT_EQ(read.inputs.size(), 2U);
  EXPECT_EQ(change_of(*read.lines), "");
  folder.write("s.lines.csv", "line");
  EXPECT_NE(change_of(*read.lines).find("has changed"), std::string::npos);
  EXPECT_TRUE(changed_inputs(read).empty());
}

TEST(Session, MovesWithTheFilesBelowIt) {
  const TempFolder folder;
  save_session(folder.path("s.toml"), sample_session(folder));
  const TempFolder other;
  const auto target = other.path("moved");
  std::filesystem::rename(folder.path(), target);
  const Session read = load_session(target / "s.toml");
  EXPECT_EQ(read_file(read.inputs[0].file), "abc");
  std::filesystem::create_directories(folder.path());  // for its own clean-up
}

TEST(Session, SaysWhichInputChangedOrIsGone) {
  const TempFolder folder;
  save_session(folder.path("s.toml"), sample_session(folder));
  folder.write("data/flow \"1\".vtk", "abd");
  std::filesystem::remove(folder.path("q.bin"));
  const auto sentences = changed_inputs(load_session(folder.path("s.toml")));
  ASSERT_EQ(sentences.size(), 2U);
  EXPECT_NE(sentences[0].find("has changed"), std::string::npos);
  EXPECT_NE(sentences[1].find("missing"), std::string::npos);
}

TEST(Session, KnowsAFolderByTheFilesInIt) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path("series"));
  folder.write("series/b", "de");
  folder.write("series/a", "abc");
  Session session;
  session.program = "grid";
  session.inputs = {describe_input(folder.path("series"), false)};
  EXPECT_EQ(session.inputs[0].bytes, 5U);
  EXPECT_EQ(session.inputs[0].sha256, sha256_of(sha256_of("abc") + "  a\n" + sha256_of("de") + "  b\n"));
  save_session(folder.path("s.toml"), session);
  EXPECT_TRUE(changed_inputs(load_session(folder.path("s.toml"))).empty());
  folder.write("series/c", "");
  const auto grown = changed_inputs(load_session(folder.path("s.toml")));
  ASSERT_EQ(grown.size(), 1U);
  EXPECT_NE(grown[0].find("has changed"), std::string::npos);
  std::filesystem::remove_all(folder.path("series"));
  const auto gone = changed_inputs(load_session(folder.path("s.toml")));
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_NE(gone[0].find("missing"), std::string::npos);
}

TEST(Session, RefusesOtherFilesWithThePlace) {
  const TempFolder folder;
  const auto refused = [&](const char* text) {
    try {
      (void)load_session(folder.write("s.toml", text));
    } catch (const Error& error) {
      return std::to_string(static_cast<int>(error.code())) + " " + error.what();
    }
    return std::string("accepted");
  };
  EXPECT_NE(refused("format = 1\n[scene\n").find("line 2"), std::string::npos);
  EXPECT_EQ(refused("").front(), '3');
  EXPECT_EQ(refused("format = 0\n[scene]\n").front(), '3');
  EXPECT_EQ(refused("format = 1\n").front(), '3');
  EXPECT_NE(refused("format = 1\n[scene]\ntolerance = 3\n").find("'tolerance'"), std::string::npos);
  EXPECT_EQ(refused("format = 1\n[[input]]\nbytes = 3\n[scene]\n").front(), '3');
  EXPECT_THROW((void)load_session(folder.path("missing.toml")), Error);
  EXPECT_THROW((void)load_session(folder.path()), Error);
}

TEST(Session, LeavesNothingBehindWhereItCannotBeWritten) {
  const TempFolder folder;
  EXPECT_THROW(save_session(folder.path("no/such/folder/s.toml"), Session{}), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace palpate::test
