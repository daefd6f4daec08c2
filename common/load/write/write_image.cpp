#include "common/load/write/write_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/output_file.h"
#include "common/base/text.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/vector_frame.h"
#include "common/math/lattice.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

enum class Ending : std::uint8_t { kNifti, kPackedNifti, kNrrd, kVti };

Ending ending_of(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (name.ends_with(".nii")) return Ending::kNifti;
  if (name.ends_with(".nii.gz")) return Ending::kPackedNifti;
  if (name.ends_with(".nrrd")) return Ending::kNrrd;
  if (name.ends_with(".vti")) return Ending::kVti;
  throw usage_error(path.string() + ": an image's name ends in .nii, .nii.gz, .nrrd or .vti");
}

/// Writes bytes as they are or through gzip, whose header carries no time: the same image, the same file.
class Sink {
 public:
  Sink(const std::filesystem::path& path, bool overwrite, bool packed) : file_(path, overwrite) {
    if (!packed) return;
    constexpr int kGzipWrapper = 16;  // added to the size of the window: gzip's header in place of zlib's
    constexpr int kMemoryLevel = 8;   // zlib's default
    packed_ = deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzipWrapper,
                           kMemoryLevel, Z_DEFAULT_STRATEGY) == Z_OK;
    if (!packed_) throw work_error(path.string() + ": not enough memory to pack it");
  }
  ~Sink() {
    if (packed_) deflateEnd(&stream_);
  }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  void write(std::string_view bytes) {
    if (packed_) {
      pack(bytes, Z_NO_FLUSH);
    } else {
      file_.write(bytes);
    }
  }
  void finish() {
    if (packed_) pack({}, Z_FINISH);
    file_.finish();
  }

 private:
  void pack(std::string_view bytes, int flush) {
    // zlib counts in 32 bits.
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::vector<Bytef> out(kPiece);
    do {
      const std::size_t taken = std::min(bytes.size(), kPiece);
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream_.avail_in = static_cast<uInt>(taken);
      bytes.remove_prefix(taken);
      do {
        stream_.next_out = out.data();
        stream_.avail_out = static_cast<uInt>(out.size());
        (void)deflate(&stream_, bytes.empty() ? flush : Z_NO_FLUSH);
        file_.write(std::as_bytes(std::span(out.data(), out.size() - stream_.avail_out)));
      } while (stream_.avail_out == 0);
    } while (!bytes.empty());
  }

  OutputFile file_;
  z_stream stream_{};
  bool packed_ = false;
};

/// Bytes of numbers as they lie in memory.
class Bytes {
 public:
  explicit Bytes(std::size_t size) : bytes_(size, '\0') {}
  template <typename T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof(T));
  }
  void put_text(std::size_t offset, std::string_view text) { bytes_.replace(offset, text.size(), text); }
  [[nodiscard]] const std::string& text() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

/// What the numbers of a voxel are, and how they are stored.
struct Stored {
  ImageContent content = ImageContent::kScalar;
  ScalarType type = ScalarType::kFloat32;
  int components = 1;

  [[nodiscard]] bool colors() const noexcept { return content == ImageContent::kColor; }
};

Stored stored_as(ImageContent content) {
  const bool colors = content == ImageContent::kColor;
  return {content, colors ? ScalarType::kUint8 : ScalarType::kFloat32, component_count(content)};
}

/// How the formats call a number type: the code of nifti1.h, the names of NRRD and of VTK.
struct TypeNames {
  std::int16_t nifti;
  const char *nrrd, *vtk;
};
TypeNames names_of(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
      return {256, "int8", "Int8"};
    case ScalarType::kUint8:
      return {2, "uint8", "UInt8"};
    case ScalarType::kInt16:
      return {4, "int16", "Int16"};
    case ScalarType::kUint16:
      return {512, "uint16", "UInt16"};
    case ScalarType::kInt32:
      return {8, "int32", "Int32"};
    case ScalarType::kUint32:
      return {768, "uint32", "UInt32"};
    case ScalarType::kInt64:
      return {1024, "int64", "Int64"};
    case ScalarType::kUint64:
      return {1280, "uint64", "UInt64"};
    case ScalarType::kFloat32:
      return {16, "float", "Float32"};
    case ScalarType::kFloat64:
      break;
  }
  return {64, "double", "Float64"};
}

constexpr std::int16_t kRgb = 128, kRgba = 2304;  ///< DT_RGB24, DT_RGBA32

