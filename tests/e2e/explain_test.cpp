// What `--explain` says, against what the system saw: files opened and libraries mapped (by a library that is preloaded),
// programs started, shaders compiled (by Mesa, which writes each that it links),
// textures allocated.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/json.h"
#include "tests/e2e/watched_program.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

struct Seen : Watched {
  std::size_t shaders = 0;  ///< programs linked, those that are the same once
  Json explain;
};

/// Runs a command in `folder` with --explain, under watch.
/// @param window_seconds as watched(); on the display of the test.
Seen watch(const TempFolder& folder, std::vector<std::string> command, double window_seconds = 0.0) {
  for (const char* option : {"--json", "--explain", "--quiet"}) command.emplace_back(option);
  const TempFolder aside;
  const fs::path shaders = aside.path("shaders");
  fs::create_directory(shaders);
  std::vector<std::string> environment{"MESA_SHADER_CAPTURE_PATH=" + shaders.string(),
                                       "MESA_SHADER_CACHE_DISABLE=true"};
  if (window_seconds == 0.0) environment.insert(environment.end(), {"DISPLAY=", "WAYLAND_DISPLAY="});
  Seen seen{watched(std::move(command), folder.path(), environment, window_seconds)};
  if (seen.result.exit_code != (window_seconds > 0.0 ? 130 : 0)) return seen;
  seen.explain = parse_json(seen.result.out).at("explain");
  // Contexts that draw the same link the same: those that differ count.
  std::set<std::string> linked;
  for (const auto& entry : fs::directory_iterator(shaders)) linked.insert(read_file(entry.path()));
  seen.shaders = linked.size();
  return seen;
}

/// The rest of `what` of the rows that begin with `kind`, done or left out.
std::set<std::string> rows(const Seen& seen, const std::string& kind, bool done) {
  std::set<std::string> names;
  for (const auto& row : seen.explain) {
    const std::string what = row.at("what");
    if (what.starts_with(kind) && (row.at("times").get<int>() > 0) == done)
      names.insert(what.substr(kind.size()));
  }
  return names;
}

void expect_true(const Seen& seen, const std::string& program) {
  std::set<std::string> files;
  for (const std::string& file : rows(seen, "file ", true)) files.insert(fs::path(file).filename());
  std::set<std::string> started;
  for (const auto& [name, opened] : seen.opened) {
    if (name != program && !name.empty()) started.insert(name);
    for (const std::string& file : opened) {
      const bool told = std::any_of(files.begin(), files.end(), [&](const std::string& known) {
        return file.find(known) != std::string::npos;  // an output has a temporary name, until it is whole
      });
      EXPECT_TRUE(told) << name << " opened " << file << ", of which nothing is said:\n"
                        << seen.explain.dump(1);
    }
  }
  EXPECT_EQ(rows(seen, "helper ", true), started);
  for (const std::string& helper : rows(seen, "helper ", false))
    EXPECT_FALSE(started.contains(helper)) << helper;
  EXPECT_EQ(rows(seen, "program ", true).size(), seen.shaders) << seen.explain.dump(1);
  std::set<std::string> textures = rows(seen, "texture ", true);
  textures.erase("of labels and panels");  // Dear ImGui's, which does not go through libepoxy
  EXPECT_EQ(textures, seen.textures.at(program)) << seen.explain.dump(1);
  for (const std::string& library : seen.mapped.at(program)) {
    for (const char* foreign : {"libvtk", "libteem", "libopenvdb", "libniftiio", "libgdcm", "libCGAL",
                                "libtet", "liblapack", "libblas", "libceres", "libusb"})
      EXPECT_FALSE(library.starts_with(foreign)) << program << " maps " << library;
  }
}

/// A volume of bytes, 9 x 8 x 7.
void write_volume(const fs::path& path) {
  std::ofstream out(path, std::ios::binary);
  out << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 8 7\nencoding: raw\n\n";
  for (int i = 0; i < 9 * 8 * 7; ++i) out.put(static_cast<char>(i % 251));
}

TEST(Explain, OfALoadedFieldIsWhatTheSystemSaw) {
  TempFolder folder;
  std::ofstream(folder.path("flow.vtk"))
      << "# vtk DataFile Version 3.0\nmade\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
         "SPACING 1 1 1\nPOINT_DATA 8\nSCALARS unused float 1\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n"
         "VECTORS velocity float\n1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0\n";
  const Seen seen =
      watch(folder, {"flow", "trace", "flow.vtk", "--seeds", "grid:2,2,2", "--out", "lines.vtp"});
  expect_true(seen, "flow");
  EXPECT_EQ(seen.shaders, 0U);
  EXPECT_TRUE(rows(seen, "array ", true).contains("velocity"));
  EXPECT_TRUE(rows(seen, "array ", false).contains("unused"));
  EXPECT_TRUE(rows(seen, "file ", true).contains("flow.vtk"));
}

TEST(Explain, OfWindowsIsWhatWasAllocated) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  constexpr double kSeconds = 12.0;  // long enough for the first picture
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"flow", "--example=abc"}, {"grid", "volume.nrrd"}}) {
    SCOPED_TRACE(command[0]);
    TempFolder folder;
    write_volume(folder.path("volume.nrrd"));
    const Seen seen = watch(folder, command, kSeconds);
    std::set<std::string> textures = rows(seen, "texture ", true);
    textures.erase("of labels and panels");  // Dear ImGui's
    EXPECT_EQ(textures, seen.textures.at(command[0])) << seen.explain.dump(1);
    EXPECT_FALSE(textures.empty());
    EXPECT_TRUE(rows(seen, "window system", true).contains(""));
    EXPECT_TRUE(std::any_of(seen.mapped.at(command[0]).begin(), seen.mapped.at(command[0]).end(),
                            [](const std::string& library) { return library.starts_with("libglfw"); }));
  }
}

TEST(Explain, OfPicturesIsWhatWasCompiled) {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"flow", "render", "--example", "abc", "--size", "96x64", "--out", "a.png"},
        {"grid", "render", "volume.nrrd", "--size", "96x64", "--out", "a.png"},
        {"grid", "render", "volume.nrrd", "--size", "96x64", "--layout", "4", "--out", "a.png"},
        {"dtmri", "render", "--example", "helix", "--size", "96x64", "--out", "a.png"}}) {
    TempFolder folder;
    write_volume(folder.path("volume.nrrd"));
    const Seen seen = watch(folder, command);
    SCOPED_TRACE(command[0] + " " + command[1]);
    if (seen.shaders == 0) GTEST_SKIP() << "OpenGL is not Mesa's, which tells what it compiles";
    expect_true(seen, command[0]);
  }
}

}  // namespace
}  // namespace palpate::test
