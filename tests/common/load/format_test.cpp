#include "common/load/format.h"

#include <array>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files/find_helper.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

FileHead head_of(const std::string& content, std::string_view ending = "") {
  const auto bytes = std::as_bytes(std::span(content));
  return {bytes, bytes, bytes.size(), ending};
}
Sniffed sniffed(const std::string& content, std::string_view ending = "") {
  return sniff(head_of(content, ending));
}

std::string netcdf_with(const std::string& name) { return std::string("CDF\1\0\0\0\0", 8) + name; }

std::string plot3d_text() {
  std::string grid = "2 2 2\n";
  for (int n = 0; n < 24; ++n) grid += "0.5 ";
  return grid;
}

/// The start of a file; `ending` where the content alone does not say enough.
struct Example {
  std::string content;
  std::string ending = "";
};

/// At least one of every format that is found by content.
const std::multimap<Format, Example>& examples() {
  static const std::multimap<Format, Example> kExamples{
      {Format::kLegacyVtk, {"# vtk DataFile Version 3.0\n"}},
      {Format::kVtkXml, {"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">"}},
      {Format::kVtkXml, {"\xef\xbb\xbf \n<VTKFile version='1.0' type='UnstructuredGrid'>"}},
      {Format::kVtkXml, {"<VTKFile type=\"PolyData\">"}},
      {Format::kVtkMultiBlock, {"<VTKFile type=\"vtkMultiBlockDataSet\">"}},
      {Format::kVtkMultiBlock, {"<VTKFile type=\"vtkOverlappingAMR\">"}},
      {Format::kVtkParallel, {"<VTKFile type=\"PUnstructuredGrid\">"}},
      {Format::kVtkParallel, {"<VTKFile type=\"PImageData\">"}},
      {Format::kParaviewSeries, {"<VTKFile type=\"Collection\">"}},
      {Format::kParaviewSeries, {"{\n \"file-series-version\" : \"1.0\""}},
      {Format::kExodus, {netcdf_with("num_nodes")}},
      {Format::kExodus, {"\x89HDF\r\n\x1a\n", ".ex2"}},
      {Format::kCgns, {"\x89HDF\r\n\x1a\n and so on CGNSLibraryVersion"}},
      {Format::kCgns, {"\x89HDF\r\n\x1a\n", ".cgns"}},
      {Format::kCgns, {"@(#)ADF Database Version B02012>"}},
      {Format::kVtkHdf, {"\x89HDF\r\n\x1a\n and so on VTKHDF"}},
      {Format::kVtkHdf, {"\x89HDF\r\n\x1a\n", ".vtkhdf"}},
      {Format::kNetcdf, {netcdf_with("x y z u v w")}},
      {Format::kNetcdf, {"\x89HDF\r\n\x1a\n", ".nc"}},
      {Format::kXdmf,
       {"<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"3.0\">"}},
      {Format::kFluent, {"(0 \"fluent\")\n(2 3)\n(10 (0 1 8 0 3))\n", ".cas"}},
      {Format::kGambit, {"        CONTROL INFO 2.3.16\n** GAMBIT NEUTRAL FILE\n"}},
      {Format::kStarCd, {"PROSTAR_VERTEX\n 4000 0 0 0 0 0 0 0\n"}},
      {Format::kStarCd, {"PROSTAR_CELL\n 4000 0 0 0 0 0 0 0\n"}},
      {Format::kEnsight, {"# comment\nFORMAT\ntype:  ensight gold\nGEOMETRY\nmodel: a.geo\n"}},
      {Format::kOpenFoam, {"FoamFile\n{\n object controlDict;\n}\n"}},
      {Format::kGmsh, {"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"}},
      {Format::kSu2, {"% a mesh\nNDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n"}},
      {Format::kTecplot, {"TITLE = \"a\"\nVARIABLES = \"X\" \"Y\" \"Z\"\nZONE I=2, J=2, K=2\n0 0 0\n"}},
      {Format::kTecplot, {"variables = x, y, z, u\nzone n=4 e=1 f=fepoint et=tetrahedron\n"}},
      {Format::kUcd, {"# of a test\n4 1 3 0 0\n1 0 0 0\n", ".inp"}},
      {Format::kNrrd, {"NRRD0005\ntype: float\n"}},
      {Format::kVdb, {std::string(" BDV\0\0\0\0\xe0\0\0\0", 12)}},
      {Format::kMrtrixImage, {"mrtrix image\ndim: 2,2,2\n"}},
      {Format::kTck, {"mrtrix tracks\ndatatype: Float32LE\n"}},
      {Format::kTrk, {std::string("TRACK\0", 6) + std::string(994, '\0')}},
      {Format::kTrx, {"PK\3\4 and so on header.json"}},
      {Format::kTrx, {"PK\3\4 and so on", ".trx"}},
      {Format::kDicom, {std::string(128, '\0') + "DICM"}},
      {Format::kNifti, {std::string(344, '\0') + std::string("n+1\0", 4)}},
      {Format::kNifti, {std::string(344, '\0') + std::string("ni1\0", 4)}},
      {Format::kNifti, {std::string("\x1c\2\0\0n+2\0\r\n\x1a\n", 12)}},
      {Format::kMetaImage, {"ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_CHAR\n"}},
      {Format::kEx, {" Group name: heart\n #Fields=1\n"}},
      {Format::kEx, {"EX Version: 2\nRegion: /\n"}},
      {Format::kCarp, {"3\n0 0 0\n1 0 0\n0 1 0\n", ".pts"}},
      {Format::kCarp, {"x:2502 y:1 z:1 t:101 type:float\n", ".igb"}},
      {Format::kCarp, {"0.5\nnan\n-80.25\n1e-3\n", ".dat"}},
      {Format::kTetgen, {"# nodes\n4 3 0 0\n", ".node"}},
      {Format::kPlot3d, {plot3d_text()}}};
  return kExamples;
}

// The walk over the table: a row that is forgotten anywhere fails here or when CMake runs.
TEST(FormatRows, EachFormatIsDescribedOnce) {
  std::set<std::string_view> names;
  int index = 0;
  for (const FormatRow& row : format_rows()) {
    EXPECT_EQ(static_cast<int>(row.format), index++) << row.name;
    EXPECT_EQ(&row_of(row.format), &row);
    EXPECT_FALSE(row.name.empty()) << "row " << index;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(row.helper.starts_with("palpate-load-")) << row.name;
    EXPECT_FALSE(row.holds.empty()) << row.name;
    EXPECT_TRUE(row.endings.starts_with('.')) << row.name;
    EXPECT_EQ(row.recognise_folder == nullptr, row.folder.empty()) << row.name;
    EXPECT_TRUE(row.marks.empty() || row.recognise_folder != nullptr) << row.name;
    EXPECT_TRUE(row.starts.empty() || row.recognise == nullptr) << row.name << ": two ways to be recognised";
  }
}

TEST(FormatRows, EachIsRecognisedByItsExamplesAndNoOtherIs) {
  for (const FormatRow& row : format_rows()) {
    const auto [first, last] = examples().equal_range(row.format);
    const bool by_content = row.recognise != nullptr || !row.starts.empty();
    EXPECT_EQ(first != last, by_content) << row.name << " has no example, or needs none";
    for (auto example = first; example != last; ++example) {
      const auto& [content, ending] = example->second;
      EXPECT_EQ(sniffed(content, ending).format, row.format) << content;
      for (const FormatRow& other : format_rows())
        EXPECT_EQ(recognises(other, head_of(content, ending)), &other == &row)
            << other.name << ": " << content;
    }
  }
}

TEST(FormatRows, TheEndingDoesNotMatterWhereTheContentSaysEnough) {
  for (const auto& [format, example] : examples()) {
    if (!example.ending.empty() || format == Format::kPlot3d) continue;
    for (const char* ending : {".dat", ".vtk", ".nrrd", ""})
      EXPECT_EQ(sniffed(example.content, ending).format, format) << example.content << " as " << ending;
  }
}

TEST(FormatRows, EachHelperProgramThatCanBeBuiltIsThere) {
  for (const FormatRow& row : format_rows()) {
    const std::string not_built = " " PALPATE_NO_LOADER " ";
    const bool given_up = not_built.find(" " + std::string(row.helper) + " ") != std::string::npos;
    EXPECT_NE(std::filesystem::exists(test::build_folder() / "lib/palpate" / row.helper), given_up)
        << row.helper;
  }
}

TEST(Sniff, NumbersAsTextArePlot3dWhereTheirCountCanFitTheDimensions) {
  const std::string grid = plot3d_text();
  EXPECT_EQ(sniffed(grid).format, Format::kPlot3d);
  EXPECT_FALSE(sniffed("900 900 900 " + grid).format) << "too short";
  EXPECT_FALSE(sniffed(grid + std::string(9000, ' ')).format) << "far too long";
  EXPECT_FALSE(sniffed("2 2 2 x" + grid).format) << "not only numbers";
  EXPECT_FALSE(sniffed("1 1 1 " + grid).format) << "no volume";
}

TEST(Sniff, TheEndingBreaksTheTieOfHdf5) {
  const std::string hdf5 = "\x89HDF\r\n\x1a\n";
  EXPECT_EQ(sniffed(hdf5, ".ex2").format, Format::kExodus);
  EXPECT_FALSE(sniffed(hdf5, ".h5").format);
}

TEST(Sniff, OthersAreDescribed) {
  for (const auto& [content, word] :
       std::vector<std::pair<std::string, std::string>>{{"\x1f\x8b\x08", "gzip"},
                                                        {"<html></html>", "XML"},
                                                        {"<VTKFile type=\"Table\">", "Table"},
                                                        {"PK\3\4 FoamFile controlDict", "zip"},
                                                        {netcdf_with("mesh_topology"), "UGRID"},
                                                        {"hello\x01", "hello\\x01"},
                                                        {"#std 4 6 6 6", "Nek5000"},
                                                        {"#!TDV112", "binary Tecplot"},
                                                        {"*HEADING\n", "Abaqus"},
                                                        {"\x89HDF\r\n\x1a\n", "HDF5"},
                                                        {"MeshVersionFormatted 2", "Medit"},
                                                        {std::string("\xec\x2b\x08\0\5", 5), "SU2"},
                                                        {"\"PointID\",\"x\"", "SU2"},
                                                        {"", "not recognised"}}) {
    const Sniffed result = sniffed(content);
    EXPECT_FALSE(result.format) << content;
    EXPECT_NE(result.found.find(word), std::string::npos) << result.found;
  }
}

TEST(Sniff, EndingsNameWhatTheBytesDoNot) {
  const std::string hdf5 = "\x89HDF\r\n\x1a\n";
  for (const auto& [content, ending, word] : std::vector<std::array<std::string, 3>>{
           {hdf5, ".cas.h5", "Fluent"},
           {hdf5, ".dat.h5", "Fluent"},
           {hdf5, ".silo", "Silo"},
           {std::string("\x07\0\0\0\x08", 5), ".inp", "AVS UCD file in binary"},
           {"Adf Database", ".ccm", "STAR-CCM+"},
           {"8 0 0 0 0 0 1\n", ".ugrid", "AFLR3"},
           {"#v002 512 3", ".re2", "Nek5000"},
           {"CEND\nBEGIN BULK\n", ".bdf", "Nastran"}}) {
    const Sniffed result = sniffed(content, ending);
    EXPECT_FALSE(result.format) << ending;
    EXPECT_NE(result.found.find(word), std::string::npos) << ending << ": " << result.found;
    EXPECT_FALSE(result.remedy.empty()) << ending;
  }
}

TEST(Sniff, ASessionIsToldFromData) {
  const std::string session = "format = 1\nprogram = 'grid'\n\n[scene]\nexample = 'shells'\n";
  const Sniffed result = sniffed(session, ".toml");
  EXPECT_FALSE(result.format);
  EXPECT_EQ(result.found, "a session");
  EXPECT_NE(result.remedy.find("--session"), std::string::npos);
}

/// The line that says why `path` is not opened.
std::string refusal(const std::filesystem::path& path) {
  try {
    (void)find_format(path);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

// gzip, made with Python: "NRRD0004\n" and 344 zeros with NIfTI's mark.
TEST(FindFormat, LooksIntoGzipFilesForNiftiAndNamesWhatElseTheyHold) {
  const test::TempFolder folder;
  const std::string nrrd(
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\xf3\x0b\x0a\x72\x31\x30\x30\x30\xe1\x02"
      "\x00\x3a\x37\x47\xe9\x09\x00\x00\x00",
      29);
  const std::string nifti(
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x63\x60\x18\x05\xb4\x00\x79\xda\x86\x0c"
      "\x00\x42\x5b\x99\xc1\x5c\x01\x00\x00",
      29);
  EXPECT_EQ(find_format(folder.write("a.nii.gz", nifti)), Format::kNifti);
  EXPECT_NE(refusal(folder.write("a.nrrd.gz", nrrd)).find("a gzip file of NRRD"), std::string::npos);
}

TEST(FindFormat, AnEmptyFoamFileMarksTheCaseAroundIt) {
  const test::TempFolder folder;
  const auto foam = folder.write("case.foam", "");
  EXPECT_NE(refusal(foam).find("system/controlDict"), std::string::npos) << refusal(foam);
  folder.write("system/controlDict", "FoamFile");
  folder.write("constant/x", "");
  EXPECT_EQ(find_format(foam), Format::kOpenFoam);
  EXPECT_EQ(find_format(folder.path()), Format::kOpenFoam);
}

TEST(FindFormat, OfAKnownKindItSaysWhatToDoAlone) {
  const test::TempFolder folder;
  EXPECT_EQ(
      refusal(folder.write("a.f00001", "#std 4 6 6 6")),
      folder.path("a.f00001").string() +
          ": is a Nek5000 file, which is not read; open the .nek5000 file beside it in ParaView, and write a .vtu");
  const std::string fluent = refusal(folder.write("a.cas.h5", "\x89HDF\r\n\x1a\n"));
  EXPECT_NE(fluent.find("is a Fluent file in HDF5, which is not read; write it from Fluent"),
            std::string::npos)
      << fluent;
}

TEST(FindFormat, AnUnknownFileOrFolderIsAnsweredWithAllThatCanBeOpened) {
  const test::TempFolder folder;
  const std::string file = refusal(folder.write("a.txt", "hello"));
  const std::string of_folder = refusal(folder.path());
  for (const FormatRow& row : format_rows()) {
    EXPECT_TRUE(row.format == Format::kRaw || file.find(row.name) != std::string::npos)
        << row.name << ": " << file;
    EXPECT_TRUE(row.folder.empty() || of_folder.find(row.folder) != std::string::npos) << of_folder;
  }
}

}  // namespace
}  // namespace palpate
