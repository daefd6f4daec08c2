// Every #include of the source tree against the table of who may include whom.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kCommon{"base",        "math",  "geometry", "kinematics", "ode",
                                       "field",       "trace", "load",     "haptics",    "device",
                                       "calibration", "servo", "render",   "study",      "scene",
                                       "compose",     "hand",  "window",   "cli",        "experiment"};

// What each folder may include directly; allowing a folder allows what it may include.
const std::map<std::string, std::set<std::string>> kDirect{{"base", {}},
                                                           {"math", {"base"}},
                                                           {"geometry", {"math"}},
                                                           {"ode", {"math"}},
                                                           {"kinematics", {"geometry"}},
                                                           {"field", {"geometry"}},
                                                           {"trace", {"field", "ode"}},
                                                           {"load", {"field"}},
                                                           {"haptics", {"trace"}},
                                                           {"device", {"kinematics"}},
                                                           {"calibration", {"kinematics"}},
                                                           {"servo", {"haptics", "device"}},
                                                           {"render", {"trace"}},
                                                           {"study", {"servo", "render"}},
                                                           {"scene", {"load"}},
                                                           {"compose", {"scene", "render"}},
                                                           {"hand", {"compose", "servo"}},
                                                           {"window", {"hand"}},
                                                           {"cli", {"hand"}},
                                                           {"experiment", {"study", "window", "cli"}}};

std::set<std::string> closure(const std::string& folder) {
  std::set<std::string> reached{folder};
  std::vector<std::string> open{folder};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    for (const std::string& allowed : kDirect.at(next)) {
      if (reached.insert(allowed).second) open.push_back(allowed);
    }
  }
  return reached;
}

/// "common/field", "loaders/vtk", "apps/flow", "lab/page/plot.h": the first two parts of a path.
std::string room_of(const std::string& path) {
  const auto first = path.find('/');
  const auto second = path.find('/', first + 1);
  return first == std::string::npos ? path : path.substr(0, second);
}

bool allowed(const std::string& from, const std::string& to) {
  if (from == to) return true;
  const bool to_common = to.starts_with("common/");
  if (from.starts_with("common/")) return to_common && closure(from.substr(7)).count(to.substr(7)) > 0;
  if (from.starts_with("loaders/")) {
    // Helpers of their own for other libraries of VTK's, and what guards HDF5's files.
    static const std::set<std::pair<std::string, std::string>> kBetween{{"loaders/cfd", "loaders/vtk"},
                                                                        {"loaders/hdf", "loaders/vtk"},
                                                                        {"loaders/xdmf", "loaders/hdf"},
                                                                        {"loaders/xdmf", "loaders/vtk"}};
    if (kBetween.contains({from, to})) return true;
    const std::set<std::string> loader_may = [] {
      std::set<std::string> s = closure("field");
      s.merge(closure("load"));
      return s;
    }();
    return to_common && loader_may.count(to.substr(7)) > 0;
  }
  if (from.starts_with("lab/")) {
    return to.starts_with("lab/") ||
           (to_common && to != "common/window" && to != "common/cli" && to != "common/experiment");
  }
  if (from.starts_with("library/")) {
    std::set<std::string> may = closure("compose");
    may.merge(closure("servo"));
    return to == "library/palpate" || to == "library/access.h" || (to_common && may.count(to.substr(7)) > 0);
  }
  return from.starts_with("apps/") && to_common;
}

struct Foreign {
  std::regex include;
  std::vector<std::string> rooms;  ///< path prefixes where it may stand
  const char* what;
};

const std::vector<Foreign> kForeign{
    {std::regex("^(epoxy/|GL/|GLES|EGL/|GLFW/)"),
     {"common/render/", "common/window/", "common/experiment/"},
     "OpenGL or the window"},
    {std::regex("^imgui"), {"common/render/", "common/window/", "common/experiment/", "apps/"}, "Dear ImGui"},
    {std::regex("^vtk"), {"loaders/vtk/", "loaders/cfd/", "loaders/hdf/", "lab/peer/"}, "VTK"},
    {std::regex("^teem/"), {"loaders/nrrd/"}, "Teem"},
    {std::regex("^gdcm"), {"loaders/dicom/"}, "GDCM"},
    {std::regex("^openvdb/"), {"loaders/vdb/"}, "OpenVDB"},
    {std::regex("^nanovdb/"), {"loaders/vdb/", "common/field/grid/"}, "NanoVDB"},
    {std::regex("^(CGAL/|tetgen)"), {"apps/cardiac/mesher/"}, "CGAL or TetGen"},
    {std::regex("^libusb"), {"common/device/driver/"}, "libusb"},
    {std::regex("^boost/"),
     {"common/device/driver/transport/beast_transport.cpp", "common/study/distributions.cpp"},
     "Boost"},
};

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const char* top : {"common", "lab", "loaders", "apps", "library"}) {
    for (const auto& entry : fs::recursive_directory_iterator(source_folder() / top)) {
      const std::string ending = entry.path().extension().string();
      if (ending == ".h" || ending == ".cpp") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(IncludeArrows, PointOnlyWhereTheTableAllows) {
  const std::regex include_line(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::size_t read = 0;
  for (const fs::path& file : sources()) {
    const std::string name = fs::relative(file, source_folder()).generic_string();
    std::ifstream in(file);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      std::smatch match;
      if (!std::regex_search(line, match, include_line)) continue;
      ++read;
      const std::string target = match[2];
      const bool ours = target.starts_with("common/") || target.starts_with("lab/") ||
                        target.starts_with("loaders/") || target.starts_with("apps/") ||
                        target.starts_with("library/");
      if (match[1] == "\"" && !ours && target.find('/') != std::string::npos &&
          !target.starts_with("imgui")) {
        ADD_FAILURE() << name << ":" << number << ": includes start at the repository root: " << target;
      }
      if (ours) {
        EXPECT_TRUE(allowed(room_of(name), room_of(target)))
            << name << ":" << number << ": " << room_of(name) << " may not include " << target;
      }
      for (const Foreign& foreign : kForeign) {
        if (!std::regex_search(target, foreign.include)) continue;
        const bool at_home = std::any_of(foreign.rooms.begin(), foreign.rooms.end(),
                                         [&](const std::string& room) { return name.starts_with(room); });
        EXPECT_TRUE(at_home) << name << ":" << number << ": " << foreign.what << " may not be included here";
      }
    }
  }
  EXPECT_GT(read, 50U) << "the tree was not found";
}

/// Where a line names a program: by a name that is no word; by one with a verb, an option or a file behind it; or, in
/// prose, by one between quotes (a mode is called `grid`, a parameter `workbench`).
bool names_program(const std::string& line, bool prose) {
  static const std::vector<std::string> names{"cardiac", "dtmri", "flow", "grid", "workbench"};
  if (std::none_of(names.begin(), names.end(),
                   [&](const std::string& name) { return line.find(name) != std::string::npos; }))
    return false;  // the patterns are slow
  static const std::regex used(
      R"((^|[^-/\w])(cardiac|dtmri)\b|(^|[^-/\w])(flow|grid|workbench) (--\w|[\w./-]*\w\.[a-z]{2,5}\b|)"
      R"((info|open|trace|probe|render|report|slice|clip|study|annotate|calibrate|devices|doctor|tune|feel|)"
      R"(monitor|controls|screen|stability)\b))");
  static const std::regex quoted(
      R"(["`]flow( \(Palpate\)[^"`]*)?["`]|"workbench"|program( =)? ["`](flow|grid|workbench)["`])");
  return std::regex_search(line, used) || (prose && std::regex_search(line, quoted));
}

