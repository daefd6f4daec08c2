/// The editor of a colour transfer function: its points over the histogram of the values.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/field/transfer/region_transfer.h"
#include "common/field/value_histogram.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "common/render/volume/voxels/volume_image.h"
#include "common/window/controls/transfer_edit.h"

namespace palpate {

/// The histogram of the volume that was asked for last, counted once: of all its voxels, or where they are
/// more than two million of as many, evenly taken, so that a frame hardly waits for it.
class CachedHistogram {
 public:
  /// @pre not null. @return null where no value is finite.
  [[nodiscard]] const ValueHistogram* of(const std::shared_ptr<const VolumeImage>& image);
  /// What of() returned last; null before.
  [[nodiscard]] const ValueHistogram* last() const noexcept { return image_ ? &histogram_ : nullptr; }
  /// Of values and gradient magnitudes, likewise. @pre not null.
  [[nodiscard]] const PlaceHistogram& places_of(const std::shared_ptr<const VolumeImage>& image);

 private:
  std::shared_ptr<const VolumeImage> image_, places_image_;
  ValueHistogram histogram_;
  PlaceHistogram places_;
};

/// A transfer function of values, or in its place one of values and gradient magnitudes.
struct EditedTransfer {
  ColorTransfer colors;
  std::optional<RegionTransfer> regions;

  bool operator==(const EditedTransfer&) const = default;
};

/// Chooses between what `words` may be (those of --transfer-function; empty: `automatic`) and lets the points
/// or regions be edited; what is edited goes into `words` and `transfer` alike.
/// @param setting_name whose help is shown. @param file name for the text field below, from which a function is loaded and to which it is saved.
/// @param felt value at the probe, marked over the histogram; none: no hand is there.
/// @return whether it is to be saved now.
[[nodiscard]] bool choose_transfer(const char* label, const char* setting_name, const char* automatic,
                                   std::string& words, EditedTransfer& transfer,
                                   const std::shared_ptr<const VolumeImage>& image,
                                   CachedHistogram& histograms, std::string& file,
                                   std::optional<double> isovalue = std::nullopt);

/// The same of one lens, without words and files: what is chosen and edited goes into `transfer`.
/// @return whether it changed.
bool choose_own_transfer(const char* label, EditedTransfer& transfer,
                         const std::shared_ptr<const VolumeImage>& image, CachedHistogram& histograms);

/// Points are dragged; a double click adds one, a right click takes one out; the one that was touched last
/// has its colour below.
/// @param id apart from other editors of the panel. @param histogram may be null. @param felt as above.
/// @return whether `transfer` changed.
bool draw_transfer_editor(const char* id, const ValueSpan& values, const ValueHistogram* histogram,
                          ColorTransfer& transfer, std::optional<double> isovalue = std::nullopt);

}  // namespace palpate
