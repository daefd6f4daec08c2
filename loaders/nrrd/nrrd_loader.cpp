#include "loaders/nrrd/nrrd_loader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include <teem/nrrd.h>

#include "common/base/error.h"
#include "common/load/volume_block.h"
#include "loaders/nrrd/nrrd_check.h"
#include "loaders/nrrd/nrrd_gradients.h"
#include "loaders/nrrd/nrrd_tuples.h"

namespace palpate {
namespace {

constexpr const char* kUnturned = "values are left in the measurement frame of the file";

using NrrdPtr = std::unique_ptr<Nrrd, Nrrd* (*)(Nrrd*)>;

/// Teem's error, several lines of "[nrrd] function: what", as its innermost one.
std::string teem_error() {
  char* text = biffGetDone(NRRD);
  std::string line = text != nullptr ? text : "unknown error";
  std::free(text);
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
  line = line.substr(line.rfind('\n') + 1);
  if (const std::size_t colon = line.find(": "); colon != std::string::npos) line.erase(0, colon + 2);
  return line.substr(0, 200);
}

NrrdPtr load_nrrd(const std::string& file, bool header_only) {
  NrrdPtr nrrd(nrrdNew(), nrrdNuke);
  NrrdIoState* io = nrrdIoStateNew();
  io->skipData = header_only ? AIR_TRUE : AIR_FALSE;
  const int failed = nrrdLoad(nrrd.get(), file.c_str(), io);
  nrrdIoStateNix(io);
  if (failed != 0) throw input_error({file, "", "Teem says: " + teem_error(), "", "the file may be damaged"});
  return nrrd;
}

ScalarType scalar_type(int type, const std::string& file) {
  switch (type) {
    case nrrdTypeChar:
      return ScalarType::kInt8;
    case nrrdTypeUChar:
      return ScalarType::kUint8;
    case nrrdTypeShort:
      return ScalarType::kInt16;
    case nrrdTypeUShort:
      return ScalarType::kUint16;
    case nrrdTypeInt:
      return ScalarType::kInt32;
    case nrrdTypeUInt:
      return ScalarType::kUint32;
    case nrrdTypeLLong:
      return ScalarType::kInt64;
    case nrrdTypeULLong:
      return ScalarType::kUint64;
    case nrrdTypeFloat:
      return ScalarType::kFloat32;
    case nrrdTypeDouble:
      return ScalarType::kFloat64;
    default:
      throw input_error({file, "", "has opaque blocks as values", "numbers"});
  }
}

/// Turns the header's medical space into RAS: which axes change sign. Nothing where the space is not medical.
std::optional<Vec3> ras_signs(int space) {
  switch (space) {
    case nrrdSpaceRightAnteriorSuperior:
    case nrrdSpaceRightAnteriorSuperiorTime:
      return Vec3{1.0, 1.0, 1.0};
    case nrrdSpaceLeftAnteriorSuperior:
    case nrrdSpaceLeftAnteriorSuperiorTime:
      return Vec3{-1.0, 1.0, 1.0};
    case nrrdSpaceLeftPosteriorSuperior:
    case nrrdSpaceLeftPosteriorSuperiorTime:
    case nrrdSpaceScannerXYZ:
    case nrrdSpaceScannerXYZTime:
      return Vec3{-1.0, -1.0, 1.0};
    default:
      return std::nullopt;
  }
}

/// How the axes are used: one for the components, or none, and three for space.
struct Axes {
  std::optional<unsigned> components;
  std::array<unsigned, 3> space{};
};

Axes sort_axes(const Nrrd& nrrd, const std::string& file) {
  const auto has_direction = [&nrrd](unsigned axis) {
    return !std::isnan(nrrd.axis[axis].spaceDirection[0]);
  };
  std::vector<unsigned> spatial;
  for (unsigned axis = 0; axis < nrrd.dim; ++axis) {
    const int kind = nrrd.axis[axis].kind;
    const bool by_kind = kind == nrrdKindSpace || kind == nrrdKindDomain || kind == nrrdKindUnknown;
    if (nrrd.spaceDim > 0 ? has_direction(axis) : by_kind) spatial.push_back(axis);
  }
  // Without any word on it, the first of four axes is taken for the components, as NRRD files have it.
  if (nrrd.dim == 4 && spatial.size() == 4) spatial.erase(spatial.begin());
  Axes axes;
  if (spatial.size() != 3 || nrrd.dim > 4 || nrrd.dim < 3) {
    throw input_error(
        {file, "",
         "has " + std::to_string(nrrd.dim) + " axes, " + std::to_string(spatial.size()) + " of them spatial",
         "three spatial axes, and one more at most for components"});
  }
  std::copy(spatial.begin(), spatial.end(), axes.space.begin());
  for (unsigned axis = 0; axis < nrrd.dim; ++axis) {
    if (std::find(spatial.begin(), spatial.end(), axis) == spatial.end()) axes.components = axis;
  }
  for (const unsigned axis : axes.space) {
    if (nrrd.axis[axis].size > (std::size_t{1} << 30))
      throw input_error({file, "", "has too many samples along axis " + std::to_string(axis)});
  }
  return axes;
}

/// "coordinates in mm, values in m/s": what the header states of them.
std::string units_of(const Nrrd& nrrd, const Axes& axes) {
  const auto text = [](const char* units) { return std::string(units != nullptr ? units : ""); };
  std::array<std::string, 3> lengths;
  for (std::size_t i = 0; i < 3; ++i)
    lengths[i] = nrrd.spaceDim >= 3 ? text(nrrd.spaceUnits[i]) : text(nrrd.axis[axes.space[i]].units);
  std::string units;
  if (lengths[0] == lengths[1] && lengths[1] == lengths[2]) {
    if (!lengths[0].empty()) units = "coordinates in " + lengths[0];
  } else {
    units = "coordinates in";
    for (const std::string& length : lengths) units += " " + (length.empty() ? "?" : length);
  }
  if (const std::string values = text(nrrd.sampleUnits); !values.empty())
    units += (units.empty() ? "values in " : ", values in ") + values;
  return units;
}

class NrrdLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second NRRD file", "one file"});
    }
    file_ = request.files.front().string();
    const std::string rest = check_nrrd(file_);
    const NrrdPtr nrrd = load_nrrd(file_, true);
    axes_ = sort_axes(*nrrd, file_);

