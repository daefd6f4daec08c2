/// Names and colours of labels: whole numbers that name parts of an image. 0 is what belongs to no part.
#pragma once

#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct Label {
  double value = 0.0;
  std::string name;   ///< "label 7" where nobody gave one
  Vec3f color{0.0F};  ///< sRGB, components in [0, 1]

  bool operator==(const Label&) const = default;
};

/// By rising value, each once.
class LabelTable {
 public:
  LabelTable() = default;
  /// Of labels of one value the last counts.
  explicit LabelTable(std::vector<Label> labels);

  [[nodiscard]] const std::vector<Label>& labels() const noexcept { return labels_; }
  /// Null where there is none of that value.
  [[nodiscard]] const Label* find(double value) const noexcept;
  /// The label of that value, with a name and a colour of its own where the table has none.
  [[nodiscard]] Label at(double value) const;

  bool operator==(const LabelTable&) const = default;

 private:
  std::vector<Label> labels_;
};

/// Reads a table of labels, a row each, '#' before comments, colours from 0 to 255:
///
///   7 liver 200 90 60 255             3D Slicer's and FreeSurfer's colour tables (.ctbl, LUT.txt)
///   7 200 90 60 1 1 1 "liver"         ITK-SNAP's label descriptions
///   7,liver or 7,liver,200,90,60      comma-separated; a first row of words is passed over
///
/// @throws Error (bad input) naming the row that is none.
[[nodiscard]] LabelTable read_label_table(const std::string& file);

}  // namespace palpate
