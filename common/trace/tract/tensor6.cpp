#include "common/trace/tract/tensor6.h"

#include <string>

#include "common/base/error.h"

namespace palpate {

std::string_view name_of(TractMeasure measure) noexcept { return measure == TractMeasure::kFa ? "fa" : "cl"; }

TractMeasure tract_measure_from_name(std::string_view name) {
  for (const TractMeasure measure : {TractMeasure::kFa, TractMeasure::kLinear}) {
    if (name_of(measure) == name) return measure;
  }
  throw usage_error("unknown measure '" + std::string(name) + "'; known are fa, cl");
}

}  // namespace palpate
