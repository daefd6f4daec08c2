/// The JSON of messages (protocol.h), read with the type of everything checked.
///
/// Reading functions name the key in their complaint. They all throw ProtocolError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/json.h"
#include "common/math/vec.h"

namespace palpate::message {

/// Counts beyond it are no data's: products of two of them with a number's size do not wrap.
inline constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 46;

/// @throws ProtocolError, always.
[[noreturn]] void malformed(const std::string& what);

/// Byte b becomes character U+00b in UTF-8: readable where it is ASCII, and reversible for any bytes.
[[nodiscard]] std::string text_from_bytes(std::string_view bytes);

/// A whole message, which must be one object of a sensible size.
[[nodiscard]] Json parse(std::string_view text);
/// @throws Error where the answer is a failure: {"failed", "line"}.
void throw_failure(const Json& answer);

[[nodiscard]] const Json& member(const Json& object, const char* key);
/// Bytes from text: the reverse of text_from_bytes().
[[nodiscard]] std::string string_at(const Json& object, const char* key);
[[nodiscard]] std::vector<std::string> strings_at(const Json& object, const char* key);
/// At most kMaxCount.
[[nodiscard]] std::uint64_t count_of(const Json& value, const char* key);
[[nodiscard]] std::uint64_t count_at(const Json& object, const char* key);
/// Finite numbers only: JSON has no others.
[[nodiscard]] double number_of(const Json& value, const char* key);
[[nodiscard]] bool bool_at(const Json& object, const char* key);
[[nodiscard]] const Json& array_at(const Json& object, const char* key);
[[nodiscard]] const Json& array_at(const Json& object, const char* key, std::size_t size);
[[nodiscard]] Vec3 vector_at(const Json& object, const char* key);
[[nodiscard]] Index3 index_at(const Json& object, const char* key);

[[nodiscard]] inline Json counts_json(const Index3& index) { return {index.x, index.y, index.z}; }
[[nodiscard]] inline Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace palpate::message
