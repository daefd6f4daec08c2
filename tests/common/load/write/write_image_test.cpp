// Images as written, read back by their loaders: the same places, numbers, directions and tensors.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/image/image_header.h"
#include "common/load/write/image_origin.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "common/scene/origin_of.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Index3 kPoints{3, 4, 5};
constexpr std::size_t kVoxels = 60;

/// Oblique; the first axis runs to the left, or to the right.
UniformTopology grid(bool right_handed) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const double first = right_handed ? 2.0 : -2.0;
  return {
      kPoints, {10.0, -20.0, 5.5}, {first * Vec3{c, s, 0.0}, 2.5 * Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 3.0}}};
}

/// A tensor of its own at every point; the second has none.
std::vector<float> tensors() {
  std::vector<float> values;
  for (std::size_t p = 0; p < kVoxels; ++p) {
    const double t = 0.1 * static_cast<double>(p);
    const Vec3 v = glm::normalize(Vec3{std::cos(t), std::sin(2.0 * t), 0.7});
    const Mat3 d = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(v, v);
    for (const double x : {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]})
      values.push_back(p == 1 ? kNaN : static_cast<float>(x));
  }
  return values;
}

Input open(const std::filesystem::path& file, FieldKind kind) {
  InputOptions spec;
  spec.files = {file};
  spec.kind = kind;
  return Input::open(spec);
}

void expect_same_grid(const DataSet& image, const UniformTopology& wanted) {
  const auto& found = std::get<UniformTopology>(image.topology);
  EXPECT_EQ(found.points, wanted.points);
  EXPECT_LT(glm::distance(found.origin, wanted.origin), 1e-5);
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::distance(found.axes[axis], wanted.axes[axis]), 1e-6);
}

TEST(WriteImage, TensorsComeBackInTheAxesOfTheCoordinates) {
  const TempFolder folder;
  const std::vector<float> written = tensors();
  for (const bool right_handed : {false, true}) {
    for (const char* name : {"t.nii", "t.nii.gz", "t.nrrd"}) {
      for (const ImageConvention convention : {ImageConvention::kMrtrix, ImageConvention::kFsl}) {
        const UniformTopology topology = grid(right_handed);
        const auto file = folder.path(name);
        write_image(file, topology, ImageContent::kTensor, written, convention, true);
        const TensorImage read = open(file, FieldKind::kTensor).load_tensor_image(1);
        expect_same_grid(read.image, topology);
        const DataArray& array = *read.image.find(read.choice.array, Association::kPoint);
        for (std::size_t p = 0; p < kVoxels; ++p) {
          const auto d = read_tensor(array, p, read.choice.order);
          for (std::size_t c = 0; c < 6; ++c) {
            if (p == 1) {
              EXPECT_TRUE(std::isnan(d[c])) << name;
            } else {
              EXPECT_NEAR(d[c], static_cast<double>(written[6 * p + c]), 1e-9) << name << " voxel " << p;
            }
          }
        }
      }
    }
  }
}

TEST(WriteImage, NumbersComeBackAndMissingOnesStayMissing) {
  const TempFolder folder;
  std::vector<float> values(kVoxels);
  for (std::size_t p = 0; p < kVoxels; ++p) values[p] = 0.01F * static_cast<float>(p);
  values[7] = kNaN;
  for (const char* name : {"fa.nii", "fa.nii.gz", "fa.nrrd", "fa.vti"}) {
    write_image(folder.path(name), grid(false), ImageContent::kScalar, values, ImageConvention::kMrtrix,
                false);
    Input input = open(folder.path(name), FieldKind::kScalar);
    const DataSet image = input.read({input.arrays().front().name}).front();
    expect_same_grid(image, grid(false));
    for (std::size_t p = 0; p < kVoxels; ++p) {
      if (p == 7) {
        EXPECT_TRUE(std::isnan(image.arrays.front().at(p))) << name;
      } else {
        EXPECT_EQ(image.arrays.front().at(p), static_cast<double>(values[p])) << name;
      }
    }
  }
}

