#include "common/load/write/write_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/tensor/gradient_table.h"
#include "common/load/write/image_origin.h"
#include "common/load/write/nifti_head.h"
#include "common/load/write/packed_appendix.h"
#include "common/load/write/vtp_appendix.h"
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
  Sink(const std::filesystem::path& path, bool overwrite, bool packed) : path_(path), file_(path, overwrite) {
    if (packed) pack_from_here();
  }
  ~Sink() {
    if (packed_) deflateEnd(&stream_);
  }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  /// What follows goes through gzip. @pre nothing did before.
  void pack_from_here() {
    constexpr int kGzipWrapper = 16;  // added to the size of the window: gzip's header in place of zlib's
    constexpr int kMemoryLevel = 8;   // zlib's default
    packed_ = deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzipWrapper,
                           kMemoryLevel, Z_DEFAULT_STRATEGY) == Z_OK;
    if (!packed_) throw work_error(path_.string() + ": not enough memory to pack it");
  }

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

  std::filesystem::path path_;
  OutputFile file_;
  z_stream stream_{};
  bool packed_ = false;
};

Stored stored_as(ImageContent content) {
  const bool colors = content == ImageContent::kColor;
  return {.content = content,
          .type = colors ? ScalarType::kUint8 : ScalarType::kFloat32,
          .components = component_count(content)};
}

/// Without ends of lines, which end a field.
std::string on_one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return text;
}

std::string vector_text(const Vec3& v) { return "(" + exact_text(v) + ")"; }

/// Whether voxels of NRRD and VTK are packed: as those were that the image is made of.
bool packs(const ImageOrigin& origin) { return origin.header && origin.header->packed; }

std::string nrrd_header(const UniformTopology& topology, const Stored& stored, const ImageOrigin& origin) {
  const bool patient = origin.space == ImageSpace::kPatient;
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
  const std::string content_words = origin.header ? with_description_of(*origin.header, {}) : std::string();
  if (!content_words.empty()) text += "content: " + on_one_line(content_words) + "\n";
  if (scalar && origin.header) {
    if (!origin.header->value_units.empty())
      text += "sample units: " + on_one_line(origin.header->value_units) + "\n";
    for (const std::string& pair : origin.header->pairs) text += pair + "\n";
  }
  return text + "endian: little\nencoding: " + (packs(origin) ? "gzip" : "raw") +
         "\nspace origin: " + vector_text(topology.origin) + "\n\n";
}

/// Black where it is no number: a byte has none for that.
std::uint8_t color_byte(float part) noexcept {
  return std::isfinite(part)
             ? static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(static_cast<double>(part), 0.0, 1.0)))
             : std::uint8_t{0};
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
                 std::span<const float> values, ImageConvention convention, const ImageOrigin& origin,
                 std::vector<std::string>& lost) {
  const auto components = as_size(component_count(content));
  const std::size_t voxels = values.size() / components;
  const ImageHeader header = header_of(origin);
  sink.write(nifti_head(topology, stored_as(content), header,
                        with_description_of(header, nifti_description(content, convention)), lost));
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
  for (std::size_t v = 0; v < voxels; ++v)
    to_convention(content, axes_from_ras, convention, turned.data() + v * components);
  std::vector<float> volume(voxels);
  for (std::size_t c = 0; c < components; ++c) {
    for (std::size_t v = 0; v < voxels; ++v) volume[v] = turned[v * components + c];
    sink.write({reinterpret_cast<const char*>(volume.data()), volume.size() * sizeof(float)});
  }
}

void write_nrrd(Sink& sink, const UniformTopology& topology, ImageContent content,
                std::span<const float> values, const ImageOrigin& origin) {
  sink.write(nrrd_header(topology, stored_as(content), origin));
  if (packs(origin)) sink.pack_from_here();
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
    numbers.push_back(values[i]);
  }
  sink.write({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)});
}

/// VTK XML, ImageData, appended data. Its Direction has the unit axes as columns.
void write_vti(Sink& sink, const UniformTopology& topology, const Stored& stored,
               std::span<const std::byte> bytes, bool packed) {
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
  const char* const type = names_of(stored.type).vtk;
  PackedAppendix packed_bytes;
  VtpAppendix plain_bytes;
  const std::string array = packed ? packed_bytes.declare(type, name, stored.components, bytes)
                                   : plain_bytes.declare(type, name, stored.components, bytes.size());
  sink.write(std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
                         "byte_order=\"LittleEndian\" header_type=\"UInt64\"") +
             (packed ? " compressor=\"vtkZLibDataCompressor\"" : "") + ">\n<ImageData WholeExtent=\"" +
             extent + "\" Origin=\"" + exact_number(topology.origin.x) + " " +
             exact_number(topology.origin.y) + " " + exact_number(topology.origin.z) + "\" Spacing=\"" +
             spacing + "\" Direction=\"" + direction + "\">\n<Piece Extent=\"" + extent + "\">\n<PointData " +
             role + "=\"" + name + "\">\n" + array +
             "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_");
  if (packed) {
    sink.write(packed_bytes.bytes());
  } else {
    const std::uint64_t size = bytes.size();
    sink.write({reinterpret_cast<const char*>(&size), sizeof size});
    sink.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  sink.write("\n</AppendedData>\n</VTKFile>\n");
}

