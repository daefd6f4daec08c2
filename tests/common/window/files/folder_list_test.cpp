#include "common/window/files/folder_list.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

std::vector<std::string> names_in(const FolderList& list) {
  std::vector<std::string> names;
  for (const FolderEntry& entry : list.entries) names.push_back(entry.name + (entry.folder ? "/" : ""));
  return names;
}

TEST(FolderList, FoldersComeFirstAndFilesAreThoseThatCanBeOpened) {
  const test::TempFolder folder;
  for (const char* name : {"b.vtk", "A.VTI", "notes.txt", ".hidden.vtk", "scan.nrrd", "s.palpate.toml"})
    folder.write(name, "x");
  std::filesystem::create_directory(folder.path("deep"));
  const auto shows = [](const std::filesystem::path& path, bool is_folder) {
    return can_open(path, is_folder, FieldKind::kVector);
  };
  EXPECT_EQ(names_in(list_folder(folder.path(), shows, false)),
            (std::vector<std::string>{"deep/", "A.VTI", "b.vtk", "s.palpate.toml", "scan.nrrd"}));
  EXPECT_EQ(names_in(list_folder(folder.path(), shows, true)).at(1), ".hidden.vtk");
  EXPECT_NE(list_folder(folder.path("none"), shows, false).error.find("none"), std::string::npos);
}

TEST(FolderList, WhatCanBeOpenedDependsOnTheKindOfProgram) {
  EXPECT_TRUE(can_open("t.tck", false, FieldKind::kTensor));
  EXPECT_FALSE(can_open("t.tck", false, FieldKind::kVector));
  EXPECT_TRUE(can_open("head.nii.gz", false, FieldKind::kScalar));
  EXPECT_FALSE(can_open("head.txt.gz", false, FieldKind::kScalar));
}

TEST(FolderList, WhatIsTypedMatchesTheBeginningOfAName) {
  EXPECT_TRUE(matches("Carotid_fine.vtk", "caro"));
  EXPECT_TRUE(matches("Carotid_fine.vtk", "FINE"));
  EXPECT_FALSE(matches("Carotid_fine.vtk", "otid"));
}

}  // namespace
}  // namespace palpate
