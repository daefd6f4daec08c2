#include "loaders/nrrd/nrrd_loader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include <teem/nrrd.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/load/fsl_gradients.h"
#include "common/load/volume_block.h"
#include "common/load/voxel_bytes.h"
#include "loaders/nrrd/nrrd_axes.h"
#include "loaders/nrrd/nrrd_check.h"
#include "loaders/nrrd/nrrd_gradients.h"
#include "loaders/nrrd/nrrd_tuples.h"

namespace palpate {
namespace {

/// Said of vectors and tensors whose measurement frame is neither the header's space nor its axes mirrored.
constexpr const char* kOwnFrame =
    "the measurement frame is a turn of its own, which is applied first: --vectors, where it is given, names axes "
    "behind it";
constexpr const char* kUnturned = "values are left in the measurement frame of the file";

/// Whether a frame's axes are not those of the space, mirrored or not.
bool is_turn(const Mat3& frame) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (std::abs(frame[c][r]) != (c == r ? 1.0 : 0.0)) return true;
  return false;
}

using NrrdPtr = std::unique_ptr<Nrrd, Nrrd* (*)(Nrrd*)>;
using IoPtr = std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)>;

struct NrrdShape {
  int type = nrrdTypeUnknown;
  std::vector<std::size_t> size;
};

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

void load(Nrrd* nrrd, NrrdIoState* io, const std::string& file) {
  if (nrrdLoad(nrrd, file.c_str(), io) != 0)
    throw input_error({file, "", "Teem says: " + teem_error(), "", "the file may be damaged"});
}

NrrdPtr load_header(const std::string& file) {
  NrrdPtr nrrd(nrrdNew(), nrrdNuke);
  const IoPtr io(nrrdIoStateNew(), nrrdIoStateNix);
  io->skipData = AIR_TRUE;
  load(nrrd.get(), io.get(), file);
  return nrrd;
}