void write_vti(Sink& sink, const UniformTopology& topology, ImageContent content,
               std::span<const float> values, bool packed) {
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
    bytes.assign(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  }
  write_vti(sink, topology, stored_as(content), std::as_bytes(std::span(bytes)), packed);
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

std::vector<std::string> write_image(const std::filesystem::path& path, const UniformTopology& topology,
                                     ImageContent content, std::span<const float> values,
                                     ImageConvention convention, bool overwrite, const ImageOrigin& origin) {
  const std::size_t voxels = count_of(topology.points);
  PALPATE_CHECK(values.size() == voxels * as_size(component_count(content)));
  const Ending ending = ending_of(path);
  check_size(path, ending, topology.points);
  std::vector<std::string> lost;
  Sink sink(path, overwrite, ending == Ending::kPackedNifti);
  if (ending == Ending::kNrrd) {
    write_nrrd(sink, topology, content, values, origin);
  } else if (ending == Ending::kVti) {
    write_vti(sink, topology, content, values, packs(origin));
  } else {
    write_nifti(sink, topology, content, values, convention, origin, lost);
  }
  sink.finish();
  return lost;
}

std::vector<std::string> write_image(const std::filesystem::path& path, const UniformTopology& topology,
                                     const DataArray& values, bool overwrite, const ImageOrigin& origin) {
  PALPATE_CHECK(values.tuples == count_of(topology.points) && !values.sparse);
  const bool colors = values.components == 3 || values.components == 4;
  PALPATE_CHECK(values.components == 1 || (colors && values.type == ScalarType::kUint8));
  Stored stored{.content = colors ? ImageContent::kColor : ImageContent::kScalar,
                .type = values.type,
                .components = values.components};
  const Ending ending = ending_of(path);
  check_size(path, ending, topology.points);
  std::vector<std::string> lost;
  Sink sink(path, overwrite, ending == Ending::kPackedNifti);
  const std::string_view bytes(reinterpret_cast<const char*>(values.bytes.data()), values.bytes.size());
  if (ending == Ending::kNrrd) {
    sink.write(nrrd_header(topology, stored, origin));
    if (packs(origin)) sink.pack_from_here();
    sink.write(bytes);
  } else if (ending == Ending::kVti) {
    write_vti(sink, topology, stored, values.bytes, packs(origin));
  } else {
    const ImageHeader header = header_of(origin);
    const std::optional<DataArray> unscaled =
        header.scaling ? stored_numbers(values, *header.scaling) : std::nullopt;
    if (unscaled) {
      stored.type = unscaled->type;
      stored.slope = header.scaling->slope;
      stored.intercept = header.scaling->intercept;
    }
    sink.write(nifti_head(topology, stored, header, with_description_of(header, {}), lost));
    sink.write(unscaled ? std::string_view(reinterpret_cast<const char*>(unscaled->bytes.data()),
                                           unscaled->bytes.size())
                        : bytes);
  }
  sink.finish();
  const std::size_t pairs = origin.header && !colors ? origin.header->pairs.size() : 0;
  if (ending != Ending::kNrrd && pairs > 0)
    lost.push_back("no place for " + counted(pairs, "line") + " of the header" +
                   (origin.header->labels ? ", names and colours of labels among them" : "") +
                   ": .nrrd keeps them");
  return lost;
}

void write_image(const std::filesystem::path& path, const UniformTopology& topology, ImageContent content,
                 std::span<const float> values, ImageConvention convention, bool overwrite,
                 ImageSpace space) {
  write_image(path, topology, content, values, convention, overwrite,
              ImageOrigin{.space = space, .header = {}});
}

void write_image(const std::filesystem::path& path, const UniformTopology& topology, const DataArray& values,
                 bool overwrite, ImageSpace space) {
  write_image(path, topology, values, overwrite, ImageOrigin{.space = space, .header = {}});
}

}  // namespace palpate
