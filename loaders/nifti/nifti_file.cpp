#include "loaders/nifti/nifti_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include <nifti/nifti2_io.h>
#include <nifti/znzlib.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/header_of_pair.h"
#include "common/load/volume_block.h"
#include "common/load/voxel_bytes.h"
#include "loaders/nifti/nifti_check.h"
#include "loaders/nifti/nifti_place.h"

namespace palpate {
namespace {

using ImagePtr = std::unique_ptr<nifti_image, void (*)(nifti_image*)>;

/// What the header calls a voxel: numbers of a type, several where it is a colour.
struct Voxel {
  ScalarType type = ScalarType::kUint8;
  int components = 1;
};

Voxel voxel_of(int datatype, const std::string& file) {
  switch (datatype) {
    case DT_UINT8:
      return {ScalarType::kUint8};
    case DT_INT8:
      return {ScalarType::kInt8};
    case DT_INT16:
      return {ScalarType::kInt16};
    case DT_UINT16:
      return {ScalarType::kUint16};
    case DT_INT32:
      return {ScalarType::kInt32};
    case DT_UINT32:
      return {ScalarType::kUint32};
    case DT_INT64:
      return {ScalarType::kInt64};
    case DT_UINT64:
      return {ScalarType::kUint64};
    case DT_FLOAT32:
      return {ScalarType::kFloat32};
    case DT_FLOAT64:
      return {ScalarType::kFloat64};
    case DT_RGB24:
      return {ScalarType::kUint8, 3};
    case DT_RGBA32:
      return {ScalarType::kUint8, 4};
    default:
      throw input_error({file, "header", std::string("has values of type ") + nifti_datatype_string(datatype),
                         "integers or floating-point numbers of at most 64 bits"});
  }
}

constexpr std::size_t kPairBytes = std::size_t{64} << 10;  // of which a header can be unpacked

bool is_vector_intent(int intent) {
  return intent == NIFTI_INTENT_VECTOR || intent == NIFTI_INTENT_DISPVECT ||
         intent == NIFTI_INTENT_RGB_VECTOR;
}

/// The voxels' file, closed at the end.
class VoxelFile {
 public:
  explicit VoxelFile(const nifti_image& image)
      : file_(znzopen(image.iname, "rb", nifti_is_gzfile(image.iname))) {}
  ~VoxelFile() {
    if (!znz_isnull(file_)) znzclose(file_);
  }
  VoxelFile(const VoxelFile&) = delete;
  VoxelFile& operator=(const VoxelFile&) = delete;

  /// How many bytes were there.
  std::uint64_t read(std::uint64_t offset, std::span<std::byte> out) {
    if (znz_isnull(file_) || znzseek(file_, static_cast<znz_off_t>(offset), SEEK_SET) < 0) return 0;
    const std::size_t got = znzread(out.data(), 1, out.size(), file_);
    return got <= out.size() ? got : 0;  // znzlib says -1 of an error
  }

  /// Reads on to the end, where gzip keeps its checksum, and closes the file. False where it is damaged or
  /// cut off there.
  bool ends_well() {
    constexpr std::size_t kChunk = std::size_t{1} << 16U;
    std::vector<std::byte> rest(kChunk);
    std::size_t got = 0;
    do {
      got = znzread(rest.data(), 1, kChunk, file_);
      if (got > kChunk) return false;  // znzlib's way to say -1
    } while (got == kChunk);
    return znzclose(file_) == 0;  // sets file_ to null
  }

