// Images of every format, cut off at many places: a reader gives the voxels that the whole file has, or none.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/dicom/dicom_fixture.h"
#include "tests/loaders/nifti_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

const Index3 kSize(5, 4, 3);

std::vector<std::int16_t> numbers() {
  std::vector<std::int16_t> values;
  for (int k = 0; k < kSize.z; ++k) {
    for (int j = 0; j < kSize.y; ++j) {
      for (int i = 0; i < kSize.x; ++i) values.push_back(static_cast<std::int16_t>(1 + i + 20 * j - 300 * k));
    }
  }
  return values;
}

std::string bytes_of(const std::vector<std::int16_t>& values) {
  std::string bytes;
  for (const std::int16_t value : values) put(bytes, value);
  return bytes;
}

std::string text_of(const std::vector<std::int16_t>& values) {
  std::string text;
  for (const std::int16_t value : values) text += std::to_string(value) + (text.size() % 7 == 0 ? "\n" : " ");
  return text;
}

std::string hex_of(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    std::array<char, 3> two{};
    std::snprintf(two.data(), two.size(), "%02x", static_cast<unsigned char>(c));
    text += two.data();
  }
  return text;
}

std::string base64_of(const std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t b = 0; b < 3; ++b)
      three = three << 8U | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    for (unsigned digit = 0; digit < 4; ++digit)
      text += i + digit > bytes.size() ? '=' : kDigits[three >> (18U - 6U * digit) & 63U];
  }
  return text;
}

