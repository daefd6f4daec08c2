#include "common/load/helper/message_json.h"

#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/load/helper/protocol.h"

namespace palpate::message {
namespace {

/// More JSON than any sensible input needs; a million blocks stay below it.
constexpr std::size_t kMaxJsonBytes = std::size_t{256} << 20;

std::string bytes_from_text(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto b = static_cast<unsigned char>(text[i]);
    if (b < 0x80) {
      bytes += text[i];
    } else if ((b & 0xfc) == 0xc0 && i + 1 < text.size()) {
      bytes += static_cast<char>(((b & 0x03) << 6) | (static_cast<unsigned char>(text[++i]) & 0x3f));
    } else {
      malformed("a character above U+00FF");
    }
  }
  return bytes;
}

}  // namespace

void malformed(const std::string& what) { throw ProtocolError(what); }

std::string text_from_bytes(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size());
  for (const char c : bytes) {
    const auto b = static_cast<unsigned char>(c);
    if (b < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xc0 | (b >> 6));
      text += static_cast<char>(0x80 | (b & 0x3f));
    }
  }
  return text;
}

Json parse(std::string_view text) {
  if (text.size() > kMaxJsonBytes) malformed("message of " + std::to_string(text.size()) + " bytes");
  Json value = parse_json(text);
  if (!value.is_object()) malformed("message is not a JSON object");
  return value;
}

void throw_failure(const Json& answer) {
  const auto failed = answer.find("failed");
  if (failed == answer.end()) return;
  const std::uint64_t code = count_of(*failed, "failed");
  const std::string line = string_at(answer, "line");
  throw Error(code == 1 || code == 2 ? static_cast<ExitCode>(code) : ExitCode::kBadInput, line);
}

const Json& member(const Json& object, const char* key) {
  if (!object.is_object()) malformed(std::string("no object around '") + key + "'");
  const auto found = object.find(key);
  if (found == object.end()) malformed(std::string("'") + key + "' is missing");
  return *found;
}

std::string string_at(const Json& object, const char* key) {
  const Json& value = member(object, key);
  if (!value.is_string()) malformed(std::string("'") + key + "' is no string");
  return bytes_from_text(value.get_ref<const std::string&>());
}

std::uint64_t count_of(const Json& value, const char* key) {
  if (!value.is_number_unsigned()) malformed(std::string("'") + key + "' is no count");
  const auto count = value.get<std::uint64_t>();
  if (count > kMaxCount) malformed(std::string("'") + key + "' is too large");
  return count;
}

std::uint64_t count_at(const Json& object, const char* key) { return count_of(member(object, key), key); }

double number_of(const Json& value, const char* key) {
  if (!value.is_number()) malformed(std::string("'") + key + "' is no number");
  const double number = value.get<double>();
  if (!std::isfinite(number)) malformed(std::string("'") + key + "' is not finite");
  return number;
}

bool bool_at(const Json& object, const char* key) {
  const Json& value = member(object, key);
  if (!value.is_boolean()) malformed(std::string("'") + key + "' is neither true nor false");
  return value.get<bool>();
}

const Json& array_at(const Json& object, const char* key) {
  const Json& value = member(object, key);
  if (!value.is_array()) malformed(std::string("'") + key + "' is no array");
  return value;
}

const Json& array_at(const Json& object, const char* key, std::size_t size) {
  const Json& value = array_at(object, key);
  if (value.size() != size) malformed(std::string("'") + key + "' has the wrong length");
  return value;
}

std::vector<std::string> strings_at(const Json& object, const char* key) {
  std::vector<std::string> strings;
  for (const Json& value : array_at(object, key)) {
    if (!value.is_string()) malformed(std::string("'") + key + "' holds something else than strings");
    strings.push_back(bytes_from_text(value.get_ref<const std::string&>()));
  }
  return strings;
}

Vec3 vector_at(const Json& object, const char* key) {
  const Json& value = array_at(object, key, 3);
  return {number_of(value[0], key), number_of(value[1], key), number_of(value[2], key)};
}

Index3 index_at(const Json& object, const char* key) {
  const Json& value = array_at(object, key, 3);
  Index3 index{0};
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t count = count_of(value[as_size(axis)], key);
    if (count > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
      malformed(std::string("'") + key + "' is too large");
    }
    index[axis] = static_cast<int>(count);
  }
  return index;
}

}  // namespace palpate::message
