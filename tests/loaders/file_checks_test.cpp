// The cheap checks that look at a file before its reader does.
#include <bit>

#include <gtest/gtest.h>

#include "loaders/nrrd/nrrd_check.h"
#include "loaders/vtk/ensight/ensight_counts.h"
#include "loaders/vtk/legacy_check.h"
#include "loaders/vtk/netcdf_check.h"
#include "loaders/vtk/xml_scan.h"

namespace palpate {
namespace {

const std::string kLegacyHead =
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
    "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n";

TEST(LegacyCheck, AGoodTextFilePasses) {
  EXPECT_EQ(scan_legacy(kLegacyHead + "SCALARS s float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\n").problem,
            "");
}

TEST(LegacyCheck, MetadataIsPassedOver) {
  EXPECT_EQ(
      scan_legacy(kLegacyHead +
                  "SCALARS s float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\nMETADATA\nINFORMATION 1\n"
                  "NAME RANGE LOCATION array\nDATA 2 0 7\n\nVECTORS v float\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
                  "0 0 0 0 0 0 0 0 0 0\n")
          .problem,
      "");
}

TEST(LegacyCheck, AMissingValueIsNamedWithItsLine) {
  const std::string problem =
      scan_legacy(kLegacyHead + "SCALARS s float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6\n").problem;
  EXPECT_NE(problem.find("7 of 8 values"), std::string::npos) << problem;
}

TEST(LegacyCheck, AHugeCountIsRefusedWithItsLine) {
  const std::string problem =
      scan_legacy(
          "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 1099511627776 float\n")
          .problem;
  EXPECT_EQ(problem.find("line 5"), 0U) << problem;
  EXPECT_NE(problem.find("POINTS claims 3298534883328 values"), std::string::npos) << problem;
}

TEST(LegacyCheck, ACountThatWrapsIsRefused) {
  // 2^64 / 3 + 1 points have 2 values modulo 2^64.
  EXPECT_NE(scan_legacy("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS "
                        "6148914691236517206 float\nxxxx")
                .problem,
            "");
}

TEST(LegacyCheck, UnknownWordsAreNamedAndRareSectionsLeftToVtk) {
  EXPECT_EQ(scan_legacy(kLegacyHead + "GLOBAL_IDS 1 2 3\n").problem, "");
  EXPECT_NE(scan_legacy(kLegacyHead + "SOMETHING_NEW 1 2 3\n").problem.find("SOMETHING_NEW"),
            std::string::npos);
  EXPECT_NE(scan_legacy("# vtk DataFile Version 3.0\nt\nASCII\nDATASET TABLE\n").problem.find("TABLE"),
            std::string::npos);
}

TEST(XmlTags, AttributesMayHoldEntitiesAndAngleBrackets) {
  XmlTags tags("<?xml version='1.0'?><!-- <no/> --><a b=\"x &lt; y\" c='1>0'/></d>");
  XmlTag tag;
  ASSERT_TRUE(tags.next(tag));
  EXPECT_EQ(tag.name, "a");
  EXPECT_EQ(tag.at("b"), "x < y");
  EXPECT_EQ(tag.at("c"), "1>0");
  EXPECT_TRUE(tag.opens && tag.closes);
  ASSERT_TRUE(tags.next(tag));
  EXPECT_EQ(tag.name, "d");
  EXPECT_FALSE(tag.opens);
  EXPECT_FALSE(tags.next(tag));
}

std::string unstructured(const std::string& points) {
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"" + points +
         "\" NumberOfCells=\"1\"><PointData><DataArray type=\"Float64\" Name=\"p\" NumberOfComponents=\"3\" "
         "format=\"ascii\">"
         "0 0 0 0 0 0 0 0 0 0 0 0</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>";
}

TEST(XmlScan, ListsArraysWithTheirShapes) {
  const XmlScan scan = scan_xml(unstructured("4"));
  EXPECT_EQ(scan.problem, "");
  ASSERT_EQ(scan.arrays.size(), 1U);
  EXPECT_EQ(scan.arrays[0].name, "p");
  EXPECT_EQ(scan.arrays[0].components, 3);
  EXPECT_TRUE(scan.arrays[0].on_points);
}

TEST(XmlScan, CountsThatCannotBeTrueAreRefused) {
  for (const char* count :
       {"1099511627776", "99999999999999999999999", "6148914691236517206", "-1", "many"}) {
    EXPECT_NE(scan_xml(unstructured(count)).problem, "") << count;
  }
}

TEST(XmlScan, AMissingEndIsNoticed) {
  const std::string text = unstructured("4");
  EXPECT_NE(scan_xml(text.substr(0, text.size() - 12)).problem, "");
}

TEST(XmlScan, PiecesMustCoverTheWholeExtent) {
  for (const char* type : {"ImageData", "RectilinearGrid", "StructuredGrid"}) {
    const auto problem = [type](const char* whole, const std::vector<std::string>& pieces) {
      const std::string kind(type);
      std::string text = "<VTKFile type=\"" + kind + "\"><" + kind + " WholeExtent=\"" + whole + "\">";
      for (const std::string& piece : pieces) text += "<Piece Extent=\"" + piece + "\"></Piece>";
      return scan_xml(text + "</" + kind + "></VTKFile>").problem;
    };
    const char* const box = "0 4 0 4 0 4";
    EXPECT_EQ(problem(box, {box}), "");
    EXPECT_EQ(problem(box, {"0 4 0 4 0 2", "0 4 0 4 2 4"}), "");
    EXPECT_EQ(problem(box, {"0 4 0 4 0 3", "0 4 0 4 1 4", box}), "") << "overlapping";
    EXPECT_EQ(problem("0 4 0 4 3 3", {"0 2 0 4 3 3", "1 4 0 4 3 3"}), "") << "flat";
    EXPECT_NE(problem(box, {"0 4 0 4 0 2"}), "");
    // As many cells as the whole has, and more, yet not all of them.
    EXPECT_NE(problem(box, {"0 4 0 4 0 2", "0 4 0 4 0 2"}).find("leave out 32 cells of 64"),
              std::string::npos);
    EXPECT_NE(problem(box, {"0 4 0 4 0 3", "0 4 0 4 0 2", "0 3 0 4 3 4", "0 4 0 2 2 4"})
                  .find("leave out 2 cells of 64"),
              std::string::npos);
    EXPECT_NE(problem("0 4 0 4 3 3", {"0 2 0 4 3 3", "0 2 0 4 3 3"}), "");
  }
}

/// One hexahedron with a text array `given` in the place of the same array that is right.
std::string hexahedron(const std::string& name = "", const std::string& given = "",
                       const std::string& type = "") {
  const auto array = [&](const char* own, const char* own_type, int components, const char* right) {
    const bool other = name == own;
    return std::string("<DataArray type=\"") + (other && !type.empty() ? type : own_type) + "\" Name=\"" +
           own + "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"ascii\">" +
           (other ? given : right) + "\n<InformationKey name=\"x\"/></DataArray>";
  };
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"8\" NumberOfCells=\"1\">"
         "<PointData>" +
         array("p", "Float32", 1, "0 1 2 3 4 5 6 7") + "</PointData><CellData>" +
         array("c", "Int8", 1, "-5") + "</CellData><Points>" +
         array("x", "Float64", 3, "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1") + "</Points><Cells>" +
         array("connectivity", "Int64", 1, "0 1 2 3 4 5 6 7") + array("offsets", "Int64", 1, "8") +
         array("types", "UInt8", 1, "12") + "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST(XmlScan, TextMustHoldAsManyNumbersAsTheTagsSay) {
  EXPECT_EQ(scan_xml(hexahedron()).problem, "");
  struct Wrong {
    const char* array;
    const char* text;
    const char* message;
  };
  for (const Wrong& wrong :
       {Wrong{"p", "0 1 2 3 4 5 6 7 8", "array 'p' has 9 values, expected 8"},
        {"p", "0 1 2 3 4 5 6", "array 'p' has 7 values, expected 8"},
        {"p", "", "array 'p' has 0 values, expected 8"},
        {"p", "0 1 2 3 4 5 6 0.1234-100", "value 8: found '0.1234-100'"},
        {"p", "0 1 2 3 4 5 6 1.0D+00", "value 8: found '1.0D+00'"},
        {"p", "0 1 2 3 4 5 6 1e39", "value 8: found '1e39', expected a number of type Float32"},
        {"c", "1 2", "array 'c' has 2 values, expected 1"},
        {"c", "128", "found '128', expected a number of type Int8"},
        {"c", "1.0", "found '1.0'"},
        {"x", "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 7", "array 'x' has 25 values, expected 24"},
        {"connectivity", "0 1 2 3 4 5 6 7 7", "array 'connectivity' has 9 values, expected 8"},
        {"connectivity", "0 1 2 3 4 5 6", "array 'connectivity' has 7 values, expected 8"},
        {"offsets", "8 8", "array 'offsets' has 2 values, expected 1"},
        {"offsets", "7", "array 'connectivity' has 8 values, expected 7"},
        {"types", "12 12", "array 'types' has 2 values, expected 1"},
        {"types", "268", "found '268'"}}) {
    const std::string problem = scan_xml(hexahedron(wrong.array, wrong.text)).problem;
    EXPECT_NE(problem.find(wrong.message), std::string::npos) << wrong.array << ": " << problem;
  }
  for (const char* right : {"+0 +1.5 -2. .3 4e0 5E+00 nan inf", "-nan -inf 1e-60 0 0 0 0 0"})
    EXPECT_EQ(scan_xml(hexahedron("p", right)).problem, "") << right;
  EXPECT_EQ(scan_xml(hexahedron("c", "200", "UInt8")).problem, "");
}

TEST(XmlScan, ArraysOfOneNameAreRefused) {
  std::string text = hexahedron();
  const std::size_t first = text.find("<DataArray"), end = text.find("</PointData>");
  const std::string again = text.substr(first, end - first);
  EXPECT_EQ(scan_xml(std::string(text).insert(text.find("</CellData>"), again)).problem.find("are called"),
            std::string::npos)
      << "one of points and one of cells are two";
  EXPECT_EQ(scan_xml(text.insert(end, again)).problem, "two arrays of points are called 'p'");
}

/// Characters that base64 has for bytes.
std::string base64(std::string bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  bytes.append(padding, '\0');
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b) group = group << 8U | static_cast<unsigned char>(bytes[i + b]);
    for (unsigned shift = 24; shift > 0; shift -= 6) text += kDigits[group >> (shift - 6) & 63U];
  }
  return text.replace(text.size() - padding, padding, padding, '=');
}