/// The description in the header: its own fields cannot say along which axes directions and tensors are.
std::string nifti_description(ImageContent content, ImageConvention convention) {
  const bool fsl = convention == ImageConvention::kFsl;
  std::string text;
  if (content == ImageContent::kVector) text = "directions, ";
  if (content == ImageContent::kTensor) text = fsl ? "xx xy xz yy yz zz, " : "xx yy zz xy xz yz, ";
  if (text.empty()) return text;
  return text + frame_mark(fsl ? VectorFrame::kImage : VectorFrame::kScanner) +
         (fsl ? " (FSL's image axes)" : " (RAS+)");
}

/// The header of nifti1.h (348 bytes) with its 4 bytes of extension flags; the affine is the sform.
std::string nifti_header(const UniformTopology& topology, const Stored& stored, ImageSpace space,
                         const std::string& description = {}) {
  const int volumes = stored.colors() ? 1 : stored.components;
  const std::int16_t colors = stored.components == 4 ? kRgba : kRgb;
  const std::size_t bytes = byte_size(stored.type) * (stored.colors() ? as_size(stored.components) : 1);
  Bytes header(352);
  header.put(0, std::int32_t{348});
  header.put(40, static_cast<std::int16_t>(volumes > 1 ? 4 : 3));
  for (int axis = 0; axis < 3; ++axis)
    header.put(42 + 2 * as_size(axis), static_cast<std::int16_t>(topology.points[axis]));
  header.put(48, static_cast<std::int16_t>(volumes));
  for (std::size_t axis = 4; axis < 7; ++axis) header.put(42 + 2 * axis, std::int16_t{1});
  header.put(70, stored.colors() ? colors : names_of(stored.type).nifti);
  header.put(72, static_cast<std::int16_t>(8 * bytes));  // bits a voxel
  header.put(76, 1.0F);
  for (std::size_t axis = 0; axis < 7; ++axis) {
    const double step = axis < 3 ? glm::length(topology.axes[static_cast<int>(axis)]) : 1.0;
    header.put(80 + 4 * axis, static_cast<float>(step));
  }
  header.put(108, 352.0F);
  header.put(112, 1.0F);  // slope
  const bool patient = space == ImageSpace::kPatient;
  header.put(123, static_cast<char>(patient ? 2 : 0));          // millimetres, or unknown
  header.put(254, static_cast<std::int16_t>(patient ? 1 : 2));  // sform: scanner space, or that of some image
  for (int row = 0; row < 3; ++row) {
    const std::size_t at = 280 + 16 * as_size(row);
    for (int axis = 0; axis < 3; ++axis)
      header.put(at + 4 * as_size(axis), static_cast<float>(topology.axes[axis][row]));
    header.put(at + 12, static_cast<float>(topology.origin[row]));
  }
  header.put_text(148, description);
  header.put_text(344, std::string_view("n+1\0", 4));
  return header.text();
}

std::string vector_text(const Vec3& v) { return "(" + exact_text(v) + ")"; }

std::string nrrd_header(const UniformTopology& topology, const Stored& stored, ImageSpace space) {
  const bool patient = space == ImageSpace::kPatient;
  const ImageContent content = stored.content;
  const bool scalar = content == ImageContent::kScalar;
  std::string kind, size;
  switch (content) {
    case ImageContent::kScalar:
      break;
    case ImageContent::kVector:
      kind = "3-vector ", size = "3 ";
      break;
    case ImageContent::kTensor:
      kind = "3D-masked-symmetric-matrix ", size = "7 ";
      break;
    case ImageContent::kColor:
      kind = stored.components == 4 ? "RGBA-color " : "RGB-color ";
      size = std::to_string(stored.components) + " ";
      break;
  }
  std::string text =
      "NRRD0005\ntype: " + std::string(names_of(stored.type).nrrd) + "\ndimension: " + (scalar ? "3" : "4") +
      (patient ? "\nspace: right-anterior-superior" : "\nspace dimension: 3") + "\nsizes: " + size +
      std::to_string(topology.points.x) + " " + std::to_string(topology.points.y) + " " +
      std::to_string(topology.points.z) + "\nspace directions: " + (scalar ? "" : "none ") +
      vector_text(topology.axes[0]) + " " + vector_text(topology.axes[1]) + " " +
      vector_text(topology.axes[2]) + "\nkinds: " + kind + "space space space\n";
  // Tensors and directions are in the axes of the space.
  if (!scalar && content != ImageContent::kColor) text += "measurement frame: (1,0,0) (0,1,0) (0,0,1)\n";
  if (patient) text += "space units: \"mm\" \"mm\" \"mm\"\n";
  return text + "endian: little\nencoding: raw\nspace origin: " + vector_text(topology.origin) + "\n\n";
}

float finite_or_zero(float value) noexcept { return std::isfinite(value) ? value : 0.0F; }

std::uint8_t color_byte(float part) noexcept {
  return static_cast<std::uint8_t>(
      std::lround(255.0 * std::clamp(static_cast<double>(finite_or_zero(part)), 0.0, 1.0)));
}