 private:
  znzFile file_;
};

}  // namespace

struct NiftiFile::Image {
  Image(std::string file, FourthAxis fourth_axis, std::optional<bool> left_handed) : file_(std::move(file)) {
    if (const auto header = header_of_pair(file_, read_head(file_, kPairBytes).bytes)) {
      place_.notes.push_back("the header is " + header->filename().string());
      file_ = header->string();
    }
    const NiftiClaims claims = check_nifti(file_);
    nifti_set_debug_level(0);
    // niftilib goes by the name.
    const bool named = nifti_find_file_extension(file_.c_str()) != nullptr &&
                       claims.packed == (nifti_is_gzfile(file_.c_str()) != 0);
    if (!named) {
      throw input_error(
          {file_, "", claims.packed ? "is NIfTI packed by gzip, not named so" : "is NIfTI, not named so",
           claims.packed ? "a name ending in .nii.gz" : "a name ending in .nii or .hdr", "rename it"});
    }
    image_.reset(claims.bits ? read_binary_header() : nifti_image_read(file_.c_str(), 0));
    if (!image_)
      throw input_error({file_, "header", "niftilib cannot read it", "", "the file may be damaged"});
    if (claims.pair) check_nifti_voxels(image_->iname, claims);
    bits_ = claims.bits;
    if (claims.offset != claims.stated_offset) {
      image_->iname_offset = static_cast<std::int64_t>(claims.offset);
      place_.notes.push_back("WARNING: the header says that its voxels begin at byte " +
                             std::to_string(claims.stated_offset) + ", within the header: taken from byte " +
                             std::to_string(claims.offset) + " on");
    }
    NiftiPlace place = place_of(claims, left_handed);
    place.notes.insert(place.notes.begin(), place_.notes.begin(), place_.notes.end());
    place_ = std::move(place);
    note_rest(claims);
    describe_values(fourth_axis, claims.time_step);
    if (scaled_ && !std::isfinite(claims.intercept))
      place_.notes.emplace_back("WARNING: the header's intercept (scl_inter) is no number: taken for 0");
  }

  /// niftilib knows no bits: it is told that they are bytes. Null where it cannot read the header.
  [[nodiscard]] nifti_image* read_binary_header() const {
    int swapped = 0;
    const std::unique_ptr<nifti_1_header, decltype(&std::free)> header(
        nifti_read_n1_hdr(file_.c_str(), &swapped, 0), std::free);
    if (!header || header->sizeof_hdr != static_cast<int>(sizeof(nifti_1_header)))
      throw input_error({file_, "header", "has voxels of one bit, not in NIfTI-1", "NIfTI-1, or bytes", ""});
    header->datatype = DT_UINT8;
    header->bitpix = 8;
    return nifti_convert_n1hdr2nim(*header, file_.c_str());
  }

  /// What stands behind the voxels: all would be moved where they begin elsewhere than the header says.
  void note_rest(const NiftiClaims& claims) {
    if (claims.packed || std::string_view(image_->iname).ends_with(".gz")) return;
    const std::uint64_t end = nifti_voxel_bytes(claims).value_or(0) + claims.offset;
    const std::uint64_t there = read_head(image_->iname, 0).file_size;
    if (there > end) place_.notes.push_back(counted(there - end, "byte") + " behind the voxels left unread");
  }

  NiftiPlace place_of(const NiftiClaims& claims, std::optional<bool> left_handed) const {
    constexpr std::int64_t kMostVoxels = std::int64_t{1} << 30;
    for (std::size_t axis = 1; axis < 4; ++axis) {
      if (claims.size[axis] > kMostVoxels)
        throw input_error({file_, "header", "has too many voxels along axis " + std::to_string(axis)});
    }
    for (std::size_t axis = 1; axis < 8; ++axis) {
      if (image_->dim[axis] != claims.size[axis] && static_cast<std::int64_t>(axis) <= image_->dim[0])
        throw input_error({file_, "header", "niftilib reads other sizes than it states"});
    }
    return place_nifti(*image_, claims.qform, left_handed, file_);
  }

  [[nodiscard]] std::optional<VectorFrame> stated_frame() const noexcept {
    return frame_in(std::string_view(image_->descrip, strnlen(image_->descrip, sizeof image_->descrip)));
  }