TEST(Common, NamesNoProgram) {
  EXPECT_TRUE(names_program("/// `cardiac` has it", false)) << "the search itself";
  EXPECT_TRUE(names_program("try workbench doctor", false));
  EXPECT_TRUE(names_program("    flow carotid.vtk --device falcon", true));
  EXPECT_TRUE(names_program("| buttons | `workbench --json` |", true));
  EXPECT_TRUE(names_program(R"(std::string program;  ///< "flow")", true));
  EXPECT_TRUE(names_program(R"(/// "flow (Palpate) 0.1.0")", true));
  EXPECT_FALSE(names_program(R"({"v", "u", "flow", "wind"})", false)) << "a word for velocity";
  EXPECT_FALSE(names_program("/// `grid` leads the hand", true)) << "a mode";
  EXPECT_FALSE(names_program("/// a tracker whose stations `workbench` names", true)) << "a parameter";
  EXPECT_FALSE(names_program("--workbench workbench.toml", true));
  EXPECT_FALSE(names_program("palpate-load-cardiac reads a flow on a grid", true));
  int read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_folder() / "common")) {
    const std::string ending = entry.path().extension().string();
    const bool code = ending == ".h" || ending == ".cpp" || ending == ".def";
    if (!code && ending != ".md" && ending != ".txt") continue;
    ++read;
    const std::string path = fs::relative(entry.path(), source_folder()).generic_string();
    std::ifstream in(entry.path());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      const bool prose = !code || line.find("//") != std::string::npos;
      EXPECT_FALSE(names_program(line, prose)) << path << ":" << number << ": " << line;
    }
  }
  EXPECT_GT(read, 500) << "the tree was not found";
}

TEST(IncludeArrows, TableNamesEveryFolderAndHasNoCycle) {
  for (const std::string& folder : kCommon) {
    ASSERT_TRUE(kDirect.count(folder)) << folder;
    for (const std::string& direct : kDirect.at(folder)) {
      EXPECT_FALSE(closure(direct).count(folder)) << folder << " and " << direct << " include each other";
    }
  }
  for (const auto& entry : fs::directory_iterator(source_folder() / "common")) {
    if (!entry.is_directory()) continue;
    EXPECT_TRUE(kDirect.count(entry.path().filename().string()))
        << entry.path().filename() << " is not in the table";
    EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path() << " says nothing of itself";
  }
}

TEST(IncludeArrows, RefuseAWrongArrow) {
  EXPECT_FALSE(allowed("common/field", "common/trace"));
  EXPECT_FALSE(allowed("common/servo", "common/render"));
  EXPECT_FALSE(allowed("common/load", "loaders/vtk"));
  EXPECT_FALSE(allowed("apps/flow", "loaders/vtk"));
  EXPECT_FALSE(allowed("loaders/vtk", "loaders/hdf"));
  EXPECT_FALSE(allowed("common/compose", "common/hand"));
  EXPECT_FALSE(allowed("common/hand", "lab/hand"));
  EXPECT_FALSE(allowed("apps/flow", "lab/page"));
  EXPECT_FALSE(allowed("apps/workbench", "lab/workbench"));
  EXPECT_FALSE(allowed("lab/hand", "common/cli"));
  EXPECT_TRUE(allowed("library/picture.cpp", "common/render"));
  EXPECT_FALSE(allowed("library/palpate.cpp", "common/window"));
  EXPECT_FALSE(allowed("library/python", "loaders/vtk"));
  EXPECT_TRUE(allowed("apps/flow", "common/window"));
  EXPECT_TRUE(allowed("common/haptics", "common/ode"));
}

}  // namespace
}  // namespace palpate::test
