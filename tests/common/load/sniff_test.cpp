#include "common/load/sniff.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

Sniffed sniffed(const std::string& content, std::string_view ending = "") {
  const auto bytes = std::as_bytes(std::span(content));
  return sniff({bytes, bytes, bytes.size(), ending});
}

std::string netcdf_with(const std::string& name) { return std::string("CDF\1\0\0\0\0", 8) + name; }

TEST(Sniff, FormatsAreFoundByContentWhateverTheEnding) {
  const std::vector<std::pair<std::string, Format>> known{
      {"# vtk DataFile Version 3.0\n", Format::kLegacyVtk},
      {"NRRD0005\ntype: float\n", Format::kNrrd},
      {"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">", Format::kVtkXml},
      {"\xef\xbb\xbf \n<VTKFile version='1.0' type='UnstructuredGrid'>", Format::kVtkXml},
      {"<VTKFile type=\"vtkMultiBlockDataSet\">", Format::kVtkMultiBlock},
      {"<VTKFile type=\"PUnstructuredGrid\">", Format::kVtkParallel},
      {"<VTKFile type=\"PImageData\">", Format::kVtkParallel},
      {"<VTKFile type=\"PolyData\">", Format::kVtkXml},
      {"<VTKFile type=\"Collection\">", Format::kParaviewSeries},
      {"{\n \"file-series-version\" : \"1.0\"", Format::kParaviewSeries},
      {netcdf_with("num_nodes"), Format::kExodus},
      {"# comment\nFORMAT\ntype:  ensight gold\nGEOMETRY\nmodel: a.geo\n", Format::kEnsight},
      {std::string(344, '\0') + std::string("n+1\0", 4), Format::kNifti},
      {std::string(344, '\0') + std::string("ni1\0", 4), Format::kNifti},
      {std::string("\x1c\2\0\0n+2\0\r\n\x1a\n", 12), Format::kNifti},
      {"ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_CHAR\n", Format::kMetaImage},
      {std::string(128, '\0') + "DICM", Format::kDicom},
      {std::string(" BDV\0\0\0\0\xe0\0\0\0", 12), Format::kVdb},
      {"mrtrix image\ndim: 2,2,2\n", Format::kMrtrixImage},
      {"mrtrix tracks\ndatatype: Float32LE\n", Format::kTck},
      {std::string("TRACK\0", 6) + std::string(994, '\0'), Format::kTrk},
      {"PK\3\4 and so on header.json", Format::kTrx},
      {"FoamFile\n{\n object controlDict;\n}\n", Format::kOpenFoam}};
  for (const auto& [content, format] : known) {
    for (const char* ending : {".dat", ".vtk", ".nrrd", ""})
      EXPECT_EQ(sniffed(content, ending).format, format) << content;
  }
}

TEST(Sniff, NumbersAsTextArePlot3dWhereTheirCountCanFitTheDimensions) {
  std::string grid = "2 2 2\n";
  for (int n = 0; n < 24; ++n) grid += "0.5 ";
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
                                                        {netcdf_with("time"), "netCDF"},
                                                        {"hello\x01", "hello\\x01"},
                                                        {"", "not recognised"}}) {
    const Sniffed result = sniffed(content);
    EXPECT_FALSE(result.format) << content;
    EXPECT_NE(result.found.find(word), std::string::npos) << result.found;
  }
}

TEST(Sniff, ASessionIsToldFromData) {
  const std::string session = "format = 1\nprogram = 'grid'\n\n[scene]\nexample = 'shells'\n";
  const Sniffed result = sniffed(session, ".toml");
  EXPECT_FALSE(result.format);
  EXPECT_EQ(result.found, "a session");
  EXPECT_NE(result.remedy.find("--session"), std::string::npos);
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
  try {
    (void)find_format(folder.write("a.nrrd.gz", nrrd));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a gzip file of NRRD"), std::string::npos) << error.what();
  }
}

TEST(FindFormat, AnEmptyFoamFileMarksTheCaseAroundIt) {
  const test::TempFolder folder;
  const auto foam = folder.write("case.foam", "");
  EXPECT_THROW((void)find_format(foam), Error);
  folder.write("system/controlDict", "FoamFile");
  folder.write("constant/x", "");
  EXPECT_EQ(find_format(foam), Format::kOpenFoam);
  EXPECT_EQ(find_format(folder.path()), Format::kOpenFoam);
}

}  // namespace
}  // namespace palpate