  /// Name and shape of the values, time steps, and what becomes of slope and intercept.
  void describe_values(FourthAxis fourth_axis, double time_step) {
    const nifti_image& image = *image_;
    stored_ = voxel_of(image.datatype, file_);
    const auto along = [&image](int axis) {
      return image.dim[0] >= axis ? image.dim[axis] : std::int64_t{1};
    };
    if (along(6) > 1 || along(7) > 1)
      throw input_error({file_, "header", "has more than five axes", "space, time and components"});
    // Some writers put the components of a vector where time belongs, and say by the intent that they did.
    const bool fourth = along(5) == 1 && (fourth_axis == FourthAxis::kComponents ||
                                          (is_vector_intent(image.intent_code) && along(4) == 3));
    volumes_ = fourth ? along(4) : along(5);
    steps_ = fourth ? 1 : along(4);
    constexpr std::int64_t kMostComponents = 4096;
    constexpr std::int64_t kMostSteps = 1'000'000;
    if (volumes_ > kMostComponents || steps_ > kMostSteps)
      throw input_error({file_, "header", "has too many values a voxel or time steps"});

    array_.association = Association::kPoint;
    array_.components = stored_.components * static_cast<int>(volumes_);
    array_.tuples = as_size(image.nx) * as_size(image.ny) * as_size(image.nz);
    array_.name = "scalars";
    if (array_.components > 1) array_.name = volumes_ == 3 ? "vectors" : "components";
    if (stored_.components > 1 && volumes_ == 1) array_.name = kColorArray;
    if (const auto frame = stated_frame(); volumes_ == 3 && frame != VectorFrame::kScanner)
      place_.notes.push_back("vectors as stored: " +
                             (frame ? "along " + std::string(words_of(*frame)) + ", as the header says"
                                    : std::string("the header does not say along which axes")));
    array_.type = stored_.type;
    slope_ = image.scl_slope;
    intercept_ = image.scl_inter;
    scaled_ = slope_ != 0.0 && std::isfinite(slope_) && std::isfinite(intercept_) &&
              !(slope_ == 1.0 && intercept_ == 0.0) && stored_.components == 1;
    if (scaled_) {
      const bool small = byte_size(stored_.type) <= 2 || stored_.type == ScalarType::kFloat32;
      array_.type = small ? ScalarType::kFloat32 : ScalarType::kFloat64;
      place_.notes.push_back("values are " + short_number(slope_) + " times the stored ones plus " +
                             short_number(intercept_) + ", as the header says");
    }
    if (steps_ > 1) describe_times(time_step);
  }

  /// @param stated as it stands in the header.
  void describe_times(double stated) {
    const nifti_image& image = *image_;
    const bool known = stated > 0.0 && std::isfinite(stated);
    const double dt = known ? stated : 1.0;
    const double start = std::isfinite(image.toffset) ? image.toffset : 0.0;
    for (std::int64_t t = 0; t < steps_; ++t) times_.push_back(start + dt * static_cast<double>(t));
    const char* const unit = image.time_units == NIFTI_UNITS_MSEC   ? "ms"
                             : image.time_units == NIFTI_UNITS_USEC ? "us"
                             : image.time_units == NIFTI_UNITS_HZ   ? "Hz"
                             : image.time_units == NIFTI_UNITS_PPM  ? "ppm"
                             : image.time_units == NIFTI_UNITS_RADS ? "rad/s"
                                                                    : "";
    if (!known) {
      place_.notes.push_back("WARNING: the header states no time step (pixdim[4] is " + short_number(stated) +
                             "): " + counted(as_size(steps_), "time step") + " counted, one apart");
    } else if (*unit != '\0') {
      place_.notes.push_back(std::string("times in ") + unit + ", as the header says");
    } else if (image.time_units != NIFTI_UNITS_SEC) {
      place_.notes.emplace_back("the header does not say in which unit its times are (xyzt_units)");
    }
  }

  /// The stored numbers of volume `index` (time step + steps * component), in this machine's byte order.
  void read_volume(VoxelFile& file, std::int64_t index, std::span<std::byte> out) const {
    if (bits_) return read_bits(file, index, out);
    const std::uint64_t at =
        static_cast<std::uint64_t>(image_->iname_offset) + static_cast<std::uint64_t>(index) * out.size();
    check_voxel_counts(image_->iname, {.wanted = out.size(), .unpacked = file.read(at, out)});
    const bool same = image_->byteorder == nifti_short_order();
    to_native(out, byte_size(stored_.type), same == (std::endian::native == std::endian::big));
  }

  /// The same of bits, the first voxel in the highest one as MRtrix has them: zeros and ones.
  void read_bits(VoxelFile& file, std::int64_t index, std::span<std::byte> out) const {
    const std::uint64_t first = static_cast<std::uint64_t>(index) * out.size();
    std::vector<std::byte> packed((first % 8 + out.size() + 7) / 8);
    const std::uint64_t at = static_cast<std::uint64_t>(image_->iname_offset) + first / 8;
    check_voxel_counts(image_->iname, {.wanted = packed.size(), .unpacked = file.read(at, packed)});
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::uint64_t bit = first % 8 + i;
      out[i] = (packed[bit / 8] >> (7 - bit % 8)) & std::byte{1};
    }
  }

