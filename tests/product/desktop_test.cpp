// What a desktop knows of the programs: kinds of files, entries, icons, thumbnails. The table of formats is held
// against it, so that a new row cannot be forgotten.

#include <array>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/text.h"
#include "common/load/format.h"
#include "tests/e2e/program.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const char* const kPrograms[] = {"cardiac", "dtmri", "flow", "grid", "workbench"};

fs::path share(const std::string& file) { return source_folder() / "share" / file; }

/// Why a text is no well-formed XML; empty where it is.
std::string xml_fault(const std::string& text) {
  static const std::regex kTag(
      R"(<(\?[^>]*\?|!--[\s\S]*?--|/?[A-Za-z][\w:.-]*((\s+[\w:.-]+="[^"<]*")*)\s*/?)>)");
  std::vector<std::string> open;
  std::size_t at = 0;
  int roots = 0;
  const auto plain = [](const std::string& between) {
    static const std::regex kReference("&(amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);");
    return std::regex_replace(between, kReference, "").find_first_of("<&") == std::string::npos;
  };
  for (auto it = std::sregex_iterator(text.begin(), text.end(), kTag); it != std::sregex_iterator(); ++it) {
    const std::string tag = (*it)[1];
    const auto start = static_cast<std::size_t>(it->position(0));
    const std::string between = text.substr(at, start - at);
    if (!plain(between)) return "a sign in '" + between + "'";
    if (open.empty() && between.find_first_not_of(" \t\r\n") != std::string::npos)
      return "text outside the root";
    at = start + static_cast<std::size_t>(it->length(0));
    if (tag[0] == '?' || tag[0] == '!') continue;
    if (!plain(tag)) return "a sign in <" + tag + ">";
    const std::size_t first = tag[0] == '/' ? 1 : 0;
    const std::string name = tag.substr(first, tag.find_first_of(" \t\r\n/", first) - first);
    if (tag[0] == '/') {
      if (open.empty() || open.back() != name) return "</" + name + "> closes nothing";
      open.pop_back();
      continue;
    }
    if (open.empty()) ++roots;
    if (tag.back() != '/') open.push_back(name);
  }
  if (text.find('<', at) != std::string::npos) return "a tag that does not end";
  if (roots != 1) return std::to_string(roots) + " roots";
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

/// A kind of file of share/mime/palpate.xml.
struct MimeType {
  Names globs;
  std::vector<std::pair<std::string, std::string>> matches;  ///< offset, bytes
};

/// \000 and \\ as they are in values of magic.
std::string unescaped(const std::string& value) {
  std::string bytes;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] != '\\') {
      bytes += value[i];
    } else {
      bytes += static_cast<char>(std::stoi(value.substr(i + 1, 3), nullptr, 8));
      i += 3;
    }
  }
  static const std::regex kLess("&lt;");
  return std::regex_replace(bytes, kLess, "<");
}

