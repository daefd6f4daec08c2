/// Images of one formula in every dialect that the formats have, written byte by byte: encoding x type of number x byte order,
/// along axes that are straight, mirrored, exchanged and oblique.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/text.h"
#include "tests/loaders/dicom/dicom_fixture.h"
#include "tests/loaders/nifti_fixture.h"

namespace palpate::test::matrix {

inline constexpr Index3 kPoints{5, 4, 3};
inline constexpr std::size_t kCount = 60;

/// A type of number, by the words of the formats; an empty one has it not.
struct NumberType {
  const char* name;
  std::size_t bytes;
  double base;  ///< of the values: beyond what a signed or a shorter type holds
  int nifti;
  const char *nrrd, *meta, *vtk, *legacy, *mif;
};
inline constexpr std::array<NumberType, 10> kTypes{
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
inline double value_at(const NumberType& type, const Vec3& voxel) {
  return type.base + 2.0 * voxel.x + 3.0 * voxel.y + 5.0 * voxel.z;
}

template <typename T>
inline std::string as(double value) {
  const T number = static_cast<T>(value);
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &number, sizeof(T));
  return bytes;
}

/// As it lies in memory, lowest byte first.
inline std::string number_bytes(const NumberType& type, double value) {
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
inline std::string voxels(const NumberType& type, bool big) {
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
inline std::string number_text(const NumberType& type, double value) {
  const bool whole = value == std::floor(value);
  return whole && std::string(type.name).find("int") != std::string::npos
             ? std::to_string(static_cast<std::int64_t>(value))
             : exact_number(value);
}

inline std::string words(const NumberType& type) {
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
inline const std::array<Placement, 4> kPlacements{
    {{"straight", {-10.0, 5.0, 30.0}, Mat3{1.0}},
     {"mirrored", {12.5, 40.0, -8.0}, Mat3{-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0}},
     {"exchanged", {1.0, 2.0, 3.0}, Mat3{0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0}},
     {"oblique", {-7.0, 0.5, 4.0}, Mat3{0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0}}}};

inline std::string packed(const std::string& content, int wrapper) {  // 0: zlib's, 16: gzip's
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

inline std::string base64(const std::string& bytes) {
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

inline std::string hex(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const char byte : bytes) {
    text += kDigits[static_cast<unsigned char>(byte) >> 4U];
    text += kDigits[static_cast<unsigned char>(byte) & 15U];
  }
  return text;
}

inline std::string text_of(const Vec3& v, const char* between) {
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
  std::vector<std::pair<std::string, std::string>> beside = {};
};
struct Dialect {
  const char *format, *encoding;
  bool patient;  ///< coordinates are RAS
  std::function<std::optional<File>(const Wanted&)> write;
};

inline std::string nifti(const Wanted& wanted, bool pair) {
  NiftiHeader header{.size = {5, 4, 3}, .datatype = wanted.type.nifti, .pair = pair, .sform_code = 1};
  const Mat3 axes = wanted.placement.axes();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      header.srow[static_cast<std::size_t>(4 * r + c)] = static_cast<float>(axes[c][r]);
    header.srow[static_cast<std::size_t>(4 * r + 3)] = static_cast<float>(wanted.placement.origin[r]);
  }
  header.pixdim = {wanted.placement.spacing.x, wanted.placement.spacing.y, wanted.placement.spacing.z};
  std::string bytes = header.version1();
  put_at(bytes, 72, static_cast<std::int16_t>(8 * wanted.type.bytes));
  if (wanted.big) swap_nifti1(bytes, 1);
  return bytes + std::string(pair ? 0 : 4, '\0');
}

inline std::string nrrd(const Wanted& wanted, const std::string& encoding, bool lps) {
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

inline std::string meta(const Wanted& wanted, const std::string& more) {
  const Vec3 signs{-1.0, -1.0, 1.0};  // places are LPS
  std::string head = "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryDataByteOrderMSB = ";
  head += wanted.big ? "True\n" : "False\n";
  head += "TransformMatrix =";
  for (int a = 0; a < 3; ++a) head += " " + text_of(signs * wanted.placement.turn[a], " ");
  head += "\nOffset = " + text_of(signs * wanted.placement.origin, " ");
  head += "\nElementSpacing = " + text_of(wanted.placement.spacing, " ") + "\nDimSize = 5 4 3\n" + more;
  return head + "ElementType = " + wanted.type.meta + "\n";
}

inline std::string vti(const Wanted& wanted, bool packed, const std::string& array,
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

inline std::string length_word(std::uint64_t length, bool big) {
  std::string word;
  put(word, length);
  if (big) std::reverse(word.begin(), word.end());
  return word;
}

/// One block of VTK's zlib compressor, its head apart.
inline std::pair<std::string, std::string> vtk_block(const std::string& raw, bool big) {
  const std::string block = packed(raw, 0);
  return {length_word(1, big) + length_word(raw.size(), big) + length_word(0, big) +
              length_word(block.size(), big),
          block};
}

inline std::string legacy(const Wanted& wanted, const char* encoding) {
  return std::string("# vtk DataFile Version 3.0\nt\n") + encoding +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nORIGIN " + text_of(wanted.placement.origin, " ") +
         "\nSPACING " + text_of(wanted.placement.spacing, " ") + "\nPOINT_DATA 60\nSCALARS v " +
         wanted.type.legacy + " 1\nLOOKUP_TABLE default\n";
}

inline std::string mif(const Wanted& wanted, const std::string& file) {
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

/// A series of three images, one a slice; `how`: explicit, implicit, RLE or big endian. A word of 8 or 32 bits is written
/// with the lowest byte first alone, run lengths are those of 16 bits.
inline std::optional<File> dicom_series(const Wanted& wanted, const std::string& how) {
  const bool is_float = std::string(wanted.type.name).starts_with("float");
  if (is_float || wanted.type.bytes > 4 || wanted.big != (how == "big endian")) return std::nullopt;
  if ((how == "RLE" || how == "big endian") && wanted.type.bytes != 2) return std::nullopt;
  const Vec3 signs{-1.0, -1.0, 1.0};  // LPS
  const Placement& placement = wanted.placement;
  const std::size_t slice = as_size(kPoints.x * kPoints.y) * wanted.type.bytes;
  const std::string all = voxels(wanted.type, false);
  std::vector<std::pair<std::string, std::string>> files;
  for (int k = 0; k < kPoints.z; ++k) {
    DicomImage image{.columns = kPoints.x, .rows = kPoints.y};
    image.position = signs * (placement.origin + placement.axes() * Vec3(0, 0, k));
    image.along_row = signs * placement.turn[0];
    image.along_column = signs * placement.turn[1];
    image.row_step = placement.spacing.y;
    image.column_step = placement.spacing.x;
    image.instance = k + 1;
    image.bits = image.bits_stored = static_cast<int>(8 * wanted.type.bytes);
    image.is_signed = wanted.type.name[0] == 'i';
    const std::string numbers = all.substr(as_size(k) * slice, slice);
    image.pixel_bytes = dicom_element(0x7fe0, 0x0010, image.bits == 8 ? "OB" : "OW", numbers);
    if (how == "implicit") image.syntax = "1.2.840.10008.1.2";
    if (how == "big endian") image.syntax = "1.2.840.10008.1.2.2";
    if (how == "RLE") {
      image.syntax = "1.2.840.10008.1.2.5";
      std::vector<std::uint16_t> words(slice / 2);
      std::memcpy(words.data(), numbers.data(), slice);
      image.pixel_bytes = rle_pixels(words);
    }
    const bool explicit_little = how == "explicit" || how == "RLE";
    files.emplace_back(
        "a" + std::to_string(k) + ".dcm",
        explicit_little ? image.bytes()
                        : dicom_preamble() + image.meta() + retyped(image.elements(), how == "big endian"));
  }
  return File{files[0].first, files[0].second, {files[1], files[2]}};
}

inline std::vector<Dialect> dialects() {
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
         return File{"a.hdr", nifti(w, true), {{"a.img", raw(w)}}};
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
         return File{"a.nhdr", nrrd(w, "raw", true) + "data file: a.raw\n", {{"a.raw", raw(w)}}};
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
         return File{"a.mhd", meta(w, "") + "ElementDataFile = a.raw\n", {{"a.raw", raw(w)}}};
       }},
      {"DICOM", "explicit", true, [](const Wanted& w) { return dicom_series(w, "explicit"); }},
      {"DICOM", "implicit", true, [](const Wanted& w) { return dicom_series(w, "implicit"); }},
      {"DICOM", "big endian", true, [](const Wanted& w) { return dicom_series(w, "big endian"); }},
      {"DICOM", "RLE", true, [](const Wanted& w) { return dicom_series(w, "RLE"); }},
      {"MRtrix", ".mif", true,
       [=](const Wanted& w) {
         std::string head = mif(w, ". 512");
         head.resize(512, '\0');
         return File{"a.mif", head + raw(w)};
       }},
      {"MRtrix", ".mih + .dat", true,
       [=](const Wanted& w) {
         return File{"a.mih", mif(w, "a.dat"), {{"a.dat", raw(w)}}};
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

}  // namespace palpate::test::matrix