// Of coordinates whose orientation nobody knows nothing is claimed, and they stay where the format has a place for them.
TEST(WriteImage, ClaimsNoPatientWhereNoneIsKnown) {
  const TempFolder folder;
  const std::vector<float> values(kVoxels, 1.0F);
  for (const char* name : {"a.nrrd", "a.nii", "a.vti"}) {
    for (const ImageSpace space : {ImageSpace::kPatient, ImageSpace::kUnknown}) {
      const auto lost = write_image(folder.path(name), grid(false), ImageContent::kScalar, values,
                                    ImageConvention::kMrtrix, true, {.space = space, .header = {}});
      const bool placed = name != std::string("a.nii") || space == ImageSpace::kPatient;
      EXPECT_EQ(lost.empty(), placed) << name;
      Input read = open(folder.path(name), FieldKind::kScalar);
      if (name != std::string("a.vti")) {
        EXPECT_EQ(read.file()->anatomical, space == ImageSpace::kPatient);
      }
      if (placed) expect_same_grid(read.read({read.arrays().front().name}).front(), grid(false));
    }
  }
  const std::string nrrd = read_file(folder.path("a.nrrd"));
  EXPECT_EQ(nrrd.find("right"), std::string::npos);
  EXPECT_EQ(nrrd.find("mm"), std::string::npos);
  EXPECT_NE(nrrd.find("space dimension: 3"), std::string::npos);
  const std::string nifti = read_file(folder.path("a.nii"));
  EXPECT_EQ(nifti[123], 0) << "xyzt_units";
  EXPECT_EQ(nifti[252], 0) << "qform_code";
  EXPECT_EQ(nifti[254], 0) << "sform_code";
}

/// A number of a header.
template <typename T>
T number_in(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/// What nifti1.h says of a qform: the place of voxel `at` (method 2).
Vec3 by_qform(const std::string& h, const Vec3& at) {
  const double b = number_in<float>(h, 256), c = number_in<float>(h, 260), d = number_in<float>(h, 264);
  const double a = std::sqrt(std::max(0.0, 1.0 - b * b - c * c - d * d));
  Vec3 v;
  for (int i = 0; i < 3; ++i)
    v[i] = at[i] * static_cast<double>(number_in<float>(h, 80 + 4 * static_cast<std::size_t>(i)));
  if (number_in<float>(h, 76) < 0.0F) v.z = -v.z;
  return Vec3{(a * a + b * b - c * c - d * d) * v.x + 2.0 * (b * c - a * d) * v.y +
                  2.0 * (b * d + a * c) * v.z,
              2.0 * (b * c + a * d) * v.x + (a * a + c * c - b * b - d * d) * v.y +
                  2.0 * (c * d - a * b) * v.z,
              2.0 * (b * d - a * c) * v.x + 2.0 * (c * d + a * b) * v.y +
                  (a * a + d * d - c * c - b * b) * v.z} +
         Vec3{number_in<float>(h, 268), number_in<float>(h, 272), number_in<float>(h, 276)};
}
Vec3 by_sform(const std::string& h, const Vec3& at) {
  Vec3 x;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto number = [&](std::size_t c) {
      return static_cast<double>(number_in<float>(h, 280 + 16 * row + 4 * c));
    };
    x[static_cast<int>(row)] = number(0) * at.x + number(1) * at.y + number(2) * at.z + number(3);
  }
  return x;
}