TEST(XmlScan, BinaryArraysMustHaveTheBytesThatTheTagsSay) {
  for (const std::uint32_t bytes : {16U, 12U, 20U}) {
    std::string header(4, '\0');
    header[0] = static_cast<char>(bytes);
    const std::string text =
        "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 1 0 1 0 0\"><Piece "
        "Extent=\"0 1 0 1 0 0\"><PointData><DataArray type=\"Float32\" Name=\"p\" format=\"binary\">\n " +
        base64(header + std::string(bytes, '\0')) +
        "\n</DataArray></PointData></Piece></ImageData></VTKFile>";
    EXPECT_EQ(scan_xml(text).problem.empty(), bytes == 16U) << scan_xml(text).problem;
  }
}

/// How a file holds its arrays.
struct Binary {
  bool appended = false;
  bool base64 = true;
  bool compressed = false;
  bool wide = false;   ///< header numbers of 8 bytes
  bool apart = false;  ///< base64 of the header and of the values in runs of their own
  bool big = false;    ///< the byte with most weight first
  std::size_t part = 64;
  std::string words() const {
    return std::string(appended ? "appended " : "inline ") + (base64 ? "base64" : "raw") +
           (compressed ? " compressed" : "") + (wide ? " UInt64" : "") + (apart ? " apart" : "");
  }
};

