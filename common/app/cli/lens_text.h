/// Lenses as words: `--lens` and what a session keeps of those of a window.
///
///   sphere:x,y,z,r | box:x,y,z,x,y,z (two opposite corners) | cylinder:x,y,z,x,y,z,r (the middles of its
///   ends) | polyhedron:nx,ny,nz,d,... (where n.x <= d for each) | halfspace:nx,ny,nz,d (where n.x > d) |
///   screen:x,y,r (a circle on the screen, in heights of the picture from its middle, y up)
///
/// and behind it, in any order, ",cut": cut away, and ",off" with it where a half-space does not for now;
/// ",magnify=M"; ",blend=B" (Lens::transition); ",samples=N" a voxel; ",shading=on" or "off", each as outside
/// the lens where it is not said. Places and lengths in data units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/app/cli/options.h"
#include "common/render/lens/lens.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// A lens without a transfer function of its own, and what was said of its rays.
struct LensWords {
  Lens lens;
  std::optional<double> samples;  ///< a voxel
  std::optional<bool> shading;
  bool off = false;  ///< a half-space that would cut
};
/// @throws Error (usage) for words of another kind, and for a shape without size.
[[nodiscard]] LensWords parse_lens(const std::string& text);
/// The words for a lens that parse_lens() made, or that was moved or scaled since; nothing for other shapes.
/// @param view that the lens is part of: what it shares with the context is not said.
[[nodiscard]] std::optional<std::string> lens_text(const Lens& lens, const VolumeView& view);
/// The planes that cut and all lenses that have words, with ';' between: as a session keeps them.
[[nodiscard]] std::string lenses_text(const VolumeView& view);

/// The half-space n.x > d of "nx,ny,nz,d".
/// @param asked what the user wrote, named where the text is no plane. @throws Error (usage).
[[nodiscard]] ConvexShape parse_beyond(std::string_view text, const std::string& asked);

struct VolumeParts {
  std::vector<Lens> lenses;
  std::vector<CuttingPlane> cuts;
};
/// What `--lens` and `--clip` ask for: half-spaces that cut are planes; other lenses that cut come first, so
/// that they cut the others too.
/// @param focus transfer function of lenses that do not cut; absent: that of the context.
/// @throws Error (usage) also for more lenses or planes than a picture can have.
[[nodiscard]] VolumeParts make_parts(const VolumeOptions& options, const std::optional<ColorTransfer>& focus);

}  // namespace palpate