    FileInfo info;
    info.units = units_of(*nrrd, axes_);
    if (!rest.empty()) info.notes.push_back(rest);
    place(*nrrd, info.notes);
    info.anatomical = anatomical_;
    describe_values(*nrrd, info.notes);
    if (request.diffusion) describe_gradients(*nrrd, info);

    info.blocks.push_back(describe_image(topology_, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    return read_image(topology_, array_.name, names, [this] { return values(); });
  }

 private:
  /// Origin and axes, in RAS where the space is known.
  void place(const Nrrd& nrrd, std::vector<std::string>& notes) {
    const std::optional<Vec3> signs = ras_signs(nrrd.space);
    signs_ = signs.value_or(Vec3{1.0});
    Vec3 origin{0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<int>(i);
      const NrrdAxisInfo& axis = nrrd.axis[axes_.space[i]];
      topology_.points[a] = static_cast<int>(axis.size);
      if (nrrd.spaceDim >= 3) {
        topology_.axes[a] =
            signs_ * Vec3{axis.spaceDirection[0], axis.spaceDirection[1], axis.spaceDirection[2]};
        if (!std::isnan(nrrd.spaceOrigin[0])) origin[a] = nrrd.spaceOrigin[i];
      } else {
        double spacing = 1.0;
        double unused[NRRD_SPACE_DIM_MAX];
        (void)nrrdSpacingCalculate(&nrrd, axes_.space[i], &spacing, unused);
        if (std::isnan(spacing)) spacing = 1.0;
        topology_.axes[a] = Vec3{0.0};
        topology_.axes[a][a] = spacing;
        // The lower end of an axis of cells lies half a cell before its first sample.
        if (!std::isnan(axis.min))
          origin[a] = axis.min + (axis.center == nrrdCenterCell ? 0.5 * spacing : 0.0);
      }
    }
    topology_.origin = signs_ * origin;
    const double volume = std::abs(glm::determinant(topology_.axes));
    if (!(volume > 0.0) || !std::isfinite(volume) || !is_finite(topology_.origin)) {
      throw input_error({file_, "header", "its axes span no volume",
                         "three independent, finite space directions or spacings"});
    }
    anatomical_ = signs.has_value();
    if (signs) {
      notes.emplace_back(std::string("space ") + airEnumStr(nrrdSpace, nrrd.space) +
                         (*signs == Vec3{1.0} ? "" : ", turned into RAS"));
    } else {
      notes.emplace_back("no medical space: coordinates as they are, no orientation known");
    }
  }

  /// Name and shape of the values, and whether they are vectors or tensors to be turned into RAS.
  void describe_values(const Nrrd& nrrd, std::vector<std::string>& notes) {
    array_.association = Association::kPoint;
    stored_type_ = scalar_type(nrrd.type, file_);
    array_.type = stored_type_;
    stored_components_ = array_.components = 1;
    array_.name = "scalars";
    array_.tuples = 1;
    for (const unsigned axis : axes_.space) array_.tuples *= nrrd.axis[axis].size;
    turn_ = Mat3{1.0};
    turned_ = false;
    kind_ = TupleKind::kNumbers;
    if (!axes_.components) return;
    const NrrdAxisInfo& axis = nrrd.axis[*axes_.components];
    constexpr std::size_t kMaxComponents = 4096;
    if (axis.size > kMaxComponents)
      throw input_error({file_, "", "has " + std::to_string(axis.size) + " values a point", "4096 at most"});
    stored_components_ = array_.components = static_cast<int>(axis.size);
    kind_ = tuple_kind(axis.kind, axis.size);
    array_.name = array_name(kind_);
    const bool has_frame = nrrd.spaceDim == 3 && !std::isnan(nrrd.measurementFrame[0][0]);
    if (kind_ == TupleKind::kNumbers) {
      if (has_frame) notes.emplace_back(kUnturned);
      return;
    }
    // Component c of a vector lies along column c of the measurement frame, in the header's space.
    for (int c = 0; c < 3 && has_frame; ++c) {
      for (int r = 0; r < 3; ++r) turn_[c][r] = nrrd.measurementFrame[c][r];
    }
    check_frame(notes);
    for (int c = 0; c < 3; ++c) turn_[c] *= signs_;
    array_.components = turned_size(kind_);
    turned_ = turn_ != Mat3{1.0} || array_.components != stored_components_;
    if (!turned_) return;
    notes.push_back(array_.name + " turned into RAS");
    const bool small = byte_size(stored_type_) <= 2 || stored_type_ == ScalarType::kFloat32;
    array_.type = small ? ScalarType::kFloat32 : ScalarType::kFloat64;
  }

  /// Axes in one plane would flatten what is measured along them.
  void check_frame(std::vector<std::string>& notes) const {
    constexpr double kFlat = 1e-6, kTurned = 1e-3;
    const double sides = glm::length(turn_[0]) * glm::length(turn_[1]) * glm::length(turn_[2]);
    if (!(std::abs(glm::determinant(turn_)) > kFlat * sides))
      throw input_error({file_, "measurement frame", "has axes in one plane", "three independent ones", ""});
    const Mat3 product = glm::transpose(turn_) * turn_;
    double off = 0.0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) off = std::max(off, std::abs(product[c][r] - (c == r ? 1.0 : 0.0)));
    if (off > kTurned)
      notes.emplace_back("the measurement frame is no rotation: lengths and angles change with it");
  }

