/// What the header of an image says beside its voxels and their places: images that are made of it say it again.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/transfer/label_table.h"

namespace palpate {

/// The words are NIfTI's (nifti1.h); of NRRD there are the description, labels, pairs, and whether the voxels are packed;
/// of packed MetaImages and VTK's XML that they are.
struct ImageHeader {
  /// How stored numbers become values: slope * number + intercept.
  struct Scaling {
    ScalarType type = ScalarType::kInt16;  ///< as which they are stored, whole numbers
    double slope = 1.0, intercept = 0.0;
  };

  std::string description;  ///< `descrip`; `content` of NRRD
  bool packed = false;      ///< the file is compressed
  /// Where the file says that its numbers are labels, with the names and colours that it has for them: NIfTI's intent
  /// (no names), segments of 3D Slicer's .seg.nrrd.
  std::optional<LabelTable> labels;
  /// Lines "key:=value" of NRRD, but for what they say of its axes, gradients, and parts of them.
  std::vector<std::string> pairs;
  std::string
      value_units;  ///< of NRRD's `sample units`: "HU"; from what its reader knows of any file (origin_of())
  bool nifti = false;  ///< what follows is stated
  int units = 0;       ///< `xyzt_units`: of lengths in the lowest three bits, of times above them
  int sform_code = 0, qform_code = 0;  ///< 0, too, of forms that cannot be used
  /// Where the qform puts what lies at x [RAS+ mm]: turn x + shift.
  Mat3 qform_turn{1.0};
  Vec3 qform_shift{0.0};
  int intent = 0;  ///< 0 where it says nothing of single numbers
  std::array<float, 3> intent_parameters{};
  std::string intent_name;
  std::array<float, 2> shown{};           ///< `cal_min`, `cal_max`
  std::array<float, 2> time{1.0F, 0.0F};  ///< step (`pixdim[4]`) and first (`toffset`)
  std::optional<Scaling> scaling;         ///< where values are others than the stored numbers

  /// What is still said of other quantities at the same voxels.
  [[nodiscard]] ImageHeader of_others() const;
};

/// Of a NIfTI or NRRD file, and of a packed MetaImage or one of VTK's XML; nothing of any other, of a folder, and of what
/// cannot be read.
[[nodiscard]] std::optional<ImageHeader> read_image_header(const std::filesystem::path& file);

}  // namespace palpate
