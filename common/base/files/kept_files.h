/// Files that no output may replace.
#pragma once

#include <filesystem>
#include <span>

namespace palpate {

/// What a program reads: from now on no OutputFile of this process takes its place, under whatever name and
/// whatever `overwrite` says. Files that are not there are left out. Safe from any thread.
void keep_from_outputs(std::span<const std::filesystem::path> files);

}  // namespace palpate
