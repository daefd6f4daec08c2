/// Groups, attributes and arrays of an HDF5 file that is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// A data set of numbers. Rows are counted along its first axis.
class Hdf5Array {
 public:
  /// @param data set, open, closed with the last copy. @param label "data set 'VTKHDF/Points'", for messages.
  Hdf5Array(std::shared_ptr<const std::int64_t> set, std::string file, std::string label);

  [[nodiscard]] const std::vector<std::size_t>& counts() const noexcept { return counts_; }
  /// None where it does not hold numbers. What is stored in another width than the types have comes in the next wider.
  [[nodiscard]] std::optional<ScalarType> type() const noexcept { return type_; }
  /// Of `rows` rows. @pre type().
  [[nodiscard]] std::size_t bytes_of(std::size_t rows) const noexcept;

  /// Writes bytes_of(rows) bytes to `to`, numbers of type() in native byte order.
  /// @pre type(). @throws Error (bad input) where it has not so many rows, or they cannot be read.
  void read(std::size_t first, std::size_t rows, void* to) const;
  /// Whole numbers, all of them. @throws Error (bad input), also for negative ones.
  [[nodiscard]] std::vector<std::int64_t> whole() const;
  /// `rows` whole numbers from `first` on, of an array of one axis, as they are.
  void read_whole(std::size_t first, std::size_t rows, std::int64_t* to) const;
  /// All numbers. @throws Error (bad input).
  [[nodiscard]] std::vector<double> real() const;

  [[nodiscard]] const std::string& label() const noexcept { return label_; }

 private:
  void read_as(std::int64_t memory_type, std::size_t first, std::size_t rows, void* to) const;

  std::shared_ptr<const std::int64_t> set_;
  std::string file_, label_;
  std::vector<std::size_t> counts_;
  std::optional<ScalarType> type_;
};

class Hdf5Group {
 public:
  /// None where the file has no such group. @param path "VTKHDF".
  /// @throws Error (bad input) where the file cannot be opened.
  [[nodiscard]] static std::optional<Hdf5Group> open(const std::string& file, const std::string& path);

  [[nodiscard]] std::optional<Hdf5Group> group(const std::string& name) const;
  [[nodiscard]] std::optional<Hdf5Array> array(const std::string& name) const;
  /// @throws Error (bad input) where there is none, or it does not hold numbers.
  [[nodiscard]] Hdf5Array need(const std::string& name) const;
  /// Of groups and arrays in it, in the order in which they were made, where the file has that, else by name.
  [[nodiscard]] std::vector<std::string> names() const;

  /// An attribute of numbers; none where there is no such.
  [[nodiscard]] std::vector<double> numbers(const std::string& attribute) const;
  /// An attribute of text, or empty.
  [[nodiscard]] std::string word(const std::string& attribute) const;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  Hdf5Group(std::shared_ptr<const std::int64_t> group, std::string file, std::string path);
  /// The identifier of an attribute, to be closed; negative: none.
  [[nodiscard]] std::int64_t attribute(const std::string& name) const;

  std::shared_ptr<const std::int64_t> group_;
  std::string file_, path_;
};

}  // namespace palpate
