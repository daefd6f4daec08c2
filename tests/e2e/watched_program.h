/// Runs a program, and those that it starts, under tests/support/open_watch.cpp: what each opened, what was mapped into it when
/// it ended, and what textures it allocated.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/e2e/program.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {

struct Watched {
  std::map<std::string, std::set<std::string>> opened;    ///< by program: files of the folder at work
  std::map<std::string, std::set<std::string>> mapped;    ///< by program: names of libraries
  std::map<std::string, std::set<std::string>> textures;  ///< by program: labels of those allocated
  ProgramResult result;
};

/// @param command its first word is a program of build/…/bin.  @param folder where it works.  @param window_seconds [s] after
/// which a window is interrupted, as by Ctrl-C; 0: there is none.
inline Watched watched(std::vector<std::string> command, const std::filesystem::path& folder,
                       std::vector<std::string> environment = {}, double window_seconds = 0.0) {
  namespace fs = std::filesystem;
  command[0] = build_folder() / "bin" / command[0];
  const TempFolder aside;
  const fs::path logs = aside.path("watch");
  fs::create_directory(logs);
  environment.push_back("LD_PRELOAD=" + (build_folder() / "tests/libpalpate_open_watch.so").string());
  environment.push_back("PALPATE_OPEN_WATCH=" + (logs / "log").string());
  Watched seen;
  Program program(command, folder, environment);
  if (window_seconds > 0.0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(window_seconds));
    program.signal(SIGINT);
  }
  seen.result = program.finish();
  EXPECT_EQ(seen.result.exit_code, window_seconds > 0.0 ? 130 : 0)
      << command[0] << " " << command[1] << ": " << seen.result.err;
  for (const auto& entry : fs::directory_iterator(logs)) {
    std::ifstream in(entry.path());
    std::set<std::string> opened;
    std::set<std::string> mapped;
    std::set<std::string> textures;
    std::string self;
    for (std::string word, path; in >> word && std::getline(in >> std::ws, path);) {
      const fs::path whole = (folder / path).lexically_normal();
      if (word == "opens" && whole.parent_path() == folder && whole.has_filename())
        opened.insert(whole.filename());
      if (word == "texture") textures.insert(path);
      if (word == "self") self = fs::path(path).filename();
      if (word == "maps" && path.find(".so") != std::string::npos) mapped.insert(fs::path(path).filename());
    }
    seen.opened[self].merge(opened);
    seen.mapped[self].merge(mapped);
    seen.textures[self].merge(textures);
  }
  return seen;
}

}  // namespace palpate::test