/// The numbers of one voxel as a NIfTI file has them.
void to_convention(ImageContent content, const Mat3& axes_from_ras, ImageConvention convention, float* v) {
  if (content == ImageContent::kVector) {
    const Vec3 turned = axes_from_ras * Vec3{v[0], v[1], v[2]};
    for (int c = 0; c < 3; ++c) v[c] = static_cast<float>(turned[c]);
  } else if (content == ImageContent::kTensor) {
    const Mat3 d = axes_from_ras *
                   Mat3{Vec3{v[0], v[1], v[2]}, Vec3{v[1], v[3], v[4]}, Vec3{v[2], v[4], v[5]}} *
                   glm::transpose(axes_from_ras);
    const bool rows = convention == ImageConvention::kFsl;
    const std::array<double, 6> six = rows ? std::array{d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]}
                                           : std::array{d[0][0], d[1][1], d[2][2], d[1][0], d[2][0], d[2][1]};
    std::transform(six.begin(), six.end(), v, [](double value) { return static_cast<float>(value); });
  }
}

void write_nifti(Sink& sink, const UniformTopology& topology, ImageContent content,
                 std::span<const float> values, ImageConvention convention, ImageSpace space) {
  const auto components = as_size(component_count(content));
  const std::size_t voxels = values.size() / components;
  sink.write(nifti_header(topology, stored_as(content), space, nifti_description(content, convention)));
  if (content == ImageContent::kColor) {
    std::string bytes(values.size(), '\0');
    std::transform(values.begin(), values.end(), bytes.begin(),
                   [](float v) { return static_cast<char>(color_byte(v)); });
    sink.write(bytes);
    return;
  }
  const Mat3 axes_from_ras =
      convention == ImageConvention::kFsl ? glm::transpose(fsl_axes(topology.axes)) : Mat3{1.0};
  std::vector<float> turned(values.begin(), values.end());
  for (std::size_t v = 0; v < voxels; ++v) {
    float* const voxel = turned.data() + v * components;
    to_convention(content, axes_from_ras, convention, voxel);
    std::transform(voxel, voxel + components, voxel, finite_or_zero);
  }
  std::vector<float> volume(voxels);
  for (std::size_t c = 0; c < components; ++c) {
    for (std::size_t v = 0; v < voxels; ++v) volume[v] = turned[v * components + c];
    sink.write({reinterpret_cast<const char*>(volume.data()), volume.size() * sizeof(float)});
  }
}

void write_nrrd(Sink& sink, const UniformTopology& topology, ImageContent content,
                std::span<const float> values, ImageSpace space) {
  sink.write(nrrd_header(topology, stored_as(content), space));
  if (content == ImageContent::kColor) {
    std::string bytes(values.size(), '\0');
    std::transform(values.begin(), values.end(), bytes.begin(),
                   [](float v) { return static_cast<char>(color_byte(v)); });
    sink.write(bytes);
    return;
  }
  std::vector<float> numbers;
  const bool masked = content == ImageContent::kTensor;
  numbers.reserve(values.size() + (masked ? values.size() / 6 : 0));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (masked && i % 6 == 0) {
      const auto* const first = values.data() + i;
      numbers.push_back(std::all_of(first, first + 6, [](float v) { return std::isfinite(v); }) ? 1.0F
                                                                                                : 0.0F);
    }
    numbers.push_back(finite_or_zero(values[i]));
  }
  sink.write({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)});
}

/// VTK XML, ImageData, raw appended data. Its Direction has the unit axes as columns.
std::string vti_head(const UniformTopology& topology, const Stored& stored) {
  const ImageContent content = stored.content;
  std::string extent, spacing, direction, name;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string blank = axis > 0 ? " " : "";
    extent += blank + "0 " + std::to_string(topology.points[axis] - 1);
    spacing += blank + exact_number(glm::length(topology.axes[axis]));
  }
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      direction += (direction.empty() ? "" : " ") +
                   exact_number(topology.axes[axis][row] / glm::length(topology.axes[axis]));
    }
  }
  const char* role = content == ImageContent::kTensor   ? "Tensors"
                     : content == ImageContent::kVector ? "Vectors"
                                                        : "Scalars";
  name = content == ImageContent::kTensor   ? "tensors"
         : content == ImageContent::kVector ? "vectors"
                                            : "scalars";
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
         "<ImageData WholeExtent=\"" +
         extent + "\" Origin=\"" + exact_number(topology.origin.x) + " " + exact_number(topology.origin.y) +
         " " + exact_number(topology.origin.z) + "\" Spacing=\"" + spacing + "\" Direction=\"" + direction +
         "\">\n<Piece Extent=\"" + extent + "\">\n<PointData " + role + "=\"" + name +
         "\">\n<DataArray type=\"" + names_of(stored.type).vtk + "\" Name=\"" + name +
         "\" NumberOfComponents=\"" + std::to_string(stored.components) +
         "\" format=\"appended\" offset=\"0\"/>\n</PointData>\n</Piece>\n</ImageData>\n"
         "<AppendedData encoding=\"raw\">\n_";
}

