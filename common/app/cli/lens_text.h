/// Lenses as words: `--lens` and what a session keeps of those of a window.
///
///   sphere:x,y,z,r | box:x,y,z,x,y,z (two opposite corners) | cylinder:x,y,z,x,y,z,r (the middles of its
///   ends) | halfspace:nx,ny,nz,d (where n.x > d)                 and ",cut" behind it: cut away
///
/// Places and lengths in data units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/app/cli/options.h"
#include "common/render/lens/lens.h"

namespace palpate {

/// A lens without a transfer function of its own.
/// @throws Error (usage) for words of another kind, and for a shape without size.
[[nodiscard]] Lens parse_lens(const std::string& text);
/// The words for a lens that parse_lens() made, or that was moved or scaled since; nothing for other shapes.
[[nodiscard]] std::optional<std::string> lens_text(const Lens& lens);
/// All that have words, with ';' between: as a session keeps them.
[[nodiscard]] std::string lenses_text(const std::vector<Lens>& lenses);

/// The half-space n.x > d of "nx,ny,nz,d".
/// @param asked what the user wrote, named where the text is no plane. @throws Error (usage).
[[nodiscard]] ConvexShape parse_beyond(std::string_view text, const std::string& asked);

/// What `--lens` and `--clip` ask for; lenses that cut come first, so that they cut the others too.
/// @param focus transfer function of lenses that do not cut; absent: that of the context.
/// @throws Error (usage) also for more lenses than a picture can have.
[[nodiscard]] std::vector<Lens> make_lenses(const VolumeOptions& options,
                                            const std::optional<ColorTransfer>& focus);

}  // namespace palpate
