/// Files that a window writes on request, and their names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/annotation.h"
#include "common/hand/drawn/drawn_lines.h"
#include "common/load/write/image_origin.h"
#include "common/render/lens/lens.h"
#include "common/render/png.h"
#include "common/render/scene_view.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// The place `folder`/`stem` + `ending`, or of the first `stem`-2, `stem`-3, … that nothing has.
[[nodiscard]] std::filesystem::path free_place(const std::filesystem::path& folder, const std::string& stem,
                                               const std::string& ending);

/// Writes into one folder, never over a file that this window has not written itself.
/// Every function returns the absolute path that it wrote, and throws Error where it cannot.
class SavedFiles {
 public:
  /// @param program  the stem of pictures' names
  SavedFiles(const std::filesystem::path& folder, std::string program);

  /// Saves kept lines or tracts under `name`, numbered where a file of others is in the way; `name` becomes
  /// what was taken, so that the next time writes the same file again: as long as all that is in it is still
  /// kept, else the next number is taken.
  std::filesystem::path save_lines(const DrawnLines& lines, std::string& name);
  /// These are in a file, whoever has written it.
  void note_saved(const DrawnLines& lines);
  /// How many of `lines` are in no file.
  [[nodiscard]] std::size_t unsaved(const DrawnLines& lines) const;
  /// Saves a lens's transfer function under `name`: as a table, or its regions.
  [[nodiscard]] std::filesystem::path save_transfer(const std::string& name, const Lens& appearance) const;
  /// Saves annotations as `annotations` and `ending`, .csv or .vtp, under the first number that is free.
  [[nodiscard]] std::filesystem::path save_annotations(std::span<const Annotation> annotations,
                                                       const std::string& ending) const;
  struct SavedRegion {
    std::filesystem::path file;
    bool exact = true;  ///< false: wide numbers, of which a picture has the digits of single precision alone
    std::vector<std::string> lost;  ///< what the format has no place for
  };
  /// Saves the voxels of `image` in `region` as `crop` and `ending`, .nii.gz, .nrrd or .vti, under the first
  /// number that is free: with the header of `origin`, in the type of the data, as the verb `clip` does, or in doubles where not exact.
  /// @pre some are in it.
  [[nodiscard]] SavedRegion save_region(const VolumeImage& image, const Box& region,
                                        const std::string& ending, const ImageOrigin& origin) const;
  /// Saves a picture under the first number that is free.
  [[nodiscard]] std::filesystem::path save_picture(const Image& image,
                                                   const std::vector<PngText>& texts) const;

 private:
  /// `stem` and `ending` in the folder, numbered where that is taken.
  [[nodiscard]] std::filesystem::path free_name(const std::string& stem, const std::string& ending) const;

  std::filesystem::path folder_;
  std::string program_;
  using Lines = std::set<std::shared_ptr<const Line>>;
  std::filesystem::path own_lines_;    // the file of lines that this window has written: it may do so again
  std::filesystem::path asked_lines_;  // the name of that file as it was asked for, without a number
  Lines in_own_file_, saved_;
};

}  // namespace palpate
