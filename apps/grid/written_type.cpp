#include "apps/grid/written_type.h"

#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/array_type.h"

namespace palpate {
namespace {

std::optional<ScalarType> type_of(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(ScalarType::kFloat64); ++i) {
    const auto type = static_cast<ScalarType>(i);
    if (name == name_of(type)) return type;
  }
  return std::nullopt;
}

}  // namespace

void check_type(const SliceOptions& options) {
  if (options.type.empty() || type_of(options.type)) return;
  throw usage_error(
      "--type: unknown '" + options.type +
      "'; known are int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64");
}

std::string take_type(const SliceOptions& options, DataArray& values, ImageOrigin& origin) {
  if (options.type.empty()) return {};
  if (values.components > 1) throw usage_error("--type " + options.type + ": colours stay bytes");
  const ScalarType type = *type_of(options.type);
  if (origin.header) origin.header->scaling.reset();
  ClampedArray taken = clamped_to(values, type);
  values = std::move(taken.array);
  const auto part = [](std::size_t count, const std::string& what) {
    return count > 0 ? (", " + counted(count, "value") + what) : std::string();
  };
  const std::string lost = part(taken.clamped, " beyond its range at its ends") +
                           part(taken.rounded, " rounded") + part(taken.missing, " without a number, at 0");
  return lost.empty() ? "" : "written as " + options.type + lost;
}

}  // namespace palpate
