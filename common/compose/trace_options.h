/// What the options of tracing mean to the tracer.
#pragma once

#include <cstddef>
#include <string>

#include "common/scene/document/document.h"
#include "common/scene/seeds.h"
#include "common/trace/trace.h"

namespace palpate {

/// Reads `--direction`, `--integrator` and the limits.
/// @param default_direction where `--direction` is not given.
/// @throws Error (usage).
[[nodiscard]] TraceOptions trace_options(const Document& options, const std::string& default_direction);

}  // namespace palpate
