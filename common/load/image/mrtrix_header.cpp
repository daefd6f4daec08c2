#include "common/load/image/mrtrix_header.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

const std::string* MrtrixHeader::find(std::string_view key) const noexcept {
  const auto found =
      std::find_if(entries.rbegin(), entries.rend(), [key](const auto& entry) { return entry.first == key; });
  return found == entries.rend() ? nullptr : &found->second;
}

std::vector<std::string> MrtrixHeader::all(std::string_view key) const {
  std::vector<std::string> values;
  for (const auto& [name, value] : entries) {
    if (name == key) values.push_back(value);
  }
  return values;
}

MrtrixHeader read_mrtrix_header(const std::string& file, std::string_view bytes, std::string_view mark) {
  if (!bytes.starts_with(mark))
    throw input_error({file, "byte 0", "does not begin as it should", std::string(mark), ""});
  MrtrixHeader header;
  std::size_t at = bytes.find('\n');
  while (at != std::string_view::npos && at + 1 < bytes.size()) {
    const std::size_t next = std::min(bytes.find('\n', at + 1), bytes.size());
    const std::string_view line = trimmed(bytes.substr(at + 1, next - at - 1));
    at = next;
    if (line == "END" && next < bytes.size()) {
      header.end = next + 1;
      return header;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    header.entries.emplace_back(trimmed(line.substr(0, colon)), trimmed(line.substr(colon + 1)));
  }
  // A header beside its data (.mih) ends with the file.
  const std::string* const data = header.find("file");
  if (data == nullptr || data->starts_with("."))
    throw input_error({file, "header", "has no END", "", "the file may be damaged or cut off"});
  header.end = bytes.size();
  return header;
}

MrtrixNumber parse_mrtrix_number(std::string_view datatype) {
  MrtrixNumber number{lowered(datatype), false};
  number.big_endian = number.type.ends_with("be");
  if (number.big_endian || number.type.ends_with("le")) number.type.resize(number.type.size() - 2);
  return number;
}

}  // namespace palpate