void write_vti(Sink& sink, const UniformTopology& topology, ImageContent content,
               std::span<const float> values) {
  sink.write(vti_head(topology, stored_as(content)));
  std::string bytes;
  if (content == ImageContent::kColor) {
    bytes.resize(values.size());
    std::transform(values.begin(), values.end(), bytes.begin(),
                   [](float v) { return static_cast<char>(color_byte(v)); });
  } else {
    std::vector<float> numbers(values.begin(), values.end());
    if (content == ImageContent::kTensor) {
      // VTK counts xx yy zz xy yz xz.
      for (std::size_t v = 0; v < numbers.size(); v += 6) {
        const std::array<float, 6> rows{values[v],     values[v + 1], values[v + 2],
                                        values[v + 3], values[v + 4], values[v + 5]};
        const std::array<std::size_t, 6> order{0, 3, 5, 1, 4, 2};
        for (std::size_t c = 0; c < 6; ++c) numbers[v + c] = rows[order[c]];
      }
    }
    std::transform(numbers.begin(), numbers.end(), numbers.begin(), finite_or_zero);
    bytes.assign(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  }
  const std::uint64_t size = bytes.size();
  sink.write({reinterpret_cast<const char*>(&size), sizeof size});
  sink.write(bytes);
  sink.write("\n</AppendedData>\n</VTKFile>\n");
}

void check_size(const std::filesystem::path& path, Ending ending, const Index3& n) {
  constexpr int kMostNifti = 32767;
  const bool nifti = ending == Ending::kNifti || ending == Ending::kPackedNifti;
  if (nifti && std::max({n.x, n.y, n.z}) > kMostNifti)
    throw usage_error(path.string() +
                      ": too many voxels along an axis for NIfTI-1; take a name ending in .nrrd");
}

}  // namespace

int component_count(ImageContent content) noexcept {
  switch (content) {
    case ImageContent::kScalar:
      return 1;
    case ImageContent::kTensor:
      return 6;
    default:
      return 3;
  }
}

void check_image_output(const std::filesystem::path& path, bool overwrite) {
  (void)ending_of(path);
  check_output(path, overwrite);
}

void write_image(const std::filesystem::path& path, const UniformTopology& topology, ImageContent content,
                 std::span<const float> values, ImageConvention convention, bool overwrite,
                 ImageSpace space) {
  const std::size_t voxels = count_of(topology.points);
  PALPATE_CHECK(values.size() == voxels * as_size(component_count(content)));
  const Ending ending = ending_of(path);
  check_size(path, ending, topology.points);
  Sink sink(path, overwrite, ending == Ending::kPackedNifti);
  if (ending == Ending::kNrrd) {
    write_nrrd(sink, topology, content, values, space);
  } else if (ending == Ending::kVti) {
    write_vti(sink, topology, content, values);
  } else {
    write_nifti(sink, topology, content, values, convention, space);
  }
  sink.finish();
}

void write_image(const std::filesystem::path& path, const UniformTopology& topology, const DataArray& values,
                 bool overwrite, ImageSpace space) {
  PALPATE_CHECK(values.tuples == count_of(topology.points) && !values.sparse);
  const bool colors = values.components == 3 || values.components == 4;
  PALPATE_CHECK(values.components == 1 || (colors && values.type == ScalarType::kUint8));
  const Stored stored{colors ? ImageContent::kColor : ImageContent::kScalar, values.type, values.components};
  const Ending ending = ending_of(path);
  check_size(path, ending, topology.points);
  Sink sink(path, overwrite, ending == Ending::kPackedNifti);
  const std::string_view bytes(reinterpret_cast<const char*>(values.bytes.data()), values.bytes.size());
  if (ending == Ending::kNrrd) {
    sink.write(nrrd_header(topology, stored, space));
    sink.write(bytes);
  } else if (ending == Ending::kVti) {
    const std::uint64_t size = bytes.size();
    sink.write(vti_head(topology, stored));
    sink.write({reinterpret_cast<const char*>(&size), sizeof size});
    sink.write(bytes);
    sink.write("\n</AppendedData>\n</VTKFile>\n");
  } else {
    sink.write(nifti_header(topology, stored, space));
    sink.write(bytes);
  }
  sink.finish();
}

}  // namespace palpate