  /// Diffusion-weighted volumes with their gradients, where the header states them.
  void describe_gradients(const Nrrd& nrrd, FileInfo& info) {
    if (kind_ != TupleKind::kNumbers || !axes_.components) return;
    const NrrdKeys keys = [&nrrd](const std::string& key) -> std::optional<std::string> {
      char* const text = nrrdKeyValueGet(&nrrd, key.c_str());
      if (text == nullptr) return std::nullopt;
      std::string value(text);
      std::free(text);
      return value;
    };
    Mat3 frame{1.0};
    for (int c = 0; c < 3 && nrrd.spaceDim == 3 && !std::isnan(nrrd.measurementFrame[0][0]); ++c) {
      for (int r = 0; r < 3; ++r) frame[c][r] = nrrd.measurementFrame[c][r];
    }
    for (int c = 0; c < 3; ++c) frame[c] *= signs_;
    info.diffusion.gradients =
        read_nrrd_gradients(keys, static_cast<std::size_t>(stored_components_), frame, file_, info.notes);
    if (!info.diffusion.gradients) return;
    array_.name = kSignalArray;
    std::erase(info.notes, kUnturned);  // signals have no directions; their gradients were turned
  }

  DataArray values() const {
    (void)check_nrrd(file_);
    NrrdPtr nrrd = load_nrrd(file_, false);
    if (axes_.components && *axes_.components != 0) {
      // Components first, the others in their order.
      std::array<unsigned, NRRD_DIM_MAX> order{};
      order[0] = *axes_.components;
      std::copy(axes_.space.begin(), axes_.space.end(), order.begin() + 1);
      NrrdPtr permuted(nrrdNew(), nrrdNuke);
      if (nrrdAxesPermute(permuted.get(), nrrd.get(), order.data()) != 0) {
        throw input_error({file_, "", "Teem says: " + teem_error()});
      }
      nrrd = std::move(permuted);
    }
    const std::size_t count = array_.tuples * static_cast<std::size_t>(stored_components_);
    if (nrrdElementNumber(nrrd.get()) != count || scalar_type(nrrd->type, file_) != stored_type_) {
      throw input_error({file_, "", "has changed since it was opened", "", "open it again"});
    }
    DataArray array;
    array.components = array_.components;
    array.tuples = array_.tuples;
    if (turned_) return turned(*nrrd, std::move(array));
    array.type = array_.type;
    array.bytes = {static_cast<const std::byte*>(nrrd->data), count * byte_size(array_.type)};
    array.owner = std::shared_ptr<Nrrd>(nrrd.release(), nrrdNuke);
    return array;
  }

