/// How many samples a test takes.
#pragma once

#include "common/base/sanitizers.h"

namespace palpate::test {

/// `all` of them; a quarter under AddressSanitizer, which takes ten times as long and looks at steps, not at values.
template <class Count>
[[nodiscard]] constexpr Count samples_of(Count all) noexcept {
  return PALPATE_UNDER_ASAN ? (all + 3) / 4 : all;
}

}  // namespace palpate::test
