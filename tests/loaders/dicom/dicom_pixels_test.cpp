// What DICOM pixels stand for: types, rescaling, units, colours, packing.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/load.h"
#include "tests/loaders/dicom/dicom_series.h"

namespace palpate::test {
namespace {

TEST_F(DicomTest, RescalesAndExtendsTheSign) {
  (void)write_volume([](DicomImage& image) {
    // 12 bits with a sign; what stands above them is none of the number's.
    image.bits_stored = 12;
    image.is_signed = true;
    image.slope = 0.5;
    image.intercept = 100.0;
    for (auto& pixel : image.pixels)
      pixel = static_cast<std::uint16_t>(((2 * (pixel - 600)) & 0x0FFF) | 0x5000);
  });
  expect_truth(open(folder_.path()).read({"scalars"}).front(), -500.0);
}

// A CT as scanners write it, 16 bits with a sign and an intercept of -1024, might hold -33792: where it does not, its
// voxels are whole numbers of 16 bits, packed ones and those of the other byte order too.
TEST_F(DicomTest, NumbersThatFitStayWholeNumbers) {
  for (const int kind : {0, 1, 2, 3, 4, 5}) {
    const bool far = kind % 2 != 0, packed = kind / 2 == 1, big = kind / 2 == 2;
    const TempFolder folder;
    for (int k : {2, 0, 3, 1}) {
      DicomImage image = slice(k);
      image.is_signed = true;
      image.slope = 1.0;
      image.intercept = -1024.0;
      if (far && k == 3) image.pixels[5] = 0x8000;
      if (packed) {
        image.syntax = "1.2.840.10008.1.2.5";
        image.pixel_bytes = rle_pixels(image.pixels);
      }
      if (big) image.syntax = "1.2.840.10008.1.2.2";
      const std::string start = dicom_preamble() + image.meta();
      (void)folder.write("im" + std::to_string(k),
                         big ? start + retyped(image.elements(), true) : image.bytes());
    }
    Source source = open(folder.path());
    const DataSet block = source.read({"scalars"}).front();
    EXPECT_EQ(block.arrays.front().type, far ? ScalarType::kFloat32 : ScalarType::kInt16) << kind;
    if (!far) {
      expect_truth(block, -1024.0);
    } else {
      EXPECT_EQ(block.arrays.front().at(3 * 12 + 5), -32768.0 - 1024.0);
    }
  }
}

// Of 12 bits in 16 those above are none of the number's, with a sign or without.
TEST_F(DicomTest, BitsBesideTheStoredOnesAreNoneOfWholeNumbers) {
  for (const bool is_signed : {false, true}) {
    const TempFolder folder;
    for (int k : {2, 0, 3, 1}) {
      DicomImage image = slice(k);
      image.bits_stored = 12;
      image.is_signed = is_signed;
      image.slope = 1.0;
      image.intercept = is_signed ? -24.0 : -1024.0;
      for (auto& pixel : image.pixels)
        pixel = static_cast<std::uint16_t>(((pixel - (is_signed ? 1000 : 0)) & 0x0FFF) | 0x5000);
      (void)folder.write("im" + std::to_string(k), image.bytes());
    }
    Source source = open(folder.path());
    const DataSet block = source.read({"scalars"}).front();
    EXPECT_EQ(block.arrays.front().type, ScalarType::kInt16);
    expect_truth(block, -1024.0);
  }
}

// Types that the file does not say are those of the dictionary: "1 " and "-1024 " are words. Neither preamble nor
// meta information is needed to see how a file is written.
TEST_F(DicomTest, TypesFollowFromTheDictionaryWhereTheFileDoesNotSayThem) {
  for (const char* way :
       {"implicit", "unknown", "big", "no preamble", "implicit, no meta", "explicit, no meta"}) {
    const std::string how = way;
    const TempFolder folder;
    for (int k : {2, 0, 3, 1}) {
      DicomImage image = slice(k);
      image.is_signed = true;
      image.slope = 1.0;
      image.intercept = -1024.0;
      if (how.starts_with("implicit")) image.syntax = "1.2.840.10008.1.2";
      if (how == "big") image.syntax = "1.2.840.10008.1.2.2";
      const std::string start = dicom_preamble() + image.meta();
      std::string file = image.elements();
      if (how == "unknown") {
        // All numbers of group 28, as of a program that does not know them.
        const std::string all = file;
        file.clear();
        for (std::size_t at = 0; at + 8 <= all.size();) {
          std::uint16_t group = 0, element = 0, length = 0;
          std::memcpy(&group, all.data() + at, 2);
          std::memcpy(&element, all.data() + at + 2, 2);
          std::memcpy(&length, all.data() + at + 6, 2);
          const bool last = group == 0x7fe0;
          const std::size_t size = last ? all.size() - at : 8U + length;
          file += group == 0x0028 ? dicom_element(group, element, "UN", all.substr(at + 8, length))
                                  : all.substr(at, size);
          at += size;
        }
      }
      if (how.starts_with("implicit")) file = retyped(file, false);
      if (how == "big") file = retyped(file, true);
      if (how == "no preamble") file = image.meta() + file;
      if (how.find("no meta") == std::string::npos && how != "no preamble") file = start + file;
      folder.write("s" + std::to_string(k), file);
    }
    SCOPED_TRACE(how);
    Source source = open(folder.path());
    expect_truth(source.read({"scalars"}).front(), -1024.0);
    EXPECT_TRUE(find_format(folder.path("s0")) == Format::kDicom);
  }
}

// Bits beside the stored ones may be above and below them.
TEST_F(DicomTest, ARescalingThatCannotBeReadIsRefused) {
  for (const std::uint16_t element : {0x1052, 0x1053}) {
    for (const char* text : {"2,5", "-1024 HU", "abc", "nan", "inf", "1e999"}) {
      const TempFolder folder;
      for (int k = 0; k < 3; ++k) {
        DicomImage image = slice(k);
        image.more = dicom_element(0x0028, element, "DS", text);
        folder.write(std::to_string(k), image.bytes());
      }
      const std::string line = refusal(folder.path());
      EXPECT_NE(line.find(element == 0x1052 ? "rescale intercept" : "rescale slope"), std::string::npos)
          << line;
      EXPECT_NE(line.find(text), std::string::npos) << line;
    }
  }
  // Blanks are none.
  (void)write_volume([](DicomImage& image) { image.more = dicom_element(0x0028, 0x1053, "DS", "  "); });
  expect_truth(open(folder_.path()).read({"scalars"}).front());
}

// Tables of 16 and of 8 bits of 2 n + 5, from a number on below which and above whose last all are alike.
TEST_F(DicomTest, ATableInThePlaceOfARescalingIsApplied) {
  for (const bool bytes : {false, true}) {
    const TempFolder folder;
    const int first = bytes ? 480 : 400, count = bytes ? 40 : 300;
    const auto value = [&](double stored) {
      return 2 * (std::clamp(static_cast<int>(stored), first, first + count - 1) - first) + 5;
    };
    std::string table;
    for (int n = 0; n < count; ++n) {
      if (bytes) table += static_cast<char>(value(first + n));
      if (!bytes) put(table, static_cast<std::uint16_t>(value(first + n)));
    }
    std::vector<DicomImage> images;
    for (int k = 0; k < 4; ++k) {
      images.push_back(slice(k));
      images.back().more = dicom_sequence(
          0x0028, 0x3000,
          {dicom_element(0x0028, 0x3002, "US",
                         as_bytes_of({static_cast<std::uint16_t>(count), static_cast<std::uint16_t>(first),
                                      static_cast<std::uint16_t>(bytes ? 8 : 16)})) +
           dicom_element(0x0028, 0x3004, "LO", "HU") + dicom_element(0x0028, 0x3006, "OW", table)});
      folder.write(std::to_string(k), images.back().bytes());
    }
    Source source = open(folder.path());
    EXPECT_NE(source.info().units.find("HU"), std::string::npos);
    const DataSet block = source.read({"scalars"}).front();
    for (std::size_t p = 0; p < 48; ++p)
      ASSERT_EQ(block.arrays.front().at(p), value(images[p / 12].pixels[p % 12])) << p;
  }
  const TempFolder folder;
  DicomImage none = slice(0);
  none.more = dicom_sequence(0x0028, 0x3000, {dicom_element(0x0028, 0x3004, "LO", "HU")});
  EXPECT_NE(refusal(folder.write("none", none.bytes())).find("without its table"), std::string::npos);
}

TEST_F(DicomTest, StoredBitsMayLieAnywhere) {
  (void)write_volume([](DicomImage& image) {
    image.bits_stored = 12;
    image.high_bit = 14;
    for (auto& pixel : image.pixels) pixel = static_cast<std::uint16_t>((pixel & 0x0FFF) << 3U | 0x8005);
  });
  expect_truth(open(folder_.path()).read({"scalars"}).front());
}

TEST_F(DicomTest, SaysUnitAndWindow) {
  (void)write_volume([](DicomImage& image) {
    image.modality = "CT";
    image.slope = 1.0;
    image.intercept = -1024.0;
    image.bits_stored = 12;
    image.window = {40.0, 401.0};
  });
  Source source = open(folder_.path());
  EXPECT_EQ(source.info().units, "coordinates in mm, values in HU");
  ASSERT_TRUE(source.info().window);
  EXPECT_EQ(*source.info().window, (std::array<double, 2>{-160.5, 239.5}));
  EXPECT_EQ(source.arrays().front().type, ScalarType::kInt16);  // -1024 to 3071
  expect_truth(source.read({"scalars"}).front(), -1024.0);
}

TEST_F(DicomTest, ReadsColours) {
  const auto color = [](int i, int part) { return static_cast<std::uint8_t>((13 * i + 70 * part) % 256); };
  for (const char* kind : {"RGB", "planar", "YBR_FULL", "PALETTE COLOR"}) {
    const TempFolder folder;
    for (int k = 0; k < 2; ++k) {
      DicomImage image = slice(k);
      image.photometric = std::string(kind) == "planar" ? "RGB" : kind;
      image.bits = image.bits_stored = 8;
      image.more_of_28 =
          dicom_element(0x0028, 0x0006, "US", as_bytes_of<std::uint16_t>({std::string(kind) == "planar"}));
      std::string numbers(image.photometric == "PALETTE COLOR" ? 12 : 36, '\0');
      for (int i = 0; i < 12; ++i) {
        const int n = 12 * k + i;
        const double r = color(n, 0), g = color(n, 1), b = color(n, 2);
        for (int c = 0; c < 3; ++c) {
          double value = color(n, c);
          // PS3.3 C.7.6.3.1.2
          if (image.photometric == "YBR_FULL") {
            value = c == 0   ? 0.299 * r + 0.587 * g + 0.114 * b
                    : c == 1 ? -0.1687 * r - 0.3313 * g + 0.5 * b + 128
                             : 0.5 * r - 0.4187 * g - 0.0813 * b + 128;
          }
          const int at = std::string(kind) == "planar" ? 12 * c + i : 3 * i + c;
          if (image.photometric != "PALETTE COLOR")
            numbers[static_cast<std::size_t>(at)] =
                static_cast<char>(std::clamp(std::lround(value), 0L, 255L));
        }
        if (image.photometric == "PALETTE COLOR") numbers[static_cast<std::size_t>(i)] = static_cast<char>(n);
      }
      for (int c = 0; c < 3 && image.photometric == "PALETTE COLOR"; ++c)
        image.more += dicom_element(0x0028, static_cast<std::uint16_t>(0x1101 + c), "US",
                                    as_bytes_of<std::uint16_t>({24, 0, 16}));
      for (int c = 0; c < 3 && image.photometric == "PALETTE COLOR"; ++c) {
        std::string table;
        for (int n = 0; n < 24; ++n) put(table, static_cast<std::uint16_t>(color(n, c) << 8U | 0x7F));
        image.more += dicom_element(0x0028, static_cast<std::uint16_t>(0x1201 + c), "OW", table);
      }
      image.pixel_bytes = dicom_element(0x7fe0, 0x0010, "OB", numbers);
      folder.write(std::to_string(k), image.bytes());
    }
    SCOPED_TRACE(kind);
    Source source = open(folder.path());
    const DataSet block = source.read({"colors"}).front();
    const DataArray& colors = block.arrays.at(0);
    ASSERT_EQ(colors.components, 3);
    EXPECT_EQ(colors.type, ScalarType::kUint8);
    for (int n = 0; n < 24; ++n) {
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(colors.at(static_cast<std::size_t>(n), c), color(n, c),
                    std::string(kind) == "YBR_FULL" ? 2 : 0)
            << n;
    }
  }
}

TEST_F(DicomTest, ReadsCompressedPixels) {
  (void)write_volume([](DicomImage& image) {
    image.syntax = "1.2.840.10008.1.2.5";
    image.pixel_bytes = rle_pixels(image.pixels);
  });
  expect_truth(open(folder_.path()).read({"scalars"}).front());
}

// What PS3.5 does not have, and GDCM reads wrong: bits beside the stored ones where it would have none.
TEST_F(DicomTest, RefusesCompressedPixelsWhoseBitsLieElsewhere) {
  (void)write_volume([](DicomImage& image) {
    image.syntax = "1.2.840.10008.1.2.5";
    image.bits_stored = 12;
    image.high_bit = 13;
    image.pixel_bytes = rle_pixels(image.pixels);
  });
  try {
    (void)open(folder_.path()).read({"scalars"});
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("12 bits of them up to bit 13"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace palpate::test
