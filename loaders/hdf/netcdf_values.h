/// What the attributes of a variable say of its numbers, beyond their scale, which VTK's reader heeds.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// Numbers of one variable that stand for none, and those that were stored without a sign. Limits with a point, of a variable
/// that is packed as whole numbers, are of the numbers that are meant. "NetCDF Users Guide",
/// attribute conventions; CF conventions, 2.5.1 and 8.1.
class NetcdfValues {
 public:
  /// @param file open, as netCDF's library numbers it. @param variable likewise.
  NetcdfValues(int file, int variable);

  /// The array with NaN for what `_FillValue`, `missing_value`, `valid_min`, `valid_max` and `valid_range` leave out, or
  /// what was never written; with 2^8, 2^16 … added to negative numbers of a variable that is `_Unsigned`; and bytes with
  /// their sign, which VTK's reader takes from them. The same array where nothing is to do. @param array as VTK reads the variable.
  [[nodiscard]] DataArray marked(const DataArray& array) const;

 private:
  [[nodiscard]] double unscaled(double value) const noexcept { return (value - offset_) / scale_; }
  [[nodiscard]] bool is_none(double stored) const noexcept;

  double scale_ = 1.0, offset_ = 0.0;
  double relative_ = 0.0;  ///< by which two stored numbers may differ and are the same; 0: whole numbers
  double around_ = 0.0;    ///< what is added to negative ones; 0: nothing
  bool signed_byte_ = false;
  double lowest_, highest_;
  std::vector<double> none_;
};

}  // namespace palpate
