/// Who fills preintegrated tables: the processor's threads or a compute shader. The numbers are the same, so
/// the faster one does. Plain arithmetic, no clock.
///
/// On a software rasteriser that is the processor, untried: a compute shader would run on the same cores,
/// a thread of a work group after the other (preintegration_bench: 20 times as long and more). Elsewhere both
/// are timed, from the entries of the transfer function to the table in the memory of the GPU:
///   table 1   by the processor
///   table 2   by the GPU; not timed, as its shader is compiled then
///   table 3   by the GPU
///   then      by the one that took less
#pragma once

#include <cstdint>
#include <string>

#include "common/render/volume/volume_view.h"

namespace palpate {

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