/// An array of so many bytes, in parts where compressed ones of 21 bytes are put in their place.
std::string stored(std::size_t bytes, const Binary& how) {
  std::string header;
  const auto put = [&](std::uint64_t number) {
    const unsigned most = how.wide ? 7U : 3U;
    for (unsigned byte = 0; byte <= most; ++byte)
      header += static_cast<char>(number >> 8U * (how.big ? most - byte : byte) & 0xffU);
  };
  std::string data;
  if (how.compressed) {
    const std::size_t blocks = (bytes + how.part - 1) / how.part;
    for (const std::size_t number : {blocks, how.part, bytes % how.part}) put(number);
    for (std::size_t block = 0; block < blocks; ++block) put(21);
    data.assign(21 * blocks, 'z');
  } else {
    put(bytes);
    data.assign(bytes, 'v');
  }
  if (!how.base64) return header + data;
  return how.compressed || how.apart ? base64(header) + base64(data) : base64(header + data);
}

/// Two triangles whose array `name` lacks its last characters, all others being whole.
std::string triangles(const Binary& how, const std::string& name, std::size_t cut) {
  std::string appended;
  const auto array = [&](const char* own, const char* type, int components, std::size_t bytes) {
    std::string data = stored(bytes, how);
    if (name == own) data.resize(data.size() - cut);
    const std::string tag = std::string("<DataArray type=\"") + type + "\" Name=\"" + own +
                            "\" NumberOfComponents=\"" + std::to_string(components) + "\" ";
    if (!how.appended) return tag + "format=\"binary\">\n" + data + "\n</DataArray>";
    const std::string offset = std::to_string(appended.size());
    appended += data;
    return tag + "format=\"appended\" offset=\"" + offset + "\"/>";
  };
  std::string text = std::string("<VTKFile type=\"UnstructuredGrid\" byte_order=\"") +
                     (how.big ? "BigEndian\"" : "LittleEndian\"") +
                     (how.wide ? " header_type=\"UInt64\"" : "") +
                     (how.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
                     "><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"2\"><Cells>";
  text += array("connectivity", "Int64", 1, 48) + array("offsets", "Int64", 1, 16) +
          array("types", "UInt8", 1, 2) + "</Cells><Points>" + array("x", "Float64", 3, 96) +
          "</Points><PointData>" + array("p", "Float32", 1, 16) + "</PointData></Piece></UnstructuredGrid>\n";
  if (how.appended)
    text += std::string("  <AppendedData encoding=\"") + (how.base64 ? "base64" : "raw") + "\">\n   _" +
            appended + "\n  </AppendedData>\n";
  return text + "</VTKFile>\n";
}

TEST(XmlScan, EveryBinaryArrayMustBeThereAsFarAsItsHeaderSays) {
  for (const bool appended : {false, true}) {
    for (const bool raw : {false, true}) {
      for (const bool compressed : {false, true}) {
        for (const bool wide : {false, true}) {
          for (const bool apart : {false, true}) {
            const Binary how{appended, !raw, compressed, wide, apart};
            if (raw && (apart || !appended)) continue;
            EXPECT_EQ(scan_xml(triangles(how, "", 0)).problem, "") << how.words();
            for (const char* name : {"connectivity", "offsets", "types", "x", "p"}) {
              for (const std::size_t cut : {1U, 2U, 3U, 4U, 6U}) {
                const std::string problem = scan_xml(triangles(how, name, cut)).problem;
                EXPECT_NE(problem.find("'" + std::string(name) + "'"), std::string::npos)
                    << how.words() << ", " << cut << " characters of " << name << " cut: " << problem;
              }
            }
          }
        }
      }
    }
  }
}

// VTK turns each part around by itself: the numbers at its borders come out wrong, and nobody is told.
TEST(XmlScan, PartsThatCutNumbersOfAnotherByteOrderAreRefused) {
  static_assert(std::endian::native == std::endian::little);
  for (const bool appended : {false, true}) {
    for (const bool big : {false, true}) {
      for (const std::size_t part : {std::size_t{64}, std::size_t{48}, std::size_t{60}, std::size_t{50}}) {
        const Binary how{.appended = appended, .compressed = true, .big = big, .part = part};
        const std::string problem = scan_xml(triangles(how, "", 0)).problem;
        if (!big || part % 8 == 0) {
          EXPECT_EQ(problem, "") << how.words() << ", " << part;
        } else {
          EXPECT_NE(problem.find("'x'"), std::string::npos) << problem;
          EXPECT_NE(problem.find("cut numbers of 8"), std::string::npos) << problem;
        }
      }
    }
  }
}

TEST(XmlScan, ArraysAtOneOffsetAreRefusedWhereTheirNamesDiffer) {
  std::string text = triangles({.appended = true, .base64 = false}, "", 0);
  const std::string offset = "offset=\"";
  const std::size_t x = text.find(offset, text.find("\"x\"")) + offset.size(),
                    p = text.find(offset, text.find("\"p\"")) + offset.size();
  ASSERT_LT(std::max(x, p), text.size());
  const std::string of_x = text.substr(x, text.find('"', x) - x),
                    of_p = text.substr(p, text.find('"', p) - p);
  text.replace(p, of_p.size(), of_x);
  EXPECT_NE(scan_xml(text).problem.find("are the same bytes"), std::string::npos) << scan_xml(text).problem;
}

TEST(XmlScan, RawDataMayEndWithBlanks) {
  std::string text = triangles({.appended = true, .base64 = false}, "", 0);
  text.replace(text.find("vv\n  </App"), 2, "\n ");
  EXPECT_EQ(scan_xml(text).problem, "");
  text.replace(text.find("  <AppendedData"), 2, "");
  text.replace(text.find("\n  </App"), 3, "");
  EXPECT_EQ(scan_xml(text).problem, "");
}

/// A netCDF classic header with one dimension and one float variable of that length.
std::string netcdf(std::uint32_t length, std::uint32_t begin, std::size_t data) {
  std::string text("CDF\1", 4);
  const auto put = [&text](std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
  };
  put(0);  // records
  for (const std::uint32_t v : {10U, 1U, 1U}) put(v);
  text += std::string("n\0\0\0", 4);
  put(length);
  put(0);
  put(0);  // no attributes
  for (const std::uint32_t v : {11U, 1U, 1U}) put(v);
  text += std::string("v\0\0\0", 4);
  for (const std::uint32_t v : {1U, 0U, 0U, 0U, 5U, length * 4U, begin}) put(v);
  return text + std::string(data, '\0');
}

TEST(NetcdfCheck, AVariableInsideTheFilePasses) {
  const std::string file = netcdf(10, 80, 40);
  ASSERT_EQ(file.size(), 120U);
  EXPECT_EQ(netcdf_problem(file, file.size()), "");
}

TEST(NetcdfCheck, AVariablePastTheEndIsNamed) {
  for (const auto& file : {netcdf(10, 80, 39), netcdf(0x7fffffff, 80, 40), netcdf(10, 0x7fffffff, 40)}) {
    EXPECT_NE(netcdf_problem(file, file.size()).find("'v'"), std::string::npos);
  }
}

TEST(NetcdfCheck, EveryTruncationOfTheHeaderIsNoticed) {
  const std::string file = netcdf(10, 80, 40);
  for (std::size_t size = 4; size < file.size(); ++size) {
    EXPECT_NE(netcdf_problem(std::string_view(file).substr(0, size), size), "") << size;
  }
}

TEST(NrrdCheck, ClaimsAreComparedWithTheData) {
  const auto problem = [](const std::string& sizes, const std::string& encoding, std::uint64_t bytes) {
    const NrrdClaims claims = read_nrrd_claims("NRRD0004\ntype: short\ndimension: 3\nsizes: " + sizes +
                                               "\nencoding: " + encoding + "\n\n");
    return claims.problem.empty() ? nrrd_size_problem(claims, bytes) : claims.problem;
  };
  EXPECT_EQ(problem("2 3 4", "raw", 48), "");
  EXPECT_NE(problem("2 3 4", "raw", 47), "");
  EXPECT_NE(problem("1099511627776 2 2", "raw", 1000), "");
  EXPECT_NE(problem("4294967296 4294967296 4294967296", "gzip", 1000), "");
  EXPECT_NE(problem("2 0 4", "raw", 48), "");
  EXPECT_NE(problem("2 -3 4", "raw", 48), "");
  EXPECT_EQ(problem("100 100 100", "gzip", 2000), "");
  EXPECT_NE(problem("100 100 1000", "gzip", 2000), "");
  EXPECT_NE(problem("2 3 4", "morse", 48), "");
}

TEST(NrrdCheck, NumberedDataFilesAreExpanded) {
  const NrrdClaims claims =
      read_nrrd_claims("NRRD0004\ntype: short\nsizes: 2 2 2\ndata file: slice%03d.raw 8 12 2\n");
  EXPECT_EQ(claims.data_files, (std::vector<std::string>{"slice008.raw", "slice010.raw", "slice012.raw"}));
}

std::string ensight_word(const std::string& text) { return text + std::string(80 - text.size(), '\0'); }

/// Vectors of two parts of three and two nodes, the first with `extra` numbers more.
std::string gold_vectors(bool text, int extra, const std::string& kind = "coordinates") {
  std::string out = text ? "flow\n" : ensight_word("flow");
  for (const int part : {1, 2}) {
    const int numbers = part == 1 ? 9 + extra : 6;
    if (text) {
      out += "part\n         " + std::to_string(part) + "\n" + kind + "\n";
      if (kind.ends_with("undef")) out += "-9.99000e+02\n";
      for (int i = 0; i < numbers; ++i) out += " 1.00000e+00\n";
    } else {
      out += ensight_word("part") + std::string({static_cast<char>(part), 0, 0, 0}) + ensight_word(kind);
      out += std::string(static_cast<std::size_t>(4 * (numbers + (kind.ends_with("undef") ? 1 : 0))), '\1');
    }
  }
  return out;
}

TEST(EnsightCounts, OneNumberTooManyOrTooFewIsFound) {
  const EnsightCounts both{Association::kPoint, 3, {3, 2}};
  for (const bool text : {true, false}) {
    for (const char* kind : {"coordinates", "coordinates undef"}) {
      SCOPED_TRACE(kind);
      EXPECT_EQ(gold_counts_problem(gold_vectors(text, 0, kind), text, both), "");
      for (const int extra : {1, -1, 4}) {
        const std::string problem = gold_counts_problem(gold_vectors(text, extra, kind), text, both);
        EXPECT_NE(problem.find("a part, number 1, of"), std::string::npos) << extra << ": " << problem;
      }
      // A whole vector more.
      EXPECT_NE(gold_counts_problem(gold_vectors(text, 3, kind), text, both).find("no part with 9 numbers"),
                std::string::npos);
    }
    // Surfaces between are not read.
    EXPECT_EQ(gold_counts_problem(gold_vectors(text, 0), text, {Association::kPoint, 3, {2}}), "");
    EXPECT_NE(gold_counts_problem(gold_vectors(text, 0), text, {Association::kPoint, 1, {8}}), "");
    const EnsightCounts cells{Association::kCell, 3, {3, 2}};
    EXPECT_EQ(gold_counts_problem(gold_vectors(text, 0, "hexa8"), text, cells), "");
    EXPECT_NE(gold_counts_problem(gold_vectors(text, 1, "hexa8"), text, cells), "");
  }
  std::string stars = gold_vectors(true, 0);
  stars.replace(stars.find(" 1.0"), 12, "************");
  EXPECT_NE(gold_counts_problem(stars, true, both).find("'************' in line 5"), std::string::npos);
  // What VTK's reader would take for 1, and for 0.1234.
  for (const char* word : {"1.#QNAN", "1.0D+02", "0.1234-100"}) {
    std::string wrong = gold_vectors(true, 0);
    wrong.replace(wrong.find(" 1.0"), 12, word);
    EXPECT_NE(gold_counts_problem(wrong, true, both).find("'" + std::string(word) + "' in line 5"),
              std::string::npos);
    EXPECT_NE(ensight6_counts_problem("flow\n " + std::string(word) + "\n", 1).find(word), std::string::npos);
  }
  const std::string six =
      "flow\n 1.00000e+00 2.00000e+00 3.00000e+00-1.00000e+00-2.00000e+00-3.00000e+00\n 1.00000e+00\n";
  EXPECT_EQ(ensight6_counts_problem(six, 7), "");
  EXPECT_EQ(ensight6_counts_problem(six, 6), "has 7 numbers, expected 6");
}

}  // namespace
}  // namespace palpate
