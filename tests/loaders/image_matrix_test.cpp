// Images of one formula in every dialect that the formats have: encoding x type of number x byte order, in turn along
// axes that are straight, mirrored, exchanged and oblique. Each file is written here byte by byte, so that no reader or
// writer vouches for another, and each is right or refused. The table is part of loaders/README.md:
//   PALPATE_WRITE_PAGES=1 ctest --preset release -R loaders/image_matrix_test

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/load.h"
#include "tests/loaders/nifti_fixture.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr Index3 kPoints{5, 4, 3};
constexpr std::size_t kCount = 60;

/// A type of number, by the words of the formats; an empty one has it not.
struct NumberType {
  const char* name;
  std::size_t bytes;
  double base;  ///< of the values: beyond what a signed or a shorter type holds
  int nifti;
  const char *nrrd, *meta, *vtk, *legacy, *mif;
};
constexpr std::array<NumberType, 10> kTypes{
    {{"int8", 1, -100.0, 256, "signed char", "MET_CHAR", "Int8", "", "Int8"},
     {"uint8", 1, 200.0, 2, "uchar", "MET_UCHAR", "UInt8", "unsigned_char", "UInt8"},
     {"int16", 2, -30000.0, 4, "short", "MET_SHORT", "Int16", "short", "Int16"},
     {"uint16", 2, 60000.0, 512, "ushort", "MET_USHORT", "UInt16", "unsigned_short", "UInt16"},
     {"int32", 4, -2e9, 8, "int", "MET_INT", "Int32", "int", "Int32"},
     {"uint32", 4, 4e9, 768, "uint", "MET_UINT", "UInt32", "unsigned_int", "UInt32"},
     {"int64", 8, -4e15, 1024, "longlong", "MET_LONG_LONG", "Int64", "vtktypeint64", "Int64"},
     {"uint64", 8, 4e15, 1280, "ulonglong", "MET_ULONG_LONG", "UInt64", "vtktypeuint64", "UInt64"},
     {"float32", 4, -20.125, 16, "float", "MET_FLOAT", "Float32", "float", "Float32"},
     {"float64", 8, -1.0 / 3.0, 64, "double", "MET_DOUBLE", "Float64", "double", "Float64"}}};

/// The value at voxel i, j, k; exact in every type.
double value_at(const NumberType& type, const Vec3& voxel) {
  return type.base + 2.0 * voxel.x + 3.0 * voxel.y + 5.0 * voxel.z;
}

template <typename T>
std::string as(double value) {
  const T number = static_cast<T>(value);
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &number, sizeof(T));
  return bytes;
}

/// As it lies in memory, lowest byte first.
std::string number_bytes(const NumberType& type, double value) {
  const std::string name = type.name;
  if (name == "int8") return as<std::int8_t>(value);
  if (name == "uint8") return as<std::uint8_t>(value);
  if (name == "int16") return as<std::int16_t>(value);
  if (name == "uint16") return as<std::uint16_t>(value);
  if (name == "int32") return as<std::int32_t>(value);
  if (name == "uint32") return as<std::uint32_t>(value);
  if (name == "int64") return as<std::int64_t>(value);
  if (name == "uint64") return as<std::uint64_t>(value);
  return name == "float32" ? as<float>(value) : as<double>(value);
}

/// Of all voxels, the first axis fastest.
std::string voxels(const NumberType& type, bool big) {
  std::string all;
  for (int k = 0; k < kPoints.z; ++k)
    for (int j = 0; j < kPoints.y; ++j)
      for (int i = 0; i < kPoints.x; ++i) {
        std::string bytes = number_bytes(type, value_at(type, {i, j, k}));
        if (big) std::reverse(bytes.begin(), bytes.end());
        all += bytes;
      }
  return all;
}

/// Whole numbers digit by digit, as such text is written.
std::string number_text(const NumberType& type, double value) {
  const bool whole = value == std::floor(value);
  return whole && std::string(type.name).find("int") != std::string::npos
             ? std::to_string(static_cast<std::int64_t>(value))
             : exact_number(value);
}

std::string words(const NumberType& type) {
  std::string all;
  for (int k = 0; k < kPoints.z; ++k)
    for (int j = 0; j < kPoints.y; ++j)
      for (int i = 0; i < kPoints.x; ++i)
        all += number_text(type, value_at(type, {i, j, k})) + (i == 4 ? "\n" : " ");
  return all;
}

/// x = origin + axes voxel, RAS or the file's plain coordinates.
struct Placement {
  const char* name;
  Vec3 origin;
  Mat3 turn;  ///< columns: unit directions of the axes
  Vec3 spacing{1.0, 2.0, 1.5};

