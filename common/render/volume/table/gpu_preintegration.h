/// Preintegrated tables filled by a compute shader (shaders/volume/preintegrate.comp), in the memory where
/// rays look them up: the numbers of preintegrate(), to the bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/render/gl/object.h"
#include "common/render/volume/table/preintegration.h"
#include "common/render/volume/volume_view.h"

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

/// Median of so many runs after the first one, to the end on the GPU [ms]. Nothing where the context that is
/// current has none, or is a software rasteriser, which takes seconds.
[[nodiscard]] std::optional<double> compute_table_ms(std::span<const OpticalEntry> entries,
                                                     std::size_t lengths, int repeats);

// Who fills preintegrated tables: the processor's threads or a compute shader. The numbers are the same, so
// the faster one does. Plain arithmetic, no clock.
//
// On a software rasteriser that is the processor, untried: a compute shader would run on the same cores,
// a thread of a work group after the other (preintegration_bench: 20 times as long and more). Elsewhere both
// are timed, from the entries of the transfer function to the table in the memory of the GPU:
//   table 1   by the processor
//   table 2   by the GPU; not timed, as its shader is compiled then
//   table 3   by the GPU
//   then      by the one that took less

class TableChoice {
 public:
  /// Tables of another size.
  void begin() noexcept { *this = {}; }
  /// Who fills the next table: kProcessor or kGpu. @param asked VolumeView::table_maker.
  /// @param possible GpuPreintegration::possible(). @param software is_software_rasteriser().
  [[nodiscard]] TableMaker next(TableMaker asked, bool possible, bool software) noexcept;
  /// It took so long [ms].
  void filled(double milliseconds) noexcept;

  /// The time of the next one is wanted, to its end on the GPU.
  [[nodiscard]] bool timed() const noexcept { return reason_ == Reason::kTrial; }
  /// By whom the last one was filled, and why: "GPU (4.1 ms, the processor 18 ms)".
  [[nodiscard]] std::string text() const;

 private:
  enum class Reason : std::uint8_t { kNone, kAsked, kNoCompute, kSoftware, kTrial, kFaster };
  TableMaker maker_ = TableMaker::kProcessor;
  Reason reason_ = Reason::kNone;
  int tries_ = 0;
  double processor_ = 0.0, gpu_ = 0.0;  ///< [ms]
};

}  // namespace palpate
