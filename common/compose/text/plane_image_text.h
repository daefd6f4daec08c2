/// What is drawn on planes, as words: `--plane-image`, `--window`, `--level`, `--contours`.
#pragma once

#include <string>
#include <vector>

#include "common/render/volume/volume_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Values of lines of equal value, "v,v,..."; none of an empty text. @throws Error (usage).
[[nodiscard]] std::vector<double> parse_contours(const std::string& text);
[[nodiscard]] std::string contours_text(const std::vector<double>& contours);

/// What the options ask for; a window for which they give no width or level is left out.
/// @throws Error (usage), also for more lines than a picture can have.
[[nodiscard]] PlaneImages plane_images_of(const VolumeOptions& options);
/// Fills in of the window what was not asked for: as the histogram of the values has it.
void complete_window(PlaneImages& planes, const VolumeOptions& options, const ValueHistogram& histogram);

}  // namespace palpate
