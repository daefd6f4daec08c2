/// Tracts as the table that all programs write lines to.
#pragma once

#include <filesystem>
#include <span>

#include "common/trace/tract/trace_tracts.h"

namespace palpate {

/// A row a point, with the header line,seed,point,x,y,z,time,arc,speed,error,termination of write_lines(). A tract
/// has both of its sides in one line: `arc` is the length from the seed along either side, `time` the same, below
/// zero on the side of the line's first point, `speed` 1, and `termination` why the row's side ends. Numbers are the
/// shortest texts that give the single precision of tracts back.
/// @param seeds that `result` was traced from.
/// @throws Error as OutputFile.
void write_tract_table(const std::filesystem::path& path, const TractResult& result,
                       std::span<const Vec3> seeds, bool overwrite);

}  // namespace palpate