/// All values, read into memory of our own, which Teem is given for `shape`.
NrrdPtr load_values(const std::string& file, const NrrdShape& shape) {
  NrrdPtr nrrd(nrrdNew(), nrrdNuke);
  const IoPtr io(nrrdIoStateNew(), nrrdIoStateNix);
  if (nrrdMaybeAlloc_nva(nrrd.get(), shape.type, static_cast<unsigned>(shape.size.size()),
                         shape.size.data()) != 0) {
    (void)teem_error();
    throw std::bad_alloc();
  }
  const auto bytes = [&nrrd] {
    return std::span(static_cast<std::byte*>(nrrd->data),
                     nrrdElementNumber(nrrd.get()) * nrrdElementSize(nrrd.get()));
  };
  const std::size_t wanted = bytes().size();
  const void* const given = nrrd->data;
  fill_with_pattern(bytes());
  load(nrrd.get(), io.get(), file);
  if (nrrd->data != given || bytes().size() != wanted || nrrd->type != shape.type)
    throw input_error({file, "", "has changed since it was opened", "", "open it again"});
  // What was not read was turned into this machine's byte order with the rest.
  const bool turned =
      io->encoding->endianMatters != 0 && io->endian != airEndianUnknown && io->endian != airMyEndian();
  if (turned) nrrdSwapEndian(nrrd.get());
  check_voxel_counts(file, {.wanted = wanted, .written = written_bytes(bytes())});
  if (turned) nrrdSwapEndian(nrrd.get());
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

/// "coordinates in mm, values in m/s": what is known of them.
std::string units_of(const Nrrd& nrrd, const std::string& length) {
  std::string units = length.empty() ? "" : "coordinates in " + length;
  if (const std::string values = nrrd.sampleUnits != nullptr ? nrrd.sampleUnits : ""; !values.empty())
    units += (units.empty() ? "values in " : ", values in ") + values;
  return units;
}

bool has_frame(const Nrrd& nrrd) { return nrrd.spaceDim == 3 && !std::isnan(nrrd.measurementFrame[0][0]); }

/// Component c of a vector lies along its column c, in the header's space. The identity where there is none.
Mat3 measurement_frame(const Nrrd& nrrd) {
  Mat3 frame{1.0};
  for (int c = 0; c < 3 && has_frame(nrrd); ++c)
    for (int r = 0; r < 3; ++r) frame[c][r] = nrrd.measurementFrame[c][r];
  return frame;
}

/// What as many numbers are where tensors are asked for and their kind does not say.
TupleKind kind_of_list(std::size_t size) {
  switch (size) {
    case 6:
      return TupleKind::kSymmetric;
    case 7:
      return TupleKind::kMaskedSymmetric;
    case 9:
      return TupleKind::kMatrix;
    default:
      return TupleKind::kNumbers;
  }
}

const char* order_text(TupleKind kind) {
  if (kind == TupleKind::kMatrix) return "nine row by row";
  return kind == TupleKind::kSymmetric ? "xx xy xz yy yz zz" : "a mask, xx xy xz yy yz zz";
}

class NrrdLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second NRRD file", "one file"});
    }
    file_ = request.files.front().string();
    const std::string rest = check_nrrd(file_);
    const NrrdPtr nrrd = load_header(file_);
    axes_ = sort_nrrd_axes(*nrrd, request.diffusion.has_value(), file_);
    shape_ = {nrrd->type, {}};
    for (unsigned axis = 0; axis < nrrd->dim; ++axis) shape_.size.push_back(nrrd->axis[axis].size);

    FileInfo info;
    if (!rest.empty()) info.notes.push_back(rest);
    info.notes.insert(info.notes.end(), axes_.notes.begin(), axes_.notes.end());
    NrrdPlace place = place_nrrd(*nrrd, axes_, file_);
    info.units = units_of(*nrrd, place.length_unit);
    topology_ = place.topology;
    signs_ = place.signs;
    info.anatomical = place.anatomical;
    info.notes.insert(info.notes.end(), place.notes.begin(), place.notes.end());
    info.times = nrrd_times(*nrrd, axes_, info.notes);
    const bool named = request.diffusion && request.diffusion->names_gradients();
    describe_values(*nrrd, request.diffusion.has_value() && !named, info);
    if (named) take_named_gradients(*nrrd, *request.diffusion, info);
    if (request.diffusion && !named) describe_gradients(*nrrd, info);

    info.blocks.push_back(describe_image(topology_, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    return read_image(topology_, array_.name, names, [&] { return values(step); });
  }

 private:
  /// Name and shape of the values, and whether they are vectors or tensors to be turned into RAS.
  void describe_values(const Nrrd& nrrd, bool tensors, FileInfo& info) {
    std::vector<std::string>& notes = info.notes;
    array_.association = Association::kPoint;
    stored_type_ = scalar_type(nrrd.type, file_);
    array_.type = stored_type_;
    stored_components_ = array_.components = 1;
    array_.name = "scalars";
    array_.tuples = 1;
    for (const unsigned axis : axes_.space) array_.tuples *= axis == kNoNrrdAxis ? 1 : nrrd.axis[axis].size;
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
    const bool weighted = nrrd_key(nrrd, "DWMRI_b-value") || nrrd_key(nrrd, "DWMRI_gradient_0000");
    if (tensors && kind_ == TupleKind::kNumbers && !weighted) {
      if (axis.size == 6 && leave_open(nrrd, info)) {
        array_.name = array_name(TupleKind::kSymmetric);
        notes.push_back("6 numbers of a kind that says no more (" +
                        std::string(airEnumStr(nrrdKind, axis.kind)) + ") taken for tensors");
        return;
      }
      kind_ = kind_of_list(axis.size);
      if (kind_ != TupleKind::kNumbers)
        notes.push_back(std::to_string(axis.size) + " numbers of a kind that says no more (" +
                        airEnumStr(nrrdKind, axis.kind) + ") taken for tensors: " + order_text(kind_));
    }
    array_.name = array_name(kind_);
    if (axis.kind == nrrdKindRGBColor || axis.kind == nrrdKindRGBAColor) array_.name = kColorArray;
    if (kind_ == TupleKind::kNumbers) {
      if (has_frame(nrrd)) notes.emplace_back(kUnturned);
      return;
    }
    turn_ = measurement_frame(nrrd);
    check_frame(notes);
    if (is_turn(turn_)) notes.emplace_back(kOwnFrame);
    for (int c = 0; c < 3; ++c) turn_[c] *= signs_;
    array_.components = turned_size(kind_);
    turned_ = turn_ != Mat3{1.0} || array_.components != stored_components_;
    if (!turned_) return;
    notes.push_back(array_.name + " turned into RAS");
    const bool small = byte_size(stored_type_) <= 2 || stored_type_ == ScalarType::kFloat32;
    array_.type = small ? ScalarType::kFloat32 : ScalarType::kFloat64;
  }

  /// Whether tensors of an order that nobody states are left as they are stored: along axes that have a name, the values
  /// themselves say which order is right.
  bool leave_open(const Nrrd& nrrd, FileInfo& info) const {
    const bool lps = signs_ == Vec3{-1.0, -1.0, 1.0};
    if (measurement_frame(nrrd) != Mat3{1.0} || !(lps || signs_ == Vec3{1.0})) return false;
    info.diffusion.layout = TensorLayout::kUnstated;
    info.diffusion.frame = lps ? VectorFrame::kLps : VectorFrame::kScanner;
    return true;
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

  /// Volumes with the gradients that are named in place of those of the header.
  void take_named_gradients(const Nrrd& nrrd, const DiffusionRequest& request, FileInfo& info) {
    if (kind_ != TupleKind::kNumbers || !axes_.components) return;
    const auto named =
        named_fsl_gradients(file_, request, as_size(stored_components_), topology_.axes, info.notes);
    info.diffusion.gradients = named->table;
    info.diffusion.gradient_frame = named->frame;
    if (nrrd_key(nrrd, "DWMRI_b-value"))
      info.notes.emplace_back("gradients of the header left aside for them");
    array_.name = kSignalArray;
    std::erase(info.notes, kUnturned);
  }

  /// Diffusion-weighted volumes with their gradients, where the header states them.
  void describe_gradients(const Nrrd& nrrd, FileInfo& info) {
    if (kind_ != TupleKind::kNumbers || !axes_.components) return;
    const NrrdKeys keys = [&nrrd](const std::string& key) { return nrrd_key(nrrd, key); };
    Mat3 frame = measurement_frame(nrrd);
    const bool own_frame = is_turn(frame);
    if (frame == Mat3{1.0} && signs_ == Vec3{-1.0, -1.0, 1.0})
      info.diffusion.gradient_frame = VectorFrame::kLps;
    for (int c = 0; c < 3; ++c) frame[c] *= signs_;
    info.diffusion.gradients =
        read_nrrd_gradients(keys, as_size(stored_components_), frame, file_, info.notes);
    if (!info.diffusion.gradients) return;
    array_.name = kSignalArray;
    if (own_frame) info.notes.emplace_back(kOwnFrame);
    std::erase(info.notes, kUnturned);  // signals have no directions; their gradients were turned
  }

  DataArray values(std::size_t step) {
    if (!values_) read_values();
    DataArray array;
    array.components = array_.components;
    array.tuples = array_.tuples;
    const std::size_t count = array_.tuples * as_size(stored_components_);
    if (turned_) return turned(step * count, std::move(array));
    array.type = array_.type;
    const std::size_t bytes = count * byte_size(array_.type);
    array.bytes = {static_cast<const std::byte*>(values_->data) + step * bytes, bytes};
    array.owner = values_;
    if (!axes_.time) values_.reset();  // of one state nobody asks twice
    return array;
  }

  /// Components first, space in its order, time last.
  void read_values() {
    (void)check_nrrd(file_);
    NrrdPtr nrrd = load_values(file_, shape_);
    std::vector<unsigned> order;
    if (axes_.components) order.push_back(*axes_.components);
    std::ranges::copy_if(axes_.space, std::back_inserter(order),
                         [](unsigned axis) { return axis != kNoNrrdAxis; });
    if (axes_.time) order.push_back(*axes_.time);
    if (!std::is_sorted(order.begin(), order.end())) {
      NrrdPtr permuted(nrrdNew(), nrrdNuke);
      if (nrrdAxesPermute(permuted.get(), nrrd.get(), order.data()) != 0)
        throw input_error({file_, "", "Teem says: " + teem_error()});
      nrrd = std::move(permuted);
    }
    values_ = std::shared_ptr<Nrrd>(nrrd.release(), nrrdNuke);
  }

  /// Vectors and tensors in RAS: stored in single precision where the file is no more precise.
  DataArray turned(std::size_t first, DataArray array) const {
    const auto fill = [&]<typename T>(T, ScalarType type) {
      const auto from = as_size(stored_components_);
      const auto to = as_size(array.components);
      const auto values = std::make_shared<std::vector<T>>(to * array.tuples);
      const auto lookup = nrrdDLookup[values_->type];
      std::vector<double> tuple(from), result(to);
      for (std::size_t p = 0; p < array.tuples; ++p) {
        for (std::size_t c = 0; c < from; ++c) tuple[c] = lookup(values_->data, first + from * p + c);
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
  NrrdAxes axes_;
  NrrdShape shape_;
  Vec3 signs_{1.0};
  Mat3 turn_{1.0};
  bool turned_ = false;
  TupleKind kind_ = TupleKind::kNumbers;
  int stored_components_ = 1;  ///< in the file
  UniformTopology topology_;
  ArrayInfo array_;
  ScalarType stored_type_ = ScalarType::kFloat32;
  std::shared_ptr<Nrrd> values_;  ///< of all steps, once one was asked for
};

}  // namespace

std::unique_ptr<Loader> make_nrrd_loader() { return std::make_unique<NrrdLoader>(); }

}  // namespace palpate