// Both forms with their codes, units, description, intent and range; where they disagree, each keeps its own places.
TEST(WriteImage, TheHeaderOfAnImageIsSaidAgain) {
  const TempFolder folder;
  const std::vector<float> values(kVoxels, 1.0F);
  // The sform's space is the qform's turned by a quarter about z and moved, in micrometres.
  const Mat3 turn(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  for (const bool right_handed : {false, true}) {
    ImageHeader header{
        .description = "made by formula", .nifti = true, .units = 3 + 8, .sform_code = 4, .qform_code = 1};
    header.qform_turn = turn;
    header.qform_shift = {1.0, 2.0, 3.0};
    header.intent = 3;
    header.intent_parameters = {12.0F, 0.0F, 0.0F};
    header.intent_name = "t test";
    header.shown = {-1.0F, 2.0F};
    header.time = {2.5F, 0.25F};
    EXPECT_TRUE(write_image(folder.path("a.nii"), grid(right_handed), ImageContent::kScalar, values,
                            ImageConvention::kMrtrix, true, {.space = ImageSpace::kPatient, .header = header})
                    .empty());
    const std::string h = read_file(folder.path("a.nii"));
    EXPECT_EQ(number_in<std::int16_t>(h, 252), 1);
    EXPECT_EQ(number_in<std::int16_t>(h, 254), 4);
    EXPECT_EQ(h[123], 11);
    EXPECT_STREQ(h.c_str() + 148, "made by formula");
    EXPECT_EQ(number_in<std::int16_t>(h, 68), 3);
    EXPECT_EQ(number_in<float>(h, 56), 12.0F);
    EXPECT_STREQ(h.c_str() + 328, "t test");
    EXPECT_EQ(number_in<float>(h, 124), 2.0F);
    EXPECT_EQ(number_in<float>(h, 128), -1.0F);
    EXPECT_EQ(number_in<float>(h, 92), 2.5F);
    EXPECT_EQ(number_in<float>(h, 136), 0.25F);
    for (const Vec3& at : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 3, 0), Vec3(1, 2, 4)}) {
      const Vec3 x = grid(right_handed).origin + grid(right_handed).axes * at;
      EXPECT_LT(glm::distance(by_sform(h, at), 1e3 * x), 0.01);
      EXPECT_LT(glm::distance(by_qform(h, at), 1e3 * (turn * x + header.qform_shift)), 0.02);
    }
    // What is read of it is what was said.
    const auto read = read_image_header(folder.path("a.nii"));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->description, header.description);
    EXPECT_EQ(read->units, header.units);
    EXPECT_EQ(read->sform_code, 4);
    EXPECT_EQ(read->qform_code, 1);
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(read->qform_turn[c], turn[c]), 1e-5);
    EXPECT_LT(glm::distance(read->qform_shift, header.qform_shift), 1e-3);
    EXPECT_EQ(read->intent, 3);
    EXPECT_EQ(read->intent_name, "t test");
    EXPECT_EQ(read->shown, header.shown);
    EXPECT_EQ(read->time, header.time);
    EXPECT_FALSE(read->scaling);
    // Of other quantities at the same voxels: no intent and no range.
    write_image(folder.path("b.nii"), grid(right_handed), ImageContent::kVector,
                std::vector<float>(3 * kVoxels, 1.0F), ImageConvention::kMrtrix, true,
                {.space = ImageSpace::kPatient, .header = header.of_others()});
    const std::string other = read_file(folder.path("b.nii"));
    EXPECT_EQ(number_in<std::int16_t>(other, 68), 0);
    EXPECT_EQ(number_in<float>(other, 124), 0.0F);
    EXPECT_EQ(std::string(other.c_str() + 148), "directions, frame=scanner (RAS+); made by formula");
  }
}

// A file without an sform gets none, and one without any orientation states none.
TEST(WriteImage, FormsAreThoseOfTheInput) {
  const TempFolder folder;
  const std::vector<float> values(kVoxels, 1.0F);
  for (const int qform : {0, 2}) {
    for (const int sform : {0, 3}) {
      const ImageHeader header{
          .description = "", .nifti = true, .units = 2, .sform_code = sform, .qform_code = qform};
      write_image(folder.path("a.nii"), grid(false), ImageContent::kScalar, values, ImageConvention::kMrtrix,
                  true, {.space = ImageSpace::kPatient, .header = header});
      const std::string h = read_file(folder.path("a.nii"));
      EXPECT_EQ(number_in<std::int16_t>(h, 252), qform);
      EXPECT_EQ(number_in<std::int16_t>(h, 254), sform);
      EXPECT_EQ(open(folder.path("a.nii"), FieldKind::kScalar).file()->anatomical, qform + sform > 0);
      if (qform == 0) continue;
      const Vec3 at(1, 2, 4), x = grid(false).origin + grid(false).axes * at;
      EXPECT_LT(glm::distance(by_qform(h, at), x), 1e-5);
    }
  }
}

