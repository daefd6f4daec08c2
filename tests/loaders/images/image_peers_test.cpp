// The images of image_dialects.h read by other programs' libraries, so that the formula and the formats vouch for them, not
// this suite's readers alone: by VTK, nibabel and pydicom, where these are installed. One that refuses a kind is no fault.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "common/base/json.h"
#include "tests/loaders/images/image_dialects.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test::matrix {
namespace {

// Debian's interpreter, which finds Debian's packages.
constexpr const char* kPython = "/usr/bin/python3";

std::string output_of(const std::string& command) {
  std::string text;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), got);
  pclose(pipe);
  return text;
}

Json numbers(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

TEST(ImagePeers, ReadTheSameVoxelsAtTheSamePlaces) {
  if (!std::filesystem::exists(kPython)) GTEST_SKIP() << "no " << kPython;
  const TempFolder folder;
  std::string manifest;
  std::size_t count = 0;
  for (const Dialect& dialect : dialects()) {
    for (const NumberType& type : kTypes) {
      for (std::size_t run = 0; run < 8; ++run) {
        const Wanted wanted{type, run % 2 == 1, kPlacements[run / 2]};
        const std::optional<File> file = dialect.write(wanted);
        if (!file) continue;
        const std::string at = std::to_string(count++) + "/";
        Json files = Json::array({folder.write(at + file->name, file->content).string()});
        for (const auto& [name, content] : file->beside)
          files.push_back(folder.write(at + name, content).string());
        Json axes = Json::array();
        for (int a = 0; a < 3; ++a) axes.push_back(numbers(wanted.placement.axes()[a]));
        const Json one{{"what", std::string(dialect.format) + ", " + dialect.encoding + ", " + type.name +
                                    ", " + (wanted.big ? "big" : "little") + ", " + wanted.placement.name},
                       {"format", dialect.format},
                       {"type", type.name},
                       {"file", files.front()},
                       {"files", files},
                       {"base", type.base},
                       {"origin", numbers(wanted.placement.origin)},
                       {"axes", axes}};
        manifest += one.dump() + "\n";
      }
    }
  }
  const auto list = folder.write("manifest", manifest);
  const auto script = source_folder() / "tests" / "loaders" / "images" / "image_peers.py";
  std::istringstream lines(
      output_of(std::string(kPython) + " '" + script.string() + "' '" + list.string() + "'"));
  std::size_t libraries = 0, absent = 0;
  for (std::string line; std::getline(lines, line);) {
    std::cout << line << std::endl;
    if (line.starts_with("right ")) {
      ++libraries;
    } else if (line.starts_with("absent ")) {
      ++absent;
    } else {
      ADD_FAILURE() << line;
    }
  }
  EXPECT_EQ(libraries + absent, 3U);
  if (libraries == 0) GTEST_SKIP() << "none of VTK's Python module, nibabel and pydicom is installed";
}

}  // namespace
}  // namespace palpate::test::matrix
