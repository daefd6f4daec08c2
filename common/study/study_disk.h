/// Files of an experiment: written so that a crash leaves the old one or the new one, and read with checks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/error.h"
#include "common/base/json.h"

namespace palpate {

/// @throws Error (bad input) where it cannot be read or is larger than 64 MiB.
[[nodiscard]] std::string read_study_text(const std::filesystem::path& path);
/// @throws Error (bad input) where it holds no object.
[[nodiscard]] Json read_study_json(const std::filesystem::path& path);
/// An integer between two limits, both included. @throws Json::exception; Error (bad input) that names
/// `path`.
[[nodiscard]] std::int64_t whole_number(const std::filesystem::path& path, const Json& json, const char* key,
                                        std::int64_t least, std::int64_t most);
/// Whether it is the second of two words. @throws likewise.
[[nodiscard]] bool is_second(const std::filesystem::path& path, const Json& json, const char* key,
                             std::string_view first, std::string_view second);

/// `take` of the object in the file, with what it misses as an error of that file.
template <typename Take>
auto taken(const std::filesystem::path& path, const Take& take) {
  try {
    return take(read_study_json(path));
  } catch (const Json::exception& error) {
    throw input_error({path.string(), "", error.what(), "", "restore it from a copy"});
  }
}

/// The whole of it is on the disk, under its name, when this returns. @throws Error (work failed).
void write_safely(const std::filesystem::path& path, const std::string& text);
/// With the folders above; they are on the disk when this returns. @throws Error (work failed).
void make_study_folder(const std::filesystem::path& path);

}  // namespace palpate