// Numbers behind a slope are stored as they were, where that gives the same values; else as what they are.
TEST(WriteImage, SlopesAreKeptWhereTheyLoseNothing) {
  const TempFolder folder;
  ImageHeader header{.description = "", .nifti = true, .units = 2, .sform_code = 1, .qform_code = 0};
  header.scaling = ImageHeader::Scaling{ScalarType::kInt16, 0.1F, -7.0};
  const double slope = header.scaling->slope;
  std::vector<float> values(kVoxels);
  for (std::size_t p = 0; p < kVoxels; ++p)
    values[p] = static_cast<float>(slope * (37.0 * static_cast<double>(p) - 900.0) - 7.0);
  for (const int change : {0, 1, 2, 3}) {
    std::vector<float> written = values;
    if (change == 1) written[5] = 0.123F;
    if (change == 2) written[5] = kNaN;
    if (change == 3) written[5] = 5000.0F;  // beyond 16 bits
    const DataArray array = make_array("s", Association::kPoint, 1, std::span<const float>(written));
    write_image(folder.path("a.nii"), grid(false), array, true,
                {.space = ImageSpace::kPatient, .header = header});
    const std::string h = read_file(folder.path("a.nii"));
    EXPECT_EQ(number_in<std::int16_t>(h, 70), change == 0 ? 4 : 16) << change;
    EXPECT_EQ(number_in<float>(h, 112), change == 0 ? 0.1F : 1.0F);
    EXPECT_EQ(number_in<float>(h, 116), change == 0 ? -7.0F : 0.0F);
    Input input = open(folder.path("a.nii"), FieldKind::kScalar);
    const DataArray read = input.read({input.arrays().front().name}).front().arrays.front();
    for (std::size_t p = 0; p < kVoxels; ++p) {
      if (std::isnan(written[p])) {
        EXPECT_TRUE(std::isnan(read.at(p)));
      } else {
        EXPECT_EQ(read.at(p), static_cast<double>(written[p]));
      }
    }
  }
}

// Names of segments, units of values and other pairs of an NRRD header are said again; not what is of its axes. What
// has no place for them says so, and labels stay labels there.
TEST(WriteImage, PairsUnitsAndLabelsAreSaidAgain) {
  const TempFolder folder;
  const std::string fields =
      "sample units: HU\nSegment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Extent:=0 1 0 1 0 1\n"
      "Vendor:=ACME: one\naxis 0 index type:=numeric\n";
  const auto file = folder.write("given.seg.nrrd",
                                 "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nspace: RAS\n"
                                 "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n" +
                                     fields + "encoding: raw\n\n" + std::string(8, '\1'));
  Input input = open(file, FieldKind::kScalar);
  const DataArray values = input.read({input.arrays().front().name}).front().arrays.front();
  const UniformTopology lattice{.points = {2, 2, 2}};
  EXPECT_TRUE(write_image(folder.path("a.nrrd"), lattice, values, false, origin_of(input)).empty());
  const std::string text = read_file(folder.path("a.nrrd"));
  for (const char* kept : {"\nsample units: HU\n", "\nSegment0_Name:=liver\n", "\nSegment0_LabelValue:=1\n",
                           "\nVendor:=ACME: one\n"})
    EXPECT_NE(text.find(kept), std::string::npos) << kept;
  for (const char* left : {"Extent", "index"}) EXPECT_EQ(text.find(left), std::string::npos) << left;
  EXPECT_EQ(read_image_header(folder.path("a.nrrd"))->labels, origin_of(input).header->labels);
  EXPECT_EQ(open(folder.path("a.nrrd"), FieldKind::kScalar).file()->units, "coordinates in mm, values in HU");

  const auto lost = write_image(folder.path("a.nii"), lattice, values, false, origin_of(input));
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost.front(),
            "no place for 3 lines of the header, names and colours of labels among them: .nrrd keeps them");
  EXPECT_EQ(number_in<std::int16_t>(read_file(folder.path("a.nii")), 68), 1002);  // NIFTI_INTENT_LABEL
  ImageOrigin others = origin_of(input);
  others.header = others.header->of_others();
  EXPECT_TRUE(write_image(folder.path("b.nrrd"), lattice, values, false, others).empty());
  EXPECT_EQ(read_file(folder.path("b.nrrd")).find(":="), std::string::npos);
  EXPECT_EQ(read_file(folder.path("b.nrrd")).find("sample units"), std::string::npos);
}