  [[nodiscard]] Mat3 axes() const { return {turn[0] * spacing.x, turn[1] * spacing.y, turn[2] * spacing.z}; }
};
const std::array<Placement, 4> kPlacements{
    {{"straight", {-10.0, 5.0, 30.0}, Mat3{1.0}},
     {"mirrored", {12.5, 40.0, -8.0}, Mat3{-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0}},
     {"exchanged", {1.0, 2.0, 3.0}, Mat3{0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0}},
     {"oblique", {-7.0, 0.5, 4.0}, Mat3{0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0}}}};

std::string packed(const std::string& content, int wrapper) {  // 0: zlib's, 16: gzip's
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + wrapper, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, content.size()) + 32, '\0');
  std::string in = content;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t b = 0; b < 3; ++b)
      three = three << 8U | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    for (std::size_t c = 0; c < 4; ++c)
      text += i + c > bytes.size() ? '=' : kLetters[three >> (18U - 6U * c) & 63U];
  }
  return text;
}

std::string hex(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const char byte : bytes) {
    text += kDigits[static_cast<unsigned char>(byte) >> 4U];
    text += kDigits[static_cast<unsigned char>(byte) & 15U];
  }
  return text;
}

std::string text_of(const Vec3& v, const char* between) {
  return exact_number(v.x) + between + exact_number(v.y) + between + exact_number(v.z);
}

/// What a dialect is to write.
struct Wanted {
  const NumberType& type;
  bool big;
  const Placement& placement;
};
/// The file that is opened, by name, after what lies beside it; nothing where the dialect has no such file.
struct File {
  std::string name, content;
  std::string beside = {}, beside_content = {};
};
struct Dialect {
  const char *format, *encoding;
  bool patient;  ///< coordinates are RAS
  std::function<std::optional<File>(const Wanted&)> write;
};

std::string nifti(const Wanted& wanted, bool pair) {
  NiftiHeader header{.size = {5, 4, 3}, .datatype = wanted.type.nifti, .pair = pair, .sform_code = 1};
  const Mat3 axes = wanted.placement.axes();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      header.srow[static_cast<std::size_t>(4 * r + c)] = static_cast<float>(axes[c][r]);
    header.srow[static_cast<std::size_t>(4 * r + 3)] = static_cast<float>(wanted.placement.origin[r]);
  }
  header.pixdim = {1.0, wanted.placement.spacing.x, wanted.placement.spacing.y, wanted.placement.spacing.z};
  std::string bytes = header.version1();
  put_at(bytes, 72, static_cast<std::int16_t>(8 * wanted.type.bytes));
  if (wanted.big) swap_nifti1(bytes, 1);
  return bytes + std::string(pair ? 0 : 4, '\0');
}

std::string nrrd(const Wanted& wanted, const std::string& encoding, bool lps) {
  const Vec3 signs = lps ? Vec3{-1.0, -1.0, 1.0} : Vec3{1.0};
  const Mat3 axes = wanted.placement.axes();
  std::string head = "NRRD0005\ntype: " + std::string(wanted.type.nrrd) + "\ndimension: 3\nspace: " +
                     (lps ? "left-posterior-superior" : "right-anterior-superior") + "\nsizes: 5 4 3\n";
  head += "space directions:";
  for (int a = 0; a < 3; ++a) head += " (" + text_of(signs * axes[a], ",") + ")";
  head += "\nspace origin: (" + text_of(signs * wanted.placement.origin, ",") + ")\n";
  if (wanted.type.bytes > 1 && encoding != "ascii")
    head += std::string("endian: ") + (wanted.big ? "big" : "little") + "\n";
  return head + "encoding: " + encoding + "\n";
}

std::string meta(const Wanted& wanted, const std::string& more) {
  const Vec3 signs{-1.0, -1.0, 1.0};  // places are LPS
  std::string head = "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryDataByteOrderMSB = ";
  head += wanted.big ? "True\n" : "False\n";
  head += "TransformMatrix =";
  for (int a = 0; a < 3; ++a) head += " " + text_of(signs * wanted.placement.turn[a], " ");
  head += "\nOffset = " + text_of(signs * wanted.placement.origin, " ");
  head += "\nElementSpacing = " + text_of(wanted.placement.spacing, " ") + "\nDimSize = 5 4 3\n" + more;
  return head + "ElementType = " + wanted.type.meta + "\n";
}

