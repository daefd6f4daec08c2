/// Preintegrated tables filled by a compute shader (shaders/volume/preintegrate.comp), in the memory where
/// rays look them up: the numbers of preintegrate(), to the bit.
#pragma once

#include <cstddef>
#include <span>

#include "common/render/gl/object.h"
#include "common/render/volume/table/preintegration.h"

namespace palpate {

class GpuPreintegration {
 public:
  /// All cells of one length stand in the memory that a work group shares, of which OpenGL grants 32 KiB.
  static constexpr std::size_t kMostEntries = 512;
  /// Whether the context that is current has compute shaders that fill tables of so many entries an axis.
  [[nodiscard]] static bool possible(std::size_t entries);

  /// Fills layers from `first_layer` on of an array texture of 16-bit RGBA, n x n for n entries, as
  /// preintegrate() fills its table: of segments that meet `changed`; those of others stay. What follows sees
  /// it. @pre possible(entries.size()), and as for preintegrate().
  void fill(std::span<const OpticalEntry> entries, std::size_t lengths, const GlTexture& table,
            int first_layer, const EntryRange& changed);

 private:
  GlProgram program_;
  GlBuffer cell_lengths_;
  std::size_t entries_ = 0, lengths_ = 0;  ///< that these are made for
};

}  // namespace palpate
