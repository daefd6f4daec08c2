#include "common/render/volume/table/table_choice.h"

#include <array>
#include <cstdio>

namespace palpate {
namespace {

constexpr int kTries = 3;

}  // namespace

TableMaker TableChoice::next(TableMaker asked, bool possible, bool software) noexcept {
  maker_ = TableMaker::kProcessor;
  if (!possible) {
    reason_ = Reason::kNoCompute;
  } else if (asked != TableMaker::kFaster) {
    reason_ = Reason::kAsked;
    maker_ = asked;
  } else if (software) {
    reason_ = Reason::kSoftware;
  } else if (tries_ < kTries) {
    reason_ = Reason::kTrial;
    maker_ = tries_ == 0 ? TableMaker::kProcessor : TableMaker::kGpu;
  } else {
    reason_ = Reason::kFaster;
    maker_ = gpu_ < processor_ ? TableMaker::kGpu : TableMaker::kProcessor;
  }
  return maker_;
}

void TableChoice::filled(double milliseconds) noexcept {
  if (reason_ != Reason::kTrial) return;
  (maker_ == TableMaker::kGpu ? gpu_ : processor_) = milliseconds;
  ++tries_;
}

std::string TableChoice::text() const {
  const std::string maker = maker_ == TableMaker::kGpu ? "GPU" : "processor";
  switch (reason_) {
    case Reason::kNone:
      return "nobody: there is none";
    case Reason::kAsked:
      return maker + ", as asked for";
    case Reason::kNoCompute:
      return maker + ": the driver has no compute shaders for tables of this size";
    case Reason::kSoftware:
      return maker + ": compute shaders of a software rasteriser are slower";
    case Reason::kTrial:
      return maker + ": both are being timed";
    case Reason::kFaster:
      break;
  }
  std::array<char, 64> times{};
  std::snprintf(times.data(), times.size(), ": the GPU takes %.1f ms, the processor %.1f ms", gpu_,
                processor_);
  return maker + times.data();
}

}  // namespace palpate
