#include "loaders/hdf/netcdf_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <netcdf.h>

namespace palpate {
namespace {

struct Numbers {
  std::vector<double> values;
  bool real = false;  ///< with a point, as the attribute is stored
};

/// The numbers of an attribute, a few at most; none where there is no such, or it is text.
Numbers numbers(int file, int variable, const char* name) {
  nc_type type = NC_NAT;
  std::size_t count = 0;
  constexpr std::size_t kMost = 64;
  if (nc_inq_att(file, variable, name, &type, &count) != NC_NOERR || type == NC_CHAR || type == NC_STRING ||
      count > kMost)
    return {};
  Numbers out{std::vector<double>(count), type == NC_FLOAT || type == NC_DOUBLE};
  if (nc_get_att_double(file, variable, name, out.values.data()) != NC_NOERR) return {};
  return out;
}

bool is_unsigned(int file, int variable) {
  constexpr std::size_t kLongest = 16;
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(file, variable, "_Unsigned", &type, &length) != NC_NOERR || type != NC_CHAR ||
      length > kLongest)
    return false;
  std::string text(length, ' ');
  if (nc_get_att_text(file, variable, "_Unsigned", text.data()) != NC_NOERR) return false;
  return text.starts_with("true") || text.starts_with("True") || text.starts_with("TRUE");
}

/// What the library writes where nobody did; NaN: of bytes nothing stands for it.
double never_written(nc_type type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_FLOAT:
      return NC_FILL_FLOAT;
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_UINT:
      return NC_FILL_UINT;
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

/// By which a whole number may be off when it is unpacked.
constexpr double kOfWhole = 0.25;

/// Of a signed type, the count of its numbers; 0 for others.
double size_of(nc_type type) {
  constexpr double kByte = 0x1p8, kShort = 0x1p16, kInt = 0x1p32;
  if (type == NC_BYTE) return kByte;
  if (type == NC_SHORT) return kShort;
  return type == NC_INT ? kInt : 0.0;
}

}  // namespace

NetcdfValues::NetcdfValues(int file, int variable)
    : lowest_(-std::numeric_limits<double>::infinity()), highest_(std::numeric_limits<double>::infinity()) {
  nc_type type = NC_NAT;
  nc_inq_vartype(file, variable, &type);
  if (const auto scale = numbers(file, variable, "scale_factor").values; scale.size() == 1 && scale[0] != 0.0)
    scale_ = scale[0];
  if (const auto offset = numbers(file, variable, "add_offset").values; offset.size() == 1)
    offset_ = offset[0];
  const bool real = type == NC_FLOAT || type == NC_DOUBLE;
  constexpr double kOfSingle = 1e-6, kOfDouble = 1e-12;
  relative_ = type == NC_DOUBLE ? kOfDouble : type == NC_FLOAT ? kOfSingle : 0.0;

  none_ = numbers(file, variable, "_FillValue").values;
  if (none_.empty()) none_.push_back(never_written(type));
  // Of a packed variable what has a point is of the numbers that are meant, not of those that are stored.
  const auto stored = [&](const Numbers& of, double value) {
    return of.real && !real ? unscaled(value) : value;
  };
  const Numbers missing = numbers(file, variable, "missing_value");
  for (const double value : missing.values) {
    none_.push_back(value);
    if (missing.real && !real) none_.push_back(unscaled(value));
  }
  if (real) {
    for (double& value : none_)
      if (type == NC_FLOAT) value = static_cast<double>(static_cast<float>(value));
  }
  std::erase_if(none_, [](double value) { return std::isnan(value); });

  const Numbers low = numbers(file, variable, "valid_min"), high = numbers(file, variable, "valid_max"),
                range = numbers(file, variable, "valid_range");
  if (low.values.size() == 1) lowest_ = stored(low, low.values[0]);
  if (high.values.size() == 1) highest_ = stored(high, high.values[0]);
  if (range.values.size() == 2) {
    lowest_ = stored(range, range.values[0]);
    highest_ = stored(range, range.values[1]);
  }
  if (scale_ < 0.0 && !real && (low.real || high.real || range.real)) std::swap(lowest_, highest_);
  signed_byte_ = type == NC_BYTE && !is_unsigned(file, variable);
  if (is_unsigned(file, variable)) {
    around_ = size_of(type);
    // The marks are those of numbers without a sign, too.
    for (double* const mark : {&lowest_, &highest_})
      if (std::isfinite(*mark) && *mark < 0.0) *mark += around_;
    for (double& mark : none_)
      if (mark < 0.0) mark += around_;
  }
}

bool NetcdfValues::is_none(double stored) const noexcept {
  const auto slack = [&](double mark) { return relative_ > 0.0 ? relative_ * std::abs(mark) : kOfWhole; };
  if (std::isfinite(lowest_) && stored < lowest_ - slack(lowest_)) return true;
  if (std::isfinite(highest_) && stored > highest_ + slack(highest_)) return true;
  return std::any_of(none_.begin(), none_.end(),
                     [&](double mark) { return std::abs(stored - mark) <= slack(mark); });
}

DataArray NetcdfValues::marked(const DataArray& array) const {
  const std::size_t count = array.tuples * static_cast<std::size_t>(array.components);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const auto component = static_cast<int>(i % static_cast<std::size_t>(array.components));
    const double value = array.at(i / static_cast<std::size_t>(array.components), component);
    double stored = unscaled(value), meant = value;
    if (around_ > 0.0 && stored < -0.5) {
      stored += around_;
      meant += scale_ * around_;
    }
    if (constexpr double kBytes = 0x1p8; signed_byte_ && stored >= 0.5 * kBytes - kOfWhole) {
      stored -= kBytes;
      meant -= scale_ * kBytes;
    }
    if (is_none(stored)) meant = std::numeric_limits<double>::quiet_NaN();
    if (values.empty()) {
      if (meant == value || std::isnan(value)) continue;
      // The first that changes.
      values.resize(count);
      for (std::size_t before = 0; before < i; ++before)
        values[before] = array.at(before / static_cast<std::size_t>(array.components),
                                  static_cast<int>(before % static_cast<std::size_t>(array.components)));
    }
    values[i] = meant;
  }
  if (values.empty()) return array;
  if (needs_double(array.type))
    return make_array(array.name, array.association, array.components, std::span<const double>(values));
  const std::vector<float> single(values.begin(), values.end());
  return make_array(array.name, array.association, array.components, std::span<const float>(single));
}

}  // namespace palpate
