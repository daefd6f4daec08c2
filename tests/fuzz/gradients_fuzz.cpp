// Gradient tables of FSL: b-values before the first zero byte, directions behind it.
#include <string_view>

#include "common/base/error.h"
#include "common/load/fsl_gradients.h"
#include "tests/fuzz/memory_path.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t zero = std::min(text.find('\0'), size);
  const test::MemoryPath weightings(data, zero), directions(data + zero, size - zero);
  constexpr std::size_t kVolumes = 7;
  std::vector<std::string> notes;
  try {
    const GradientTable table =
        read_fsl_gradients({weightings.path(), directions.path()}, kVolumes, Mat3{2.0}, notes);
    if (table.weightings.size() != kVolumes || table.directions.size() != kVolumes) __builtin_trap();
    for (const Vec3& g : table.directions) {
      if (!is_finite(g)) __builtin_trap();
    }
  } catch (const Error&) {
  }
  return 0;
}
