#include "common/hand/touch_choice.h"

#include "common/base/error.h"

namespace palpate {

std::string_view name_of(StrokeUse use) noexcept { return use == StrokeUse::kAppend ? "append" : "replace"; }

StrokeUse stroke_use_from_name(std::string_view name) {
  for (const StrokeUse use : {StrokeUse::kAppend, StrokeUse::kReplace}) {
    if (name == name_of(use)) return use;
  }
  throw usage_error("--stroke " + std::string(name) + ": append, replace are known");
}

}  // namespace palpate