const std::map<std::string, MimeType>& mime_types() {
  static const std::map<std::string, MimeType> kTypes = [] {
    std::map<std::string, MimeType> types;
    const std::string text = read_file(share("mime/palpate.xml"));
    static const std::regex kType(R"re(<mime-type type="([^"]+)">([\s\S]*?)</mime-type>)re");
    static const std::regex kGlob(R"re(<glob pattern="([^"]+)")re");
    static const std::regex kMatch(R"re(<match type="string" offset="([^"]+)" value="([^"]+)")re");
    for (auto it = std::sregex_iterator(text.begin(), text.end(), kType); it != std::sregex_iterator();
         ++it) {
      const std::string body = (*it)[2];
      MimeType& type = types[(*it)[1]];
      for (auto g = std::sregex_iterator(body.begin(), body.end(), kGlob); g != std::sregex_iterator(); ++g)
        type.globs.insert((*g)[1]);
      for (auto m = std::sregex_iterator(body.begin(), body.end(), kMatch); m != std::sregex_iterator(); ++m)
        type.matches.emplace_back((*m)[1], unescaped((*m)[2]));
    }
    return types;
  }();
  return kTypes;
}

/// Whether a file by itself says that it is of this format.
bool shows_itself(const FormatRow& row) { return !row.starts.empty() || row.recognise != nullptr; }

/// The kinds of file that have the row's endings. @param packed with ".gz" behind.
Names types_of(const FormatRow& row, bool packed) {
  Names names;
  for (const std::string_view ending : words(row.endings)) {
    for (const auto& [name, type] : mime_types()) {
      if (type.globs.contains("*" + std::string(ending) + (packed ? ".gz" : ""))) names.insert(name);
    }
  }
  return names;
}
Names types_of(const FormatRow& row) {
  Names names = types_of(row, false);
  names.merge(types_of(row, true));
  return names;
}

/// The value of a key of a file of groups and keys.
std::string value_of(const fs::path& file, const std::string& key) {
  std::smatch found;
  const std::string text = read_file(file);
  return std::regex_search(text, found, std::regex("\n" + key + "=([^\n]*)")) ? found[1].str() : "";
}

Names listed_types(const fs::path& file) {
  Names names;
  const std::string list = value_of(file, "MimeType");
  for (const std::string_view part : split(list, ';')) {
    if (!part.empty()) names.insert(std::string(part));
  }
  return names;
}

/// What the program READS by its CMakeLists.txt.
Names read_by(const std::string& program) {
  std::smatch found;
  const std::string text = read_file(source_folder() / "apps" / program / "CMakeLists.txt");
  Names kinds;
  if (!std::regex_search(text, found, std::regex("\n  READS ([a-z ]+)"))) return kinds;
  const std::string list = found[1];
  for (const std::string_view kind : words(list)) kinds.insert(std::string(kind));
  return kinds;
}

bool installed(const std::string& program) {
  return Program({"/bin/sh", "-c", "command -v " + program}).finish().exit_code == 0;
}

TEST(MimeTypes, HaveEveryFormatOfTheTable) {
  for (const FormatRow& row : format_rows()) {
    if (!shows_itself(row)) continue;
    EXPECT_EQ(types_of(row, false).size(), 1U)
        << row.name << " is to be one kind of file in share/mime/palpate.xml";
    for (const std::string_view ending : words(row.endings)) {
      int globs = 0, packed = 0;
      for (const auto& [name, type] : mime_types()) {
        globs += type.globs.contains("*" + std::string(ending)) ? 1 : 0;
        packed += type.globs.contains("*" + std::string(ending) + ".gz") ? 1 : 0;
      }
      EXPECT_EQ(globs, 1) << row.name << ": " << ending;
      EXPECT_EQ(packed, row.gzip ? 1 : 0) << row.name << ": " << ending << ".gz";
    }
    if (row.starts.empty()) continue;
    bool known = false;
    for (const std::string& name : types_of(row)) {
      for (const auto& [offset, bytes] : mime_types().at(name).matches)
        known = known || (offset == "0" && bytes == row.starts);
    }
    EXPECT_TRUE(known) << row.name << " has no magic '" << row.starts << "'";
  }
}

TEST(MimeTypes, AreThoseOfTheTableAndSessions) {
  Names known{"application/x-palpate-session"};
  for (const FormatRow& row : format_rows()) known.merge(types_of(row));
  for (const auto& [name, type] : mime_types()) EXPECT_TRUE(known.contains(name)) << name << " is of no row";
}

TEST(DesktopEntries, OpenWhatTheirProgramReads) {
  for (const std::string program : kPrograms) {
    Names wanted;
    const Names kinds = read_by(program);
    for (const FormatRow& row : format_rows()) {
      for (const std::string_view held : words(row.holds)) {
        if (shows_itself(row) && kinds.contains(std::string(held))) wanted.merge(types_of(row));
      }
    }
    EXPECT_EQ(listed_types(share("applications/palpate-" + program + ".desktop")), wanted) << program;
  }
}

TEST(DesktopEntries, NameProgramAndIcon) {
  for (const std::string program : kPrograms) {
    const fs::path entry = share("applications/palpate-" + program + ".desktop");
    EXPECT_EQ(value_of(entry, "TryExec"), "palpate-" + program);
    EXPECT_NE(value_of(entry, "Exec").find("palpate-" + program), std::string::npos);
    EXPECT_EQ(value_of(entry, "Icon"), "palpate-" + program);
    EXPECT_TRUE(fs::exists(share("icons/palpate-" + program + ".svg")));
    const std::string help = Program({bin(program).string(), "--help"}).finish().out;
    EXPECT_EQ(value_of(entry, "Comment"), help.substr(0, help.find('\n'))) << "the program says so itself";
  }
}

TEST(Thumbnailers, AreOfKindsThatTheirProgramOpens) {
  int found = 0;
  for (const auto& file : fs::directory_iterator(share("thumbnailers"))) {
    const std::string program = file.path().stem().string();
    const Names opened = listed_types(share("applications/" + program + ".desktop"));
    for (const std::string& type : listed_types(file.path()))
      EXPECT_TRUE(opened.contains(type)) << program << " opens no " << type;
    ++found;
  }
  EXPECT_GT(found, 0);
}

TEST(DesktopFiles, AreWellFormed) {
  std::vector<fs::path> files{share("mime/palpate.xml"), share("metainfo/palpate.metainfo.xml.in")};
  for (const auto& file : fs::directory_iterator(share("icons"))) files.push_back(file.path());
  for (const fs::path& file : files) EXPECT_EQ(xml_fault(read_file(file)), "") << file;
  // The check itself.
  for (const char* broken :
       {"<a>", "<a></b>", "<a/><b/>", "<a b=c/>", "<a>&x</a>", "<a><", "text", "<a/>t<b"})
    EXPECT_NE(xml_fault(broken), "") << broken;
  EXPECT_EQ(xml_fault("<?xml version=\"1.0\"?>\n<!-- a > b -->\n<a b=\"c>\">&lt;<c/></a>\n"), "");
}

TEST(DesktopFiles, PassTheValidatorsThatAreInstalled) {
  if (!installed("desktop-file-validate") && !installed("appstreamcli"))
    GTEST_SKIP() << "neither desktop-file-validate nor appstreamcli is installed";
  if (installed("desktop-file-validate")) {
    for (const auto& file : fs::directory_iterator(share("applications"))) {
      const ProgramResult result =
          Program({"/bin/sh", "-c", "desktop-file-validate '" + file.path().string() + "'"}).finish();
      EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    }
  }
  if (installed("appstreamcli")) {
    const fs::path metainfo = build_folder() / "package/example.palpate.Palpate.metainfo.xml";
    const ProgramResult result =
        Program({"/bin/sh", "-c", "appstreamcli validate --no-net '" + metainfo.string() + "'"}).finish();
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }
}

// Files are told apart by their content where their names say nothing, by their names where those do.
TEST(MimeTypes, AreFoundByADesktop) {
  if (!installed("gio") || !installed("update-mime-database") ||
      !fs::exists("/usr/share/mime/packages/freedesktop.org.xml"))
    GTEST_SKIP() << "gio and shared-mime-info are not installed";
  const TempFolder folder;
  const std::string data = folder.path("data").string();
  fs::create_directories(folder.path("data/mime/packages"));
  fs::copy_file(share("mime/palpate.xml"), folder.path("data/mime/packages/palpate.xml"));
  ASSERT_EQ(Program({"/bin/sh", "-c", "update-mime-database '" + data + "/mime'"}).finish().exit_code, 0);
  std::string nifti(352, '\0');
  nifti.replace(344, 3, "n+1");
  const std::vector<std::array<std::string, 3>> files{
      {"nrrd", "NRRD0004\ntype: float\n", "application/x-nrrd"},
      {"nifti", nifti, "application/x-nifti"},
      {"legacy", "# vtk DataFile Version 3.0\n", "application/x-vtk-legacy"},
      {"xml", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">\n</VTKFile>\n", "application/x-vtk-xml"},
      {"meta", "ObjectType = Image\nNDims = 3\n", "application/x-metaimage"},
      {"tck", "mrtrix tracks\ncount: 0\nEND\n", "application/x-mrtrix-tracks"},
      {"trk", std::string("TRACK\0\2\0", 8), "application/x-trackvis-tracks"},
      {"vdb", std::string(" BDV\0\0\0\0\xe0", 9), "application/x-openvdb"},
      {"head.nii.gz", "\x1f\x8b\x08", "application/x-nifti-compressed"},
      {"lines.trx", "PK\3\4", "application/x-trx-tracks"},
      {"mesh.su2", "NDIME= 3\n", "application/x-su2-mesh"},
      {"carotid.palpate.toml", "format = 1\n", "application/x-palpate-session"}};
  for (const auto& [name, content, type] : files) {
    const fs::path file = folder.write(name, content);
    const ProgramResult result =
        Program({"/bin/sh", "-c", "gio info -a standard::content-type '" + file.string() + "'"},
                folder.path(), {"XDG_DATA_HOME=" + data, "XDG_DATA_DIRS=/usr/share"})
            .finish();
    EXPECT_NE(result.out.find("standard::content-type: " + type + "\n"), std::string::npos)
        << name << ": " << result.out << result.err;
  }
}

}  // namespace
}  // namespace palpate::test
