// What `cmake --install` lays down, package by package: nothing is left out of the packages, and what is installed
// works where it lies.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/e2e/program.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const char* const kPrograms[] = {"cardiac", "dtmri", "flow", "grid", "workbench"};

Names files_below(const fs::path& folder) {
  Names names;
  if (!fs::exists(folder)) return names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) names.insert(entry.path().lexically_relative(folder).string());
  }
  return names;
}

ProgramResult shell(const std::string& command, const fs::path& folder = ".") {
  return Program({"/bin/sh", "-c", command}, folder, {"DISPLAY=", "WAYLAND_DISPLAY="}).finish();
}

/// The packages that CPack makes.
Names packages() {
  Names names;
  std::smatch found;
  const std::string text = read_file(build_folder() / "CPackConfig.cmake");
  if (!std::regex_search(text, found, std::regex("set\\(CPACK_COMPONENTS_ALL \"([^\"]*)\"\\)"))) return names;
  const std::string list = found[1];
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = std::min(list.find(';', at), list.size());
    names.insert(list.substr(at, end - at));
    at = end + 1;
  }
  return names;
}

/// Everything, installed once for all tests.
class Installed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    install("all", "");
    for (const std::string& package : packages()) install(package, " --component " + package);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static void install(const std::string& name, const std::string& options) {
    const ProgramResult result = shell("cmake --install '" + build_folder().string() + "' --prefix '" +
                                       folder_->path(name).string() + "'" + options);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  static fs::path prefix(const std::string& name = "all") { return folder_->path(name); }

  static TempFolder* folder_;
};
TempFolder* Installed::folder_ = nullptr;

TEST_F(Installed, FilesAreEachInOnePackage) {
  std::map<std::string, std::string> package_of;
  for (const std::string& package : packages()) {
    for (const std::string& file : files_below(prefix(package))) {
      EXPECT_TRUE(package_of.emplace(file, package).second)
          << file << " is in " << package << " and in another";
    }
    EXPECT_TRUE(fs::exists(prefix(package) / "share/doc" / package / "copyright")) << package;
    EXPECT_TRUE(fs::exists(prefix(package) / "share/doc" / package / "changelog.gz")) << package;
  }
  for (const std::string& file : files_below(prefix()))
    EXPECT_TRUE(package_of.contains(file)) << file << " is in no package: its install() names no COMPONENT";
  EXPECT_GE(packages().size(), 10U);
}

TEST_F(Installed, ProgramsHavePagesWhereDebianLooks) {
  Names wanted{"palpate"};
  for (const std::string program : kPrograms) wanted.insert("palpate-" + program);
  Names programs = files_below(prefix() / "bin");
  // Built where MPI is; no shell completes what mpirun starts.
  if (programs.erase("palpate-mpi") > 0) {
    EXPECT_TRUE(fs::exists(prefix("palpate-mpi") / "share/man/man1/palpate-mpi.1.gz"));
  }
  EXPECT_EQ(programs, wanted);
  for (const std::string& name : wanted) {
    const std::string package = name == "palpate" ? "palpate-common" : name;
    for (const std::string& page :
         {"share/man/man1/" + name + ".1.gz", "share/bash-completion/completions/" + name,
          "share/zsh/vendor-completions/_" + name, "share/fish/vendor_completions.d/" + name + ".fish"}) {
      EXPECT_TRUE(fs::exists(prefix(package) / page)) << page;
    }
    EXPECT_NE(shell("gzip -dc '" + (prefix() / "share/man/man1" / (name + ".1.gz")).string() + "'")
                  .out.find(".SH NAME"),
              std::string::npos);
  }
}