// Files of VTK, too. What a MetaImage says of that is heard.
TEST(WriteImage, VtiIsPackedAsTheInputWas) {
  const TempFolder folder;
  std::vector<float> values(kVoxels);
  for (std::size_t i = 0; i < kVoxels; ++i) values[i] = static_cast<float>(i);
  const std::string fields = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n";
  const auto meta = [&](const std::string& said) {
    const auto header = read_image_header(
        folder.write("a.mha", fields + said + "\nElementDataFile = LOCAL\nCompressedData = True"));
    return header && header->packed;
  };
  EXPECT_TRUE(meta("CompressedData = True"));
  EXPECT_TRUE(meta("CompressedDataSize = 20\nCompressedData=True"));
  EXPECT_FALSE(meta("CompressedData = False"));
  EXPECT_FALSE(meta("CompressedDataSize = 1"));
  for (const bool packed : {false, true}) {
    const ImageHeader header{.description = {}, .packed = packed};
    write_image(folder.path("a.vti"), grid(false), ImageContent::kScalar, values, ImageConvention::kMrtrix,
                true, {.space = ImageSpace::kPatient, .header = header});
    EXPECT_EQ(read_file(folder.path("a.vti")).find("compressor=") != std::string::npos, packed);
    const auto said = read_image_header(folder.path("a.vti"));
    EXPECT_EQ(said && said->packed, packed);
    Input input = open(folder.path("a.vti"), FieldKind::kScalar);
    const DataSet image = input.read({input.arrays().front().name}).front();
    for (std::size_t i = 0; i < kVoxels; ++i)
      ASSERT_EQ(image.arrays.front().at(i), static_cast<double>(i)) << packed;
  }
}

// NRRD files are packed where the input was, and keep its description.
TEST(WriteImage, NrrdIsPackedAsTheInputWas) {
  const TempFolder folder;
  const std::vector<float> values(kVoxels, 0.5F);
  for (const bool packed : {false, true}) {
    const ImageHeader header{.description = "made\nby formula", .packed = packed};
    write_image(folder.path("a.nrrd"), grid(false), ImageContent::kScalar, values, ImageConvention::kMrtrix,
                true, {.space = ImageSpace::kPatient, .header = header});
    const std::string text = read_file(folder.path("a.nrrd"));
    EXPECT_EQ(text.find("encoding: gzip") != std::string::npos, packed);
    EXPECT_NE(text.find("content: made by formula\n"), std::string::npos);
    Input input = open(folder.path("a.nrrd"), FieldKind::kScalar);
    EXPECT_EQ(read_image_header(folder.path("a.nrrd"))->packed, packed);
    EXPECT_EQ(read_image_header(folder.path("a.nrrd"))->description, "made by formula");
    const DataSet image = input.read({input.arrays().front().name}).front();
    expect_same_grid(image, grid(false));
    EXPECT_EQ(image.arrays.front().at(kVoxels - 1), 0.5);
  }
}

TEST(WriteImage, ColoursAreBytes) {
  const TempFolder folder;
  std::vector<float> colors(3 * kVoxels, 0.0F);
  colors[0] = 1.0F, colors[4] = 0.5F, colors[8] = 7.0F;
  for (const char* name : {"c.nii", "c.nrrd"}) {
    write_image(folder.path(name), grid(true), ImageContent::kColor, colors, ImageConvention::kMrtrix, false);
    Input input = open(folder.path(name), FieldKind::kScalar);
    const DataSet image = input.read({input.arrays().front().name}).front();
    EXPECT_EQ(image.arrays.front().components, 3);
    EXPECT_EQ(image.arrays.front().at(0, 0), 255.0);
    EXPECT_EQ(image.arrays.front().at(1, 1), 128.0);
    EXPECT_EQ(image.arrays.front().at(2, 2), 255.0);
    EXPECT_EQ(image.arrays.front().at(3, 0), 0.0);
  }
}

