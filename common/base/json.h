/// JSON as the project reads and writes it: an object keeps the order in which its members were added.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

// Compiled once, in json.cpp: each file that uses them would take seconds for them.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;
extern template class nlohmann::detail::serializer<nlohmann::ordered_json>;

namespace palpate {

using Json = nlohmann::ordered_json;

/// The value that a text is; discarded (Json::is_discarded) where it is none.
[[nodiscard]] Json parse_json(std::string_view text);

/// Indented text, whatever bytes file names are made of: they need not be UTF-8, JSON does.
[[nodiscard]] std::string json_text(const Json& json);

}  // namespace palpate
