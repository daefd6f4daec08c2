/// Lenses as words: `--lens` and what a session keeps of those of a window.
///
///   sphere:x,y,z,r | box:x,y,z,x,y,z (two opposite corners) | cylinder:x,y,z,x,y,z,r (the middles of its
///   ends) | polyhedron:nx,ny,nz,d,... (where n.x <= d for each) | halfspace:nx,ny,nz,d (where n.x > d) |
///   screen:x,y,r (a circle on the screen, in heights of the picture from its middle, y up)
///
/// and behind it, in any order, ",cut": cut away, and ",off" with it where a half-space does not for now;
/// ",magnify=M"; ",blend=B" (Lens::transition); ",samples=N" a voxel; ",shading=on" or "off"; ",illustration=on" or "off"; ",field=NAME",
/// another scalar (volume_fields.h): each as outside the lens where it is not said; at the end of all
/// ",tf=W", a transfer function of its own (volume_transfer_of()). Places and lengths in data units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/render/lens/lens.h"
#include "common/render/volume/volume_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// A lens without a transfer function of its own, and what was said of its rays.
struct LensSpec {
  Lens lens;
  std::optional<double> samples;  ///< a voxel
  std::optional<bool> shading;
  std::optional<bool> illustrated;
  std::string field;     ///< empty: that of the context
  std::string transfer;  ///< empty: that of all lenses
  bool off = false;      ///< a half-space that would cut
};
/// @throws Error (usage) for words of another kind, and for a shape without size.
[[nodiscard]] LensSpec parse_lens(const std::string& text);
/// The words for a lens that parse_lens() made, or that was moved or scaled since; nothing for other shapes.
/// @param view that the lens is part of: what it shares with the context is not said.
[[nodiscard]] std::optional<std::string> lens_text(const Lens& lens, const VolumeView& view);
/// A ball as `--lens` says it.
[[nodiscard]] std::string sphere_text(const Vec3& center, double radius);
/// The planes that cut and all lenses that have words: what `--lens` is given so many times.
[[nodiscard]] std::vector<std::string> lens_texts(const VolumeView& view);

/// The half-space n.x > d of "nx,ny,nz,d".
/// @param asked what the user wrote, named where the text is no plane. @throws Error (usage).
[[nodiscard]] ConvexShape parse_beyond(std::string_view text, const std::string& asked);

struct VolumeParts {
  std::vector<Lens> lenses;
  std::vector<std::string> fields, transfers;  ///< LensSpec::field and transfer of each lens
  std::vector<CuttingPlane> cuts;
};
/// What `--lens` and `--clip` ask for: half-spaces that cut are planes; other lenses that cut come first, so
/// that they cut the others too.
/// @param model whose transfer function lenses have that do not cut.
/// @throws Error (usage) also for more lenses or planes than a picture can have.
[[nodiscard]] VolumeParts make_parts(const VolumeOptions& options, const Lens& model = {});

}  // namespace palpate
