/// What a VTKHDF file holds at a time step, as VTK's data sets. Sizes and places as "VTKHDF File Format" of VTK's
/// documentation states them, versions 1.0 to 2.5.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include "loaders/hdf/hdf5_group.h"

namespace palpate {

/// Whether the values of an array are wanted; those of ghost marks always are.
using ArrayChoice = std::function<bool(const std::string& name)>;

struct HdfBlock {
  vtkSmartPointer<vtkDataSet> data;
  std::string name;  ///< may be empty
  int level = -1;    ///< of refinement, 0 the coarsest; negative: of none
};

/// One data set of the file: a group with the attribute Type.
class HdfDataSet {
 public:
  /// @throws Error (bad input) where its time steps make no sense.
  HdfDataSet(std::string file, Hdf5Group group, std::string name);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::string& type() const noexcept { return type_; }
  /// Whether it is of a kind that blocks() reads: images, meshes, levels of images.
  [[nodiscard]] bool is_read() const noexcept;
  /// Empty where it has one state.
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }

  /// Its partitions and levels at a time step, which is not looked at where it has one state.
  /// @param notes gets what was left out, unless null. @throws Error (bad input). @pre is_read().
  [[nodiscard]] std::vector<HdfBlock> blocks(std::size_t step, const ArrayChoice& wanted,
                                             std::vector<std::string>* notes) const;

 private:
  [[nodiscard]] HdfBlock image(std::size_t step, const ArrayChoice& wanted,
                               std::vector<std::string>* notes) const;
  [[nodiscard]] std::vector<HdfBlock> meshes(std::size_t step, const ArrayChoice& wanted,
                                             std::vector<std::string>* notes) const;
  [[nodiscard]] std::vector<HdfBlock> levels(std::size_t step, const ArrayChoice& wanted,
                                             std::vector<std::string>* notes) const;
  /// The number for `step` in an array of the group of steps. @throws Error (bad input) where it is missing.
  [[nodiscard]] std::size_t at_step(const std::string& array, std::size_t step) const;
  /// Likewise; none where there is no such array.
  [[nodiscard]] std::optional<std::size_t> find_at_step(const std::string& array, std::size_t step) const;
  /// The first partition at `step`, and their number.
  [[nodiscard]] std::pair<std::size_t, std::size_t> parts(std::size_t step, std::size_t stored) const;
  /// `rows` rows of an array, tuples of all that its other axes hold; null where it does not hold numbers.
  [[nodiscard]] vtkSmartPointer<vtkDataArray> values(const Hdf5Array& array, const std::string& name,
                                                     std::size_t first, std::size_t rows) const;

  struct Rows;
  /// The arrays of points and cells of a mesh or a box of a level.
  void add_arrays(const Hdf5Group& of, const Rows& rows, const ArrayChoice& wanted, vtkDataSet* to,
                  std::vector<std::string>* notes) const;

  std::string file_, name_, type_;
  Hdf5Group group_;
  std::optional<Hdf5Group> steps_;
  std::vector<double> times_;
};

}  // namespace palpate