std::string packed(const std::string& content, int wrapper) {
  z_stream stream{};
  (void)deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + wrapper, 8, Z_DEFAULT_STRATEGY);
  std::string out(content.size() + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  (void)deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// A file to open, and the one in which its voxels stand, which is cut.
struct Sample {
  std::string name;     ///< of the format, and of the file that is opened
  std::string content;  ///< of that
  std::string voxels;   ///< the file's name; empty: the same
  std::string data;     ///< its content
};

std::vector<Sample> samples() {
  const std::string raw = bytes_of(numbers()), text = text_of(numbers());
  const std::string nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: ";
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nBinaryDataByteOrderMSB = False\nDimSize = 5 4 3\n"
      "ElementType = MET_SHORT\n";
  const std::string mif = "mrtrix image\ndim: 5,4,3\nvox: 1,1,1\nlayout: +0,+1,+2\ndatatype: Int16LE\n";
  const std::string vtk = "# vtk DataFile Version 3.0\nt\n";
  const std::string points =
      "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nORIGIN 0 0 0\nSPACING 1 1 1\n"
      "POINT_DATA 60\nSCALARS scalars short 1\nLOOKUP_TABLE default\n";
  NiftiHeader nifti{.size = {5, 4, 3}, .datatype = 4};
  const std::string nii = nifti.version1() + std::string(4, '\0') + raw;
  nifti.pair = true;
  std::string turned = raw, mif_head = mif + "file: . 200\nEND\n";
  for (std::size_t i = 0; i < turned.size(); i += 2) std::swap(turned[i], turned[i + 1]);
  mif_head.resize(200, '\0');
  const std::string vti =
      "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt64\"><ImageData "
      "WholeExtent=\"0 4 0 3 0 2\"><Piece Extent=\"0 4 0 3 0 2\"><PointData><DataArray "
      "type=\"Int16\" Name=\"scalars\" format=";
  const std::string vti_end = "</Piece></ImageData>";
  std::string length, appended = "_";
  put(length, static_cast<std::uint64_t>(raw.size()));
  appended += length;
  // Blocks of VTK's zlib compressor: how many, their size, that of the last one, and their packed sizes.
  constexpr std::size_t kBlock = 50;
  std::string blocks, block_sizes;
  for (const std::uint64_t number : {raw.size() / kBlock + 1, kBlock, raw.size() % kBlock})
    put(block_sizes, number);
  for (std::size_t at = 0; at < raw.size(); at += kBlock) {
    const std::string block = packed(raw.substr(at, kBlock), 0);
    put(block_sizes, static_cast<std::uint64_t>(block.size()));
    blocks += block;
  }
  std::string zlib_vti = vti;
  zlib_vti.insert(zlib_vti.find("><ImageData"), " compressor=\"vtkZLibDataCompressor\"");
  std::string vtr = vti;
  for (std::size_t at = 0; (at = vtr.find("ImageData", at)) != std::string::npos;)
    vtr.replace(at, 9, "RectilinearGrid");
  const std::string vtr_end =
      "</PointData><Coordinates><DataArray type=\"Float32\" format=\"ascii\">0 1 2 3 4</DataArray><DataArray "
      "type=\"Float32\" format=\"ascii\">0 1 2 3</DataArray><DataArray type=\"Float32\" format=\"ascii\">0 1 2"
      "</DataArray></Coordinates></Piece></RectilinearGrid>";
  return {
      {"raw.nrrd", nrrd + "raw\n\n" + raw, "", ""},
      {"gzip.nrrd", nrrd + "gzip\n\n" + packed(raw, 16), "", ""},
      {"text.nrrd", nrrd + "ascii\n\n" + text, "", ""},
      {"hex.nrrd", nrrd + "hex\n\n" + hex_of(raw), "", ""},
      {"big.nrrd",
       "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nendian: big\nencoding: raw\n\n" + turned, "", ""},
      {"a.nhdr", nrrd + "raw\ndata file: a.raw\n", "a.raw", raw},
      {"b.nhdr", nrrd + "gzip\ndata file: b.gz\n", "b.gz", packed(raw, 16)},
      {"c.nii", nii, "", ""},
      {"c.nii.gz", packed(nii, 16), "", ""},
      {"pair.hdr", nifti.version1(), "pair.img", raw},
      {"local.mha", meta + "ElementDataFile = LOCAL\n" + raw, "", ""},
      {"zlib.mha", meta + "CompressedData = True\nElementDataFile = LOCAL\n" + packed(raw, 0), "", ""},
      {"text.mha", meta + "BinaryData = False\nElementDataFile = LOCAL\n" + text, "", ""},
      {"d.mhd", meta + "ElementDataFile = d.raw\n", "d.raw", raw},
      {"e.mhd", meta + "CompressedData = True\nElementDataFile = e.zraw\n", "e.zraw", packed(raw, 16)},
      {"f.mhd", meta + "ElementDataFile = LIST 3D\nf.raw\n", "f.raw", raw},
      {"g.mif", mif_head + raw, "", ""},
      {"g.mif.gz", packed(mif_head + raw, 16), "", ""},
      {"h.mih", mif + "file: h.dat\nEND\n", "h.dat", raw},
      {"binary.vtk", vtk + "BINARY" + points + turned + "\n", "", ""},
      {"text.vtk", vtk + "ASCII" + points + text, "", ""},
      {"text.vti", vti + "\"ascii\">" + text + "</DataArray></PointData>" + vti_end + "</VTKFile>", "", ""},
      {"raw.vti",
       vti + "\"appended\" offset=\"0\"/></PointData>" + vti_end + "<AppendedData encoding=\"raw\">" +
           appended + raw + "</AppendedData></VTKFile>",
       "", ""},
      {"base64.vti",
       vti + "\"binary\">" + base64_of(length + raw) + "</DataArray></PointData>" + vti_end + "</VTKFile>",
       "", ""},
      {"zlib.vti",
       zlib_vti + "\"binary\">" + base64_of(block_sizes) + base64_of(blocks) + "</DataArray></PointData>" +
           vti_end + "</VTKFile>",
       "", ""},
      {"zlib_raw.vti",
       zlib_vti + "\"appended\" offset=\"0\"/></PointData>" + vti_end + "<AppendedData encoding=\"raw\">_" +
           block_sizes + blocks + "</AppendedData></VTKFile>",
       "", ""},
      {"base64_appended.vti",
       vti + "\"appended\" offset=\"0\"/></PointData>" + vti_end + "<AppendedData encoding=\"base64\">_" +
           base64_of(length + raw) + "</AppendedData></VTKFile>",
       "", ""},
      {"text.vtr", vtr + "\"ascii\">" + text + "</DataArray>" + vtr_end + "</VTKFile>", "", ""},
      {"raw.vtr",
       vtr + "\"appended\" offset=\"0\"/>" + vtr_end + "<AppendedData encoding=\"raw\">" + appended + raw +
           "</AppendedData></VTKFile>",
       "", ""},
      {"voxels.raw", raw, "", ""},
      // Voxels that are the last bytes, whatever stands before them: that is said.
      {"end.nrrd", nrrd + "raw\nbyte skip: -1\n\nwhatever" + raw, "", ""},
      {"end.nhdr", nrrd + "raw\nbyte skip: -1\ndata file: end.data\n", "end.data", "whatever" + raw},
      {"end.mhd", meta + "HeaderSize = -1\nElementDataFile = end.raw\n", "end.raw", "whatever" + raw},
      {"ends.mhd", meta + "HeaderSize = -1\nElementDataFile = LIST 3D\nends.raw\n", "ends.raw",
       "whatever" + raw},
  };
}

/// The values of the file's one array; none, with a line in `refusal`, where it is refused. A number of text that ends
/// with the file may be cut: that is said, and counts as a refusal.
std::vector<double> values_of(const std::filesystem::path& file, std::string& refusal) {
  LoadRequest request{.files = {file}, .solution = {}};
  if (file.filename() == "voxels.raw") request.raw = RawLayout{.size = kSize, .type = ScalarType::kInt16};
  refusal.clear();
  std::vector<double> values;
  try {
    Source source = Source::open(request);
    for (const std::string& note : source.info().notes) {
      if (note.find("cut off") != std::string::npos) refusal = file.string() + ": " + note;
    }
    const DataSet block = source.read({source.arrays().front().name}).at(0);
    for (std::size_t p = 0; p < block.arrays.at(0).tuples; ++p) values.push_back(block.arrays[0].at(p));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    refusal = error.what();
  }
  return values;
}

class CutOff : public ::testing::TestWithParam<Sample> {};

TEST_P(CutOff, GivesTheVoxelsOfTheWholeFileOrNone) {
  const Sample& sample = GetParam();
  const TempFolder folder;
  const auto file = folder.write(sample.name, sample.content);
  const std::string& whole = sample.voxels.empty() ? sample.content : sample.data;
  const auto cut = folder.path(sample.voxels.empty() ? sample.name : sample.voxels);
  const std::vector<std::int16_t> stored = numbers();
  const std::vector<double> truth(stored.begin(), stored.end());
  std::string refusal;
  folder.write(cut.filename(), whole);
  ASSERT_EQ(values_of(file, refusal), truth) << refusal;
  for (const std::size_t left : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3},
                                 std::size_t{9}, whole.size() / 10, whole.size() / 4, whole.size() / 2}) {
    folder.write(cut.filename(), whole.substr(0, whole.size() - left));
    const std::vector<double> values = values_of(file, refusal);
    const bool refused = !refusal.empty() && refusal.find(folder.path().string()) != std::string::npos;
    EXPECT_TRUE(refused || values == truth) << "without its last " << left << " bytes: " << refusal;
    if (left >= whole.size() / 10 && left > 0) {
      EXPECT_TRUE(refused) << left;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, CutOff, ::testing::ValuesIn(samples()), [](const auto& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

}  // namespace
}  // namespace palpate::test