  /// Vectors and tensors in RAS: stored in single precision where the file is no more precise.
  DataArray turned(const Nrrd& nrrd, DataArray array) const {
    const auto fill = [&]<typename T>(T, ScalarType type) {
      const auto from = static_cast<std::size_t>(stored_components_);
      const auto to = static_cast<std::size_t>(array.components);
      const auto values = std::make_shared<std::vector<T>>(to * array.tuples);
      const auto lookup = nrrdDLookup[nrrd.type];
      std::vector<double> tuple(from), result(to);
      for (std::size_t p = 0; p < array.tuples; ++p) {
        for (std::size_t c = 0; c < from; ++c) tuple[c] = lookup(nrrd.data, from * p + c);
        turn_tuple(kind_, turn_, tuple.data(), result.data());
        for (std::size_t c = 0; c < to; ++c) (*values)[to * p + c] = static_cast<T>(result[c]);
      }
      array.type = type;
      array.bytes = std::as_bytes(std::span(std::as_const(*values)));
      array.owner = values;
      return array;
    };
    return array_.type == ScalarType::kFloat32 ? fill(0.0F, array_.type) : fill(0.0, array_.type);
  }

  std::string file_;
  Axes axes_;
  Vec3 signs_{1.0};
  bool anatomical_ = false;
  Mat3 turn_{1.0};
  bool turned_ = false;
  TupleKind kind_ = TupleKind::kNumbers;
  int stored_components_ = 1;  ///< in the file
  UniformTopology topology_;
  ArrayInfo array_;
  ScalarType stored_type_ = ScalarType::kFloat32;
};

}  // namespace

std::unique_ptr<Loader> make_nrrd_loader() { return std::make_unique<NrrdLoader>(); }

}  // namespace palpate
