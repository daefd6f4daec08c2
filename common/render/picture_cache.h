/// What is kept of a picture so that the next ones take less. Each has a technique of its own, and all have one
/// face: the renderer uses what is kept as long as it gives the same picture, says whether the last picture made it
/// anew, and forgets it when asked.
///
///   kStillPart  all of a scene that does not move with the probe, sample by sample    scene_renderer.h
///   kVolume     the picture of a volume that stands still while opaque things move    volume/cached_volume.h
///   kSlabs      pictures of what lies behind a plane that cuts a volume and moves     volume/slab_cache.h
///
/// The context of lenses (volume/context_picture.h) is a smaller picture, not a cache: each picture draws it anew.
#pragma once

#include <cstdint>

namespace palpate {

enum class PictureCache : std::uint8_t { kStillPart, kVolume, kSlabs };

}  // namespace palpate
