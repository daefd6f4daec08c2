#include "loaders/hdf/hdf5_group.h"

#include <algorithm>
#include <utility>

#include <hdf5.h>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

std::shared_ptr<const std::int64_t> keep(hid_t id, herr_t (*close)(hid_t)) {
  return {new std::int64_t(id), [close](const std::int64_t* held) {
            close(*held);
            delete held;
          }};
}

/// Closes what it is given at the end of a block.
class Closed {
 public:
  Closed(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Closed() {
    if (id_ >= 0) close_(id_);
  }
  Closed(const Closed&) = delete;
  Closed& operator=(const Closed&) = delete;
  operator hid_t() const noexcept { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

std::optional<ScalarType> scalar_type(hid_t set) {
  const Closed type(H5Dget_type(set), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  if (kind == H5T_FLOAT) {
    if (size <= 4) return ScalarType::kFloat32;
    return size <= 8 ? std::optional(ScalarType::kFloat64) : std::nullopt;
  }
  if (kind != H5T_INTEGER) return std::nullopt;
  const bool minus = H5Tget_sign(type) == H5T_SGN_2;
  if (size <= 1) return minus ? ScalarType::kInt8 : ScalarType::kUint8;
  if (size <= 2) return minus ? ScalarType::kInt16 : ScalarType::kUint16;
  if (size <= 4) return minus ? ScalarType::kInt32 : ScalarType::kUint32;
  if (size <= 8) return minus ? ScalarType::kInt64 : ScalarType::kUint64;
  return std::nullopt;
}

hid_t native(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
      return H5T_NATIVE_INT8;
    case ScalarType::kUint8:
      return H5T_NATIVE_UINT8;
    case ScalarType::kInt16:
      return H5T_NATIVE_INT16;
    case ScalarType::kUint16:
      return H5T_NATIVE_UINT16;
    case ScalarType::kInt32:
      return H5T_NATIVE_INT32;
    case ScalarType::kUint32:
      return H5T_NATIVE_UINT32;
    case ScalarType::kInt64:
      return H5T_NATIVE_INT64;
    case ScalarType::kUint64:
      return H5T_NATIVE_UINT64;
    case ScalarType::kFloat32:
      return H5T_NATIVE_FLOAT;
    case ScalarType::kFloat64:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

std::size_t product(const std::vector<std::size_t>& counts, std::size_t from) {
  std::size_t all = 1;
  for (std::size_t i = from; i < counts.size(); ++i) all *= counts[i];
  return all;
}

}  // namespace

Hdf5Array::Hdf5Array(std::shared_ptr<const std::int64_t> set, std::string file, std::string label)
    : set_(std::move(set)), file_(std::move(file)), label_(std::move(label)), type_(scalar_type(*set_)) {
  const Closed space(H5Dget_space(*set_), H5Sclose);
  std::vector<hsize_t> counts(as_size(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (!counts.empty()) H5Sget_simple_extent_dims(space, counts.data(), nullptr);
  counts_.assign(counts.begin(), counts.end());
  if (counts_.empty()) counts_.push_back(1);  // one number
}

std::size_t Hdf5Array::bytes_of(std::size_t rows) const noexcept {
  return rows * product(counts_, 1) * byte_size(*type_);
}

void Hdf5Array::read_as(std::int64_t memory_type, std::size_t first, std::size_t rows, void* to) const {
  if (first > counts_[0] || rows > counts_[0] - first) {
    throw input_error({file_, label_, "has " + std::to_string(counts_[0]) + " rows",
                       std::to_string(rows) + " from " + std::to_string(first) + " on",
                       "the file may be damaged"});
  }
  if (rows == 0 || product(counts_, 1) == 0) return;
  const Closed space(H5Dget_space(*set_), H5Sclose);
  herr_t result = 0;
  if (H5Sget_simple_extent_ndims(space) == 0) {
    result = H5Dread(*set_, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
  } else {
    std::vector<hsize_t> start(counts_.size(), 0), counts(counts_.begin(), counts_.end());
    start[0] = first;
    counts[0] = rows;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, counts.data(), nullptr);
    const Closed memory(H5Screate_simple(static_cast<int>(counts.size()), counts.data(), nullptr), H5Sclose);
    result = H5Dread(*set_, memory_type, memory, space, H5P_DEFAULT, to);
  }
  if (result < 0) throw input_error({file_, label_, "cannot be read", "", "the file may be damaged"});
}

void Hdf5Array::read(std::size_t first, std::size_t rows, void* to) const {
  read_as(native(*type_), first, rows, to);
}

void Hdf5Array::read_whole(std::size_t first, std::size_t rows, std::int64_t* to) const {
  read_as(H5T_NATIVE_INT64, first, rows, to);
}

std::vector<std::int64_t> Hdf5Array::whole() const {
  std::vector<std::int64_t> out(product(counts_, 0));
  read_as(H5T_NATIVE_INT64, 0, counts_[0], out.data());
  if (std::any_of(out.begin(), out.end(), [](std::int64_t n) { return n < 0; }))
    throw input_error({file_, label_, "has a negative number", "counts", "the file may be damaged"});
  return out;
}

std::vector<double> Hdf5Array::real() const {
  std::vector<double> out(product(counts_, 0));
  read_as(H5T_NATIVE_DOUBLE, 0, counts_[0], out.data());
  return out;
}

Hdf5Group::Hdf5Group(std::shared_ptr<const std::int64_t> group, std::string file, std::string path)
    : group_(std::move(group)), file_(std::move(file)), path_(std::move(path)) {}

std::optional<Hdf5Group> Hdf5Group::open(const std::string& file, const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (opened < 0) throw input_error({file, "", "cannot be opened as HDF5", "", "it may be truncated"});
  // The file stays open as long as a group of it is.
  const Hdf5Group root(keep(opened, H5Fclose), file, "");
  return root.group(path);
}

std::optional<Hdf5Group> Hdf5Group::group(const std::string& name) const {
  if (H5Lexists(*group_, name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
  const hid_t opened = H5Gopen2(*group_, name.c_str(), H5P_DEFAULT);
  if (opened < 0) return std::nullopt;
  std::string path = path_;
  path += (path.empty() ? "" : "/") + name;
  return Hdf5Group(keep(opened, H5Gclose), file_, path);
}

std::optional<Hdf5Array> Hdf5Group::array(const std::string& name) const {
  if (H5Lexists(*group_, name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
  const hid_t opened = H5Dopen2(*group_, name.c_str(), H5P_DEFAULT);
  if (opened < 0) return std::nullopt;
  return Hdf5Array(keep(opened, H5Dclose), file_, "data set '" + path_ + "/" + name + "'");
}

Hdf5Array Hdf5Group::need(const std::string& name) const {
  const std::string place = "data set '" + path_ + "/" + name + "'";
  const auto found = array(name);
  if (!found) throw input_error({file_, place, "is missing", "", "the file may be damaged"});
  if (!found->type()) throw input_error({file_, place, "does not hold numbers"});
  return *found;
}

std::vector<std::string> Hdf5Group::names() const {
  std::vector<std::string> out;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  if (H5Literate(*group_, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, add, &out) < 0) {
    out.clear();
    H5Literate(*group_, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &out);
  }
  return out;
}

std::int64_t Hdf5Group::attribute(const std::string& name) const {
  if (H5Aexists(*group_, name.c_str()) <= 0) return -1;
  return H5Aopen(*group_, name.c_str(), H5P_DEFAULT);
}

std::vector<double> Hdf5Group::numbers(const std::string& name) const {
  const Closed opened(attribute(name), H5Aclose);
  if (opened < 0) return {};
  const Closed space(H5Aget_space(opened), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  constexpr hssize_t kMost = 1000;  // an attribute is short
  if (count <= 0 || count > kMost) return {};
  std::vector<double> out(as_size(count));
  if (H5Aread(opened, H5T_NATIVE_DOUBLE, out.data()) < 0) return {};
  return out;
}

std::string Hdf5Group::word(const std::string& name) const {
  const Closed opened(attribute(name), H5Aclose);
  if (opened < 0) return {};
  const Closed type(H5Aget_type(opened), H5Tclose), space(H5Aget_space(opened), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return {};
  std::string out;
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    if (H5Aread(opened, type, &text) >= 0 && text != nullptr) out = text;
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, &text);
  } else {
    out.resize(H5Tget_size(type));
    if (H5Aread(opened, type, out.data()) < 0) return {};
    out.resize(std::min(out.size(), out.find('\0')));
    while (!out.empty() && out.back() == ' ') out.pop_back();
  }
  return out;
}

}  // namespace palpate
