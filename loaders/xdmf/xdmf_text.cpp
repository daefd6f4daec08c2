#include "loaders/xdmf/xdmf_text.h"

#include <algorithm>
#include <filesystem>

#include "common/base/text.h"

namespace palpate {

XdmfText look_at_xdmf(std::string_view text) {
  XdmfText out;
  constexpr std::string_view kBlank = " \t\r\n";
  if (text.find("<!ENTITY") != std::string_view::npos) out.problem = "defines entities";
  for (std::size_t at = text.find("include"); at != std::string_view::npos;
       at = text.find("include", at + 1)) {
    const std::size_t open = text.rfind('<', at), close = std::min(text.find('>', at), text.size());
    if (open == std::string_view::npos || text.substr(open, at - open).find('>') != std::string_view::npos)
      continue;
    if (text.substr(at, close - at).find("href") != std::string_view::npos)
      out.problem = "includes another file";
  }
  for (std::size_t at = text.find(":/"); at != std::string_view::npos; at = text.find(":/", at + 1)) {
    std::size_t begin = at;
    while (begin > 0 && kBlank.find(text[begin - 1]) == std::string_view::npos && text[begin - 1] != '>' &&
           text[begin - 1] != '"' && text[begin - 1] != '|')
      --begin;
    const std::string_view name = text.substr(begin, at - begin);
    const bool address = begin > 0 && text[begin - 1] == '"';  // of a name space
    if (name.empty() || address || std::ranges::find(out.hdf5, name) != out.hdf5.end()) continue;
    const std::filesystem::path path(name);
    if (path.is_absolute() || *path.lexically_normal().begin() == "..") {
      out.problem = "has values in a file of another folder, '" + printable(name.substr(0, 60)) + "'";
      return out;
    }
    out.hdf5.emplace_back(name);
  }
  return out;
}

}  // namespace palpate