TEST_F(Installed, ProgramsWorkWhereTheyLie) {
  for (const std::string program : kPrograms) {
    const ProgramResult result =
        shell("'" + (prefix() / "bin/palpate").string() + "' " + program + " --version");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find(program + " (Palpate) "), std::string::npos) << result.out;
  }
  // A helper program that is found beside them.
  const TempFolder folder;
  folder.write("a.nrrd",
               "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n0 1 2 3 4 5 6 7\n");
  const ProgramResult info =
      shell("'" + (prefix() / "bin/palpate-grid").string() + "' info a.nrrd --json", folder.path());
  EXPECT_EQ(info.exit_code, 0) << info.err;
}

TEST_F(Installed, FrontCommandIsCompletedByItsPrograms) {
  if (shell("command -v bash").exit_code != 0) GTEST_SKIP() << "there is no bash";
  const auto proposed = [&](const std::string& line) {
    return shell("bash -c 'source \"" + (prefix() / "share/bash-completion/completions/palpate").string() +
                 "\"; COMP_WORDS=(" + line +
                 "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _palpate; "
                 "echo \"${COMPREPLY[@]}\"'")
        .out;
  };
  EXPECT_EQ(proposed("palpate wo"), "workbench\n");
  EXPECT_EQ(proposed("palpate flow tr"), "trace\n");
  EXPECT_EQ(proposed("palpate flow trace --direction f"), "forward\n");
  EXPECT_EQ(proposed("palpate nothing tr"), "\n");
}

// As a file manager starts them: %i the file, %o what to write, whose name has no ending, %s the size.
TEST_F(Installed, ThumbnailersDraw) {
  const TempFolder folder;
  std::string volume = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nencoding: ascii\n\n";
  for (int i = 0; i < 512; ++i) volume += std::to_string(i % 251) + " ";
  folder.write("palpate-grid file.nrrd", volume);
  std::string tracts = "mrtrix tracks\ndatatype: Float32LE\ncount: 1\nfile: . 64\nEND\n";
  tracts.resize(64, '\n');
  const auto put = [&](float x, float y, float z) {
    for (const float value : {x, y, z}) tracts.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (int i = 0; i < 20; ++i) put(static_cast<float>(i), 0.1F * static_cast<float>(i * i), 0.0F);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInfinity = std::numeric_limits<float>::infinity();
  put(kNan, kNan, kNan);
  put(kInfinity, kInfinity, kInfinity);
  folder.write("palpate-dtmri file.tck", tracts);
  int drawn = 0;
  for (const auto& entry : fs::directory_iterator(prefix() / "share/thumbnailers")) {
    const std::string program = entry.path().stem().string();
    std::smatch found;
    const std::string text = read_file(entry.path());
    ASSERT_TRUE(std::regex_search(text, found, std::regex("\nExec=([^\n]*)")));
    std::string line = found[1];
    const std::string ending = program == "palpate-grid" ? ".nrrd" : ".tck";
    for (const auto& [sign, value] :
         {std::pair<std::string, std::string>{"%i", "'" + program + " file" + ending + "'"},
          {"%o", "out"},
          {"%s", "128"}})
      line.replace(line.find(sign), 2, value);
    folder.write("out", "");
    const ProgramResult result =
        shell("PATH='" + (prefix() / "bin").string() + "':\"$PATH\"; " + line, folder.path());
    EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.err;
    EXPECT_TRUE(read_file(folder.path("out")).starts_with("\x89PNG")) << line;
    ++drawn;
  }
  EXPECT_EQ(drawn, 2);
}

TEST_F(Installed, MesherIsApartFromItsProgram) {
  EXPECT_FALSE(fs::exists(prefix("palpate-cardiac") / "lib/palpate/palpate-mesh"));
  if (!fs::exists(build_folder() / "lib/palpate/palpate-mesh")) GTEST_SKIP() << "it is not built here";
  EXPECT_TRUE(fs::exists(prefix("palpate-mesh") / "lib/palpate/palpate-mesh"));
  EXPECT_NE(read_file(prefix("palpate-mesh") / "share/doc/palpate-mesh/copyright").find("AGPL-3"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