std::string vti(const Wanted& wanted, bool packed, const std::string& array,
                const std::string& appended = {}) {
  const Mat3& turn = wanted.placement.turn;
  std::string directions;  // row by row
  for (int r = 0; r < 3; ++r)
    directions +=
        exact_number(turn[0][r]) + " " + exact_number(turn[1][r]) + " " + exact_number(turn[2][r]) + " ";
  return std::string("<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"") +
         (wanted.big ? "Big" : "Little") + "Endian\" header_type=\"UInt64\"" +
         (packed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
         "><ImageData WholeExtent=\"0 4 0 3 0 2\" Origin=\"" + text_of(wanted.placement.origin, " ") +
         "\" Spacing=\"" + text_of(wanted.placement.spacing, " ") + "\" Direction=\"" + directions +
         "\"><Piece Extent=\"0 4 0 3 0 2\"><PointData Scalars=\"v\"><DataArray type=\"" + wanted.type.vtk +
         "\" Name=\"v\" " + array + "</PointData></Piece></ImageData>" + appended + "</VTKFile>";
}

std::string length_word(std::uint64_t length, bool big) {
  std::string word;
  put(word, length);
  if (big) std::reverse(word.begin(), word.end());
  return word;
}

/// One block of VTK's zlib compressor, its head apart.
std::pair<std::string, std::string> vtk_block(const std::string& raw, bool big) {
  const std::string block = packed(raw, 0);
  return {length_word(1, big) + length_word(raw.size(), big) + length_word(0, big) +
              length_word(block.size(), big),
          block};
}

std::string legacy(const Wanted& wanted, const char* encoding) {
  return std::string("# vtk DataFile Version 3.0\nt\n") + encoding +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nORIGIN " + text_of(wanted.placement.origin, " ") +
         "\nSPACING " + text_of(wanted.placement.spacing, " ") + "\nPOINT_DATA 60\nSCALARS v " +
         wanted.type.legacy + " 1\nLOOKUP_TABLE default\n";
}

std::string mif(const Wanted& wanted, const std::string& file) {
  std::string type = wanted.type.mif;
  if (wanted.type.bytes > 1) type += wanted.big ? "BE" : "LE";
  std::string head = "mrtrix image\ndim: 5,4,3\nvox: " + text_of(wanted.placement.spacing, ",") +
                     "\nlayout: +0,+1,+2\ndatatype: " + type + "\n";
  for (int r = 0; r < 3; ++r) {
    const Mat3& turn = wanted.placement.turn;
    head += "transform: " + exact_number(turn[0][r]) + "," + exact_number(turn[1][r]) + "," +
            exact_number(turn[2][r]) + "," + exact_number(wanted.placement.origin[r]) + "\n";
  }
  return head + "file: " + file + "\nEND\n";
}

std::vector<Dialect> dialects() {
  const auto raw = [](const Wanted& w) { return voxels(w.type, w.big); };
  const auto straight = [](const Wanted& w) { return w.placement.turn == Mat3{1.0}; };
  return {
      {"NIfTI", ".nii", true,
       [=](const Wanted& w) {
         return File{"a.nii", nifti(w, false) + raw(w)};
       }},
      {"NIfTI", ".nii.gz", true,
       [=](const Wanted& w) {
         return File{"a.nii.gz", packed(nifti(w, false) + raw(w), 16)};
       }},
      {"NIfTI", ".hdr + .img", true,
       [=](const Wanted& w) {
         return File{"a.hdr", nifti(w, true), "a.img", raw(w)};
       }},
      {"NRRD", "raw, RAS", true,
       [=](const Wanted& w) {
         return File{"a.nrrd", nrrd(w, "raw", false) + "\n" + raw(w)};
       }},
      {"NRRD", "gzip, LPS", true,
       [=](const Wanted& w) {
         return File{"a.nrrd", nrrd(w, "gzip", true) + "\n" + packed(raw(w), 16)};
       }},
      {"NRRD", "ascii, LPS", true,
       [=](const Wanted& w) {
         return File{"a.nrrd", nrrd(w, "ascii", true) + "\n" + words(w.type)};
       }},
      {"NRRD", "hex, RAS", true,
       [=](const Wanted& w) {
         return File{"a.nrrd", nrrd(w, "hex", false) + "\n" + hex(raw(w))};
       }},
      {"NRRD", ".nhdr + data", true,
       [=](const Wanted& w) {
         return File{"a.nhdr", nrrd(w, "raw", true) + "data file: a.raw\n", "a.raw", raw(w)};
       }},
      {"MetaImage", ".mha", true,
       [=](const Wanted& w) {
         return File{"a.mha", meta(w, "") + "ElementDataFile = LOCAL\n" + raw(w)};
       }},
      {"MetaImage", ".mha, zlib", true,
       [=](const Wanted& w) {
         const std::string data = packed(raw(w), 0);
         return File{
             "a.mha",
             meta(w, "CompressedData = True\nCompressedDataSize = " + std::to_string(data.size()) + "\n") +
                 "ElementDataFile = LOCAL\n" + data};
       }},
      {"MetaImage", ".mha, text", true,
       [=](const Wanted& w) {
         return File{"a.mha", meta(w, "BinaryData = False\n") + "ElementDataFile = LOCAL\n" + words(w.type)};
       }},
      {"MetaImage", ".mhd + .raw", true,
       [=](const Wanted& w) {
         return File{"a.mhd", meta(w, "") + "ElementDataFile = a.raw\n", "a.raw", raw(w)};
       }},
      {"MRtrix", ".mif", true,
       [=](const Wanted& w) {
         std::string head = mif(w, ". 512");
         head.resize(512, '\0');
         return File{"a.mif", head + raw(w)};
       }},
      {"MRtrix", ".mih + .dat", true,
       [=](const Wanted& w) {
         return File{"a.mih", mif(w, "a.dat"), "a.dat", raw(w)};
       }},
      {"VTK XML", ".vti, ascii", false,
       [=](const Wanted& w) {
         return File{"a.vti", vti(w, false, "format=\"ascii\">" + words(w.type) + "</DataArray>")};
       }},
      {"VTK XML", ".vti, base64", false,
       [=](const Wanted& w) {
         const std::string data = raw(w);
         return File{"a.vti", vti(w, false,
                                  "format=\"binary\">" + base64(length_word(data.size(), w.big) + data) +
                                      "</DataArray>")};
       }},
      {"VTK XML", ".vti, appended", false,
       [=](const Wanted& w) {
         const std::string data = raw(w);
         return File{"a.vti", vti(w, false, "format=\"appended\" offset=\"0\"/>",
                                  "<AppendedData encoding=\"raw\">_" + length_word(data.size(), w.big) +
                                      data + "</AppendedData>")};
       }},
      {"VTK XML", ".vti, zlib", false,
       [=](const Wanted& w) {
         const auto [head, block] = vtk_block(raw(w), w.big);
         return File{"a.vti",
                     vti(w, true, "format=\"binary\">" + base64(head) + base64(block) + "</DataArray>")};
       }},
      {"VTK legacy", ".vtk, ascii", false,
       [=](const Wanted& w) -> std::optional<File> {
         if (!straight(w) || w.type.legacy[0] == '\0') return std::nullopt;
         return File{"a.vtk", legacy(w, "ASCII") + words(w.type)};
       }},
      {"VTK legacy", ".vtk, binary", false, [=](const Wanted& w) -> std::optional<File> {
         // Always the highest byte first.
         if (!straight(w) || !w.big || w.type.legacy[0] == '\0') return std::nullopt;
         return File{"a.vtk", legacy(w, "BINARY") + raw(w) + "\n"};
       }}};
}

/// Empty: every voxel lies where it should and has its value.
std::string wrong(const std::filesystem::path& file, const Dialect& dialect, const Wanted& wanted) {
  Source source = Source::open({{file}, {}});
  if (source.info().anatomical != dialect.patient) return "coordinates are a patient's, or not";
  const DataSet block = source.read({source.arrays().at(0).name}).at(0);
  const auto& lattice = std::get<UniformTopology>(block.topology);
  const DataArray& values = block.arrays.at(0);
  if (values.tuples != kCount) return std::to_string(values.tuples) + " values";
  const Mat3 back = glm::inverse(wanted.placement.axes());
  std::size_t at = 0;
  for (int k = 0; k < lattice.points.z; ++k)
    for (int j = 0; j < lattice.points.y; ++j)
      for (int i = 0; i < lattice.points.x; ++i, ++at) {
        const Vec3 x = lattice.origin + lattice.axes * Vec3(i, j, k);
        const Vec3 voxel = back * (x - wanted.placement.origin);
        if (glm::distance(voxel, glm::round(voxel)) > 1e-5) return "a voxel lies beside its place";
        const double value = value_at(wanted.type, glm::round(voxel));
        if (values.at(at) != value)
          return exact_number(values.at(at)) + " in place of " + exact_number(value);
      }
  return {};
}

std::string table_of(const std::vector<std::vector<std::string>>& rows) {
  std::string text = "| format | encoding |";
  for (const NumberType& type : kTypes) text += std::string(" ") + type.name + " |";
  text += "\n|---|---|";
  for (std::size_t t = 0; t < kTypes.size(); ++t) text += "---|";
  text += "\n";
  for (const auto& row : rows) {
    text += "|";
    for (const std::string& cell : row) text += " " + cell + " |";
    text += "\n";
  }
  return text;
}

TEST(ImageMatrix, EveryDialectIsRightOrRefused) {
  const TempFolder folder;
  std::vector<std::vector<std::string>> rows;
  std::size_t turn = 0;
  for (const Dialect& dialect : dialects()) {
    std::vector<std::string> row{dialect.format, dialect.encoding};
    for (const NumberType& type : kTypes) {
      std::size_t right = 0, refused = 0;
      for (std::size_t run = 0; run < 4; ++run, ++turn) {
        // Both byte orders, and of placements two, others for the next type.
        const Wanted wanted{type, run % 2 == 1, kPlacements[(turn / 2) % kPlacements.size()]};
        std::optional<File> file = dialect.write(wanted);
        if (!file) file = dialect.write({type, run % 2 == 1, kPlacements[0]});
        if (!file) continue;
        const Wanted written = dialect.write(wanted) ? wanted : Wanted{type, wanted.big, kPlacements[0]};
        if (!file->beside.empty()) folder.write(file->beside, file->beside_content);
        const auto path = folder.write(file->name, file->content);
        const std::string what = std::string(dialect.format) + ", " + dialect.encoding + ", " + type.name +
                                 ", " + (written.big ? "big" : "little") + ", " + written.placement.name;
        try {
          const std::string fault = wrong(path, dialect, written);
          EXPECT_EQ(fault, "") << what;
          right += fault.empty() ? 1 : 0;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ExitCode::kBadInput) << what << ": " << error.what();
          ++refused;
          RecordProperty(what, error.what());
        }
        std::filesystem::remove(path);
      }
      EXPECT_TRUE(right == 0 || refused == 0)
          << dialect.format << ", " << dialect.encoding << ", " << type.name;
      row.emplace_back(right > 0 ? "right" : refused > 0 ? "refused" : "-");
    }
    rows.push_back(std::move(row));
  }

  const auto page = source_folder() / "loaders" / "README.md";
  std::string text = read_file(page);
  const std::string begin = "<!-- images -->\n", end = "<!-- end of images -->\n";
  const std::size_t from = text.find(begin), to = text.find(end);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  const std::string there = text.substr(from + begin.size(), to - from - begin.size());
  if (std::getenv("PALPATE_WRITE_PAGES") != nullptr) {
    std::ofstream(page) << text.replace(from + begin.size(), there.size(), table_of(rows));
  } else {
    EXPECT_EQ(there, table_of(rows)) << "write it again: PALPATE_WRITE_PAGES=1 ctest -R image_matrix_test";
  }
}

/// Text that the type does not hold as it is written is refused, or is that number: never the part of it that a reader
/// takes for one.
TEST(ImageMatrix, WordsThatAreNoNumbersOfTheTypeAreNotTakenForOthers) {
  const TempFolder folder;
  struct Case {
    std::size_t type;
    const char* word;
    double value;  ///< NaN: it is none of that type
  };
  const double none = std::nan("");
  for (const Case& one :
       {Case{2, "1.5", none},   Case{2, "2e3", 2000.0}, Case{2, "40000", none}, Case{2, "-32769", none},
        Case{3, "-1", none},    Case{3, "65536", none}, Case{1, "256", none},   Case{1, "0x10", none},
        Case{4, "12.", 12.0},   Case{4, "1_000", none}, Case{5, "4e9", 4e9},    Case{6, "1e-1", none},
        Case{8, "0.5x", none},  Case{8, "1.5.2", none}, Case{9, "1,5", none},   Case{9, "--3", none},
        Case{4, "seven", none}, Case{8, "1d3", none},   Case{2, "+7", 7.0},     Case{9, "+0.25", 0.25}}) {
    for (const Dialect& dialect : dialects()) {
      const std::string encoding = dialect.encoding;
      if (encoding.find("ascii") == std::string::npos && encoding.find("text") == std::string::npos) continue;
      const NumberType& type = kTypes[one.type];
      const auto file = dialect.write({type, false, kPlacements[0]});
      if (!file) continue;
      std::string content = file->content;
      const std::string first = number_text(type, value_at(type, Vec3{0.0})) + " ";
      content.replace(content.rfind(first + number_text(type, value_at(type, {1.0, 0.0, 0.0}))),
                      first.size() - 1, one.word);
      const auto path = folder.write(file->name, content);
      const std::string what =
          std::string(dialect.format) + ", " + encoding + ", " + type.name + ": " + one.word;
      try {
        Source source = Source::open({{path}, {}});
        const double found = source.read({source.arrays().at(0).name}).at(0).arrays.at(0).at(0);
        EXPECT_EQ(found, one.value) << what;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput) << what;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