// Arrays keep their type, whatever is in them.
TEST(WriteImage, ArraysComeBackAsTheyAre) {
  const TempFolder folder;
  const auto check = [&]<typename T>(T, ScalarType type, int components) {
    const std::size_t count = kVoxels * static_cast<std::size_t>(components);
    const auto numbers = std::make_shared<std::vector<T>>(count);
    for (std::size_t i = 0; i < count; ++i) (*numbers)[i] = static_cast<T>(3 * i + 1);
    (*numbers)[0] = std::numeric_limits<T>::lowest();
    (*numbers)[1] = std::numeric_limits<T>::max();
    if (std::numeric_limits<T>::has_quiet_NaN) (*numbers)[7] = std::numeric_limits<T>::quiet_NaN();
    DataArray array;
    array.type = type;
    array.components = components;
    array.tuples = kVoxels;
    array.bytes = std::as_bytes(std::span(std::as_const(*numbers)));
    array.owner = numbers;
    for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.vti"}) {
      write_image(folder.path(name), grid(false), array, true);
      Input input = open(folder.path(name), FieldKind::kScalar);
      const DataSet image = input.read({input.arrays().front().name}).front();
      expect_same_grid(image, grid(false));
      const DataArray& read = image.arrays.front();
      EXPECT_EQ(read.type, type) << name;
      EXPECT_EQ(read.components, components) << name;
      EXPECT_TRUE(std::equal(read.bytes.begin(), read.bytes.end(), array.bytes.begin(), array.bytes.end()))
          << name << " " << name_of(type);
    }
  };
  check(std::int8_t{}, ScalarType::kInt8, 1);
  check(std::uint8_t{}, ScalarType::kUint8, 1);
  check(std::int16_t{}, ScalarType::kInt16, 1);
  check(std::uint16_t{}, ScalarType::kUint16, 1);
  check(std::int32_t{}, ScalarType::kInt32, 1);
  check(std::uint32_t{}, ScalarType::kUint32, 1);
  check(std::int64_t{}, ScalarType::kInt64, 1);
  check(std::uint64_t{}, ScalarType::kUint64, 1);
  check(float{}, ScalarType::kFloat32, 1);
  check(double{}, ScalarType::kFloat64, 1);
  check(std::uint8_t{}, ScalarType::kUint8, 3);
  check(std::uint8_t{}, ScalarType::kUint8, 4);
}

TEST(WriteImage, RefusesUnknownEndingsAndExistingFiles) {
  const TempFolder folder;
  EXPECT_THROW(check_image_output(folder.path("fa.png"), false), Error);
  const auto file = folder.write("fa.nii", "precious");
  EXPECT_THROW(check_image_output(file, false), Error);
  const std::vector<float> values(kVoxels, 1.0F);
  EXPECT_THROW(write_image(file, grid(true), ImageContent::kScalar, values, ImageConvention::kFsl, false),
               Error);
  EXPECT_EQ(read_file(file), "precious");
}

TEST(TensorMeasure, MeasuresTensorsAndHasNoneWhereThereIsNone) {
  DataSet image;
  image.topology = UniformTopology{.points = {2, 1, 1}};
  const std::vector<float> two{1.7e-3F, 0, 0, 0.3e-3F, 0, 0.3e-3F, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  image.arrays = {make_array("tensors", Association::kPoint, 6, std::span<const float>(two))};
  const TensorChoice choice{.array = "tensors"};
  const auto first = [&](TensorMeasure measure) {
    const std::vector<float> values = measure_tensors(image, choice, measure, 2);
    EXPECT_TRUE(std::isnan(values.back()));
    return static_cast<double>(values.front());
  };
  EXPECT_NEAR(first(TensorMeasure::kMd), 2.3e-3 / 3.0, 1e-9);
  EXPECT_NEAR(first(TensorMeasure::kLinear), 1.4 / 2.3, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kPlanar), 0.0, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kSpherical), 0.9 / 2.3, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kMode), 1.0, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kMainDirection), 1.0, 1e-6);
  const double fa = 1.4 / std::sqrt(1.7 * 1.7 + 2.0 * 0.3 * 0.3);
  EXPECT_NEAR(first(TensorMeasure::kFa), fa, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kColor), fa, 1e-6);
  EXPECT_EQ(measure_from_name("cl"), TensorMeasure::kLinear);
  EXPECT_THROW((void)measure_from_name("fractional"), Error);
}

}  // namespace
}  // namespace palpate::test