  DataArray values(std::int64_t step, const std::function<void(double)>& on_progress) const {
    (void)check_nifti(file_);
    const std::size_t bytes = array_.tuples * byte_size(stored_.type) * as_size(stored_.components);
    VoxelMemory stored(bytes * as_size(volumes_));
    VoxelFile file(*image_);
    std::vector<std::byte> volume(volumes_ > 1 ? bytes : 0);
    for (std::int64_t v = 0; v < volumes_; ++v) {
      if (volumes_ == 1) {
        read_volume(file, step, stored.bytes());
      } else {
        read_volume(file, step + steps_ * v, volume);
        interleave(volume, as_size(v), stored.bytes());
      }
      if (on_progress) on_progress(static_cast<double>(v + 1) / static_cast<double>(volumes_));
    }
    if (step + 1 == steps_ && !file.ends_well())
      throw input_error(
          {image_->iname, "", "holds gzip data that are damaged or cut off", "a whole file", ""});
    DataArray array = std::move(stored).finish(image_->iname, stored_.type, array_.components);
    array.name = array_.name;
    if (!scaled_) return array;
    return array_.type == ScalarType::kFloat32 ? scaled<float>(array) : scaled<double>(array);
  }

  /// Puts component `v` of every voxel where tuples want it.
  void interleave(std::span<const std::byte> volume, std::size_t v, std::span<std::byte> out) const {
    const std::size_t size = volume.size() / array_.tuples;
    const std::size_t stride = size * as_size(volumes_);
    for (std::size_t p = 0; p < array_.tuples; ++p)
      std::memcpy(out.data() + p * stride + v * size, volume.data() + p * size, size);
  }

  template <typename T>
  DataArray scaled(const DataArray& stored) const {
    const auto values = std::make_shared<std::vector<T>>(stored.tuples * as_size(stored.components));
    std::size_t i = 0;
    for (std::size_t p = 0; p < stored.tuples; ++p) {
      for (int c = 0; c < stored.components; ++c)
        (*values)[i++] = static_cast<T>(slope_ * stored.at(p, c) + intercept_);
    }
    DataArray array = stored;
    array.type = array_.type;
    array.bytes = std::as_bytes(std::span(std::as_const(*values)));
    array.owner = values;
    return array;
  }

  std::string file_;
  ImagePtr image_{nullptr, nifti_image_free};
  NiftiPlace place_;
  std::vector<double> times_;
  ArrayInfo array_;
  Voxel stored_;
  std::int64_t volumes_ = 1;  ///< of a time step: one a component
  std::int64_t steps_ = 1;
  double slope_ = 1.0;
  double intercept_ = 0.0;
  bool scaled_ = false;
  bool bits_ = false;  ///< eight voxels a byte
};

NiftiFile::NiftiFile(const std::string& file, FourthAxis fourth_axis, std::optional<bool> left_handed)
    : image_(std::make_unique<Image>(file, fourth_axis, left_handed)) {}
NiftiFile::NiftiFile(NiftiFile&&) noexcept = default;
NiftiFile& NiftiFile::operator=(NiftiFile&&) noexcept = default;
NiftiFile::~NiftiFile() = default;

const UniformTopology& NiftiFile::topology() const noexcept { return image_->place_.topology; }
bool NiftiFile::anatomical() const noexcept { return image_->place_.anatomical; }
const std::vector<std::string>& NiftiFile::notes() const noexcept { return image_->place_.notes; }
const std::vector<double>& NiftiFile::times() const noexcept { return image_->times_; }
const ArrayInfo& NiftiFile::array() const noexcept { return image_->array_; }
void NiftiFile::rename(const std::string& array) { image_->array_.name = array; }
bool NiftiFile::symmetric_matrix() const noexcept {
  return image_->image_->intent_code == NIFTI_INTENT_SYMMATRIX;
}
std::optional<VectorFrame> NiftiFile::stated_frame() const noexcept { return image_->stated_frame(); }

DataArray NiftiFile::values(std::size_t step, const std::function<void(double)>& on_progress) const {
  return image_->values(static_cast<std::int64_t>(step), on_progress);
}

}  // namespace palpate
