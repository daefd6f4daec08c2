/// What the options of tracing mean to the tracer.
#pragma once

#include <cstdint>
#include <string>

#include "common/scene/document/document.h"
#include "common/scene/seeds.h"
#include "common/trace/trace.h"

namespace palpate {

/// `--memory` in bytes: what lines may take, of a machine that is not told a quarter of its memory.
[[nodiscard]] std::uint64_t line_memory(const TracingOptions& tracing);

/// Reads `--direction`, `--integrator` and the limits.
/// @param default_direction where `--direction` is not given.
/// @throws Error (usage).
[[nodiscard]] TraceOptions trace_options(const Document& options, const std::string& default_direction);

}  // namespace palpate
