/// One NIfTI image: where its voxels lie and what they hold, and its values on demand.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/vector_frame.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// What a fourth axis holds where the header does not say that it is a vector's.
enum class FourthAxis : std::uint8_t { kTime, kComponents };

class NiftiFile {
 public:
  /// Reads the header, which check_nifti() has held against the file's size.
  /// @param left_handed LoadRequest::left_handed, where it is asked for.
  /// @throws Error (bad input).
  NiftiFile(const std::string& file, FourthAxis fourth_axis, std::optional<bool> left_handed);
  NiftiFile(NiftiFile&&) noexcept;
  NiftiFile& operator=(NiftiFile&&) noexcept;
  ~NiftiFile();

  [[nodiscard]] const UniformTopology& topology() const noexcept;  ///< RAS+ mm
  [[nodiscard]] bool anatomical() const noexcept;
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;
  [[nodiscard]] const std::vector<double>& times() const noexcept;  ///< empty for a single state
  [[nodiscard]] const ArrayInfo& array() const noexcept;
  void rename(const std::string& array);
  /// The header's intent is that of symmetric matrices.
  [[nodiscard]] bool symmetric_matrix() const noexcept;
  /// Along which axes vectors and tensors are, where the description of the header says so as write_image() does.
  [[nodiscard]] std::optional<VectorFrame> stated_frame() const noexcept;

  /// Reads the voxels of a time step. @throws Error (bad input).
  [[nodiscard]] DataArray values(std::size_t step, const std::function<void(double)>& on_progress) const;

 private:
  struct Image;
  std::unique_ptr<Image> image_;
};

}  // namespace palpate
