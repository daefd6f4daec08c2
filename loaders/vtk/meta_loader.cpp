#include "loaders/vtk/meta_loader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <vtkmetaio/metaImage.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/volume_block.h"
#include "loaders/vtk/meta_check.h"

namespace palpate {
namespace {

using vtkmetaio::MetaImage;

ScalarType scalar_type(vtkmetaio::MET_ValueEnumType type, const std::string& file) {
  switch (type) {
    case vtkmetaio::MET_CHAR:
      return ScalarType::kInt8;
    case vtkmetaio::MET_UCHAR:
      return ScalarType::kUint8;
    case vtkmetaio::MET_SHORT:
      return ScalarType::kInt16;
    case vtkmetaio::MET_USHORT:
      return ScalarType::kUint16;
    case vtkmetaio::MET_INT:
      return ScalarType::kInt32;
    case vtkmetaio::MET_UINT:
      return ScalarType::kUint32;
    case vtkmetaio::MET_LONG_LONG:
      return ScalarType::kInt64;
    case vtkmetaio::MET_ULONG_LONG:
      return ScalarType::kUint64;
    case vtkmetaio::MET_FLOAT:
      return ScalarType::kFloat32;
    case vtkmetaio::MET_DOUBLE:
      return ScalarType::kFloat64;
    default:
      throw input_error({file, "header", "has values of a type that is not read", "numbers"});
  }
}

class MetaLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second MetaImage", "one file"});
    file_ = request.files.front().string();
    check_meta(file_);
    MetaImage image;
    if (!image.Read(file_.c_str(), false)) refuse();

    big_endian_ = image.BinaryDataByteOrderMSB();
    FileInfo info;
    place(image, info);
    array_.name = "scalars";
    array_.association = Association::kPoint;
    array_.type = scalar_type(image.ElementType(), file_);
    array_.components = image.ElementNumberOfChannels();
    if (array_.components > 1) array_.name = array_.components == 3 ? "vectors" : "components";
    array_.tuples = 1;
    for (int axis = 0; axis < 3; ++axis) array_.tuples *= static_cast<std::size_t>(topology_.points[axis]);
    if (array_.components == 3)
      info.notes.emplace_back("vectors as stored: the header does not say along which axes");
    info.blocks.push_back(describe_image(topology_, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    return read_image(topology_, array_.name, names, [this] { return values(); });
  }

 private:
  [[noreturn]] void refuse() const {
    throw input_error({file_, "", "MetaIO cannot read it", "", "the file may be damaged"});
  }

  void place(const MetaImage& image, FileInfo& info) {
    const int axes = std::min(3, image.NDims());
    topology_ = {};
    topology_.points = Index3{1};
    for (int axis = 0; axis < axes; ++axis) {
      topology_.points[axis] = image.DimSize(axis);
      topology_.origin[axis] = image.Offset(axis);
      Vec3 direction{0.0};
      for (int row = 0; row < axes; ++row) direction[row] = image.TransformMatrix(axis, row);
      topology_.axes[axis] = image.ElementSpacing(axis) * direction;
    }
    const double steps =
        glm::length(topology_.axes[0]) * glm::length(topology_.axes[1]) * glm::length(topology_.axes[2]);
    constexpr double kFlat = 1e-9;
    if (!(std::abs(glm::determinant(topology_.axes)) > kFlat * steps) || !std::isfinite(steps) ||
        !is_finite(topology_.origin)) {
      throw input_error({file_, "header", "its axes span no volume", "three independent, finite directions"});
    }
    const std::string_view orientation = image.AnatomicalOrientationAcronym();
    info.anatomical = !orientation.empty() && orientation.find('?') == std::string_view::npos;
    if (info.anatomical) {
      const Vec3 ras_from_lps{-1.0, -1.0, 1.0};
      topology_.origin *= ras_from_lps;
      for (int axis = 0; axis < 3; ++axis) topology_.axes[axis] *= ras_from_lps;
      info.notes.emplace_back(
          "MetaImage for a patient: taken for LPS, as ITK writes it, and turned into RAS");
    } else {
      info.notes.emplace_back("no AnatomicalOrientation: coordinates as they are, no orientation known");
    }
    if (const std::string units = image.DistanceUnitsName(); !units.empty() && units != "?")
      info.units = "coordinates in " + units;
    if (image.ElementToIntensityFunctionSlope() != 1.0 || image.ElementToIntensityFunctionOffset() != 0.0)
      info.notes.emplace_back("values as stored: the header's intensity function is not applied");
  }

  DataArray values() const {
    check_meta(file_);
    check_meta_stream(file_);
    if (auto pieces = read_meta_pieces(file_); !pieces.empty()) return joined(std::move(pieces));
    const auto image = std::make_shared<MetaImage>();
    if (!image->Read(file_.c_str(), true) || image->ElementData() == nullptr) refuse();
    (void)image->ElementByteOrderFix();
    const bool same = scalar_type(image->ElementType(), file_) == array_.type &&
                      image->ElementNumberOfChannels() == array_.components &&
                      image->Quantity() == static_cast<std::streamoff>(array_.tuples);
    if (!same) throw input_error({file_, "", "has changed since it was opened", "", "open it again"});
    DataArray array;
    array.components = array_.components;
    array.type = array_.type;
    array.tuples = array_.tuples;
    array.bytes = {static_cast<const std::byte*>(image->ElementData()),
                   array.tuples * static_cast<std::size_t>(array.components) * byte_size(array.type)};
    array.owner = image;
    return array;
  }

  // Voxels of several files, which stand in the byte order of the header.
  DataArray joined(std::vector<std::byte> bytes) const {
    const std::size_t size = byte_size(array_.type);
    if (bytes.size() != array_.tuples * static_cast<std::size_t>(array_.components) * size)
      throw input_error({file_, "", "has changed since it was opened", "", "open it again"});
    if (big_endian_ != (std::endian::native == std::endian::big)) {
      for (auto at = bytes.begin(); at != bytes.end(); at += static_cast<std::ptrdiff_t>(size))
        std::reverse(at, at + static_cast<std::ptrdiff_t>(size));
    }
    const auto owner = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    DataArray array;
    array.components = array_.components;
    array.type = array_.type;
    array.tuples = array_.tuples;
    array.bytes = *owner;
    array.owner = owner;
    return array;
  }

  std::string file_;
  bool big_endian_ = false;
  UniformTopology topology_;
  ArrayInfo array_;
};

}  // namespace

std::unique_ptr<Loader> make_meta_loader() { return std::make_unique<MetaLoader>(); }

}  // namespace palpate
