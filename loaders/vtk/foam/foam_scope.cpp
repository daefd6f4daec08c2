#include "loaders/vtk/foam/foam_scope.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::size_t kDeepest = 16, kMostFiles = 256;
constexpr std::size_t kLongest = std::size_t{64} << 20U;  // of what macros make, and of all files

bool in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == ':' || c == '/';
}

/// An entry of the dictionary whose text, with its brackets, is `dictionary`.
std::string_view entry_of(std::string_view dictionary, std::string_view name) {
  FoamTokens tokens(dictionary, {});
  if (tokens.peek() != "{") return {};
  (void)tokens.next();
  std::string_view out;
  while (!tokens.done() && tokens.peek() != "}") {
    const bool found = tokens.next() == name;
    const std::string_view text = tokens.entry();
    if (found) out = text;
  }
  return out;
}

}  // namespace

FoamScope::FoamScope(FoamTokens& tokens, const FoamScope* parent, const FoamInclude& include)
    : parent_(parent) {
  add(tokens, include);
}

void FoamScope::add_file(const std::string& name, const FoamInclude& include) {
  std::string file = std::filesystem::path(name).lexically_normal().generic_string();
  const std::string what = "#include \"" + name.substr(0, 60) + "\"";
  if (std::ranges::find(open_, file) != open_.end()) throw FoamMalformed{what + ", which includes itself"};
  if (open_.size() >= kDeepest || included_.size() >= kMostFiles)
    throw FoamMalformed{what + " in more files than are read"};
  std::string text = include(name);
  if (text.empty()) return;
  if (text.size() > kLongest - included_bytes_) throw FoamMalformed{what + " of more text than is read"};
  included_bytes_ += text.size();
  included_.push_back(std::move(text));
  open_.push_back(std::move(file));
  FoamTokens inner = foam_body(included_.back());
  add(inner, include);
  open_.pop_back();
}

void FoamScope::add(FoamTokens& tokens, const FoamInclude& include) {
  while (!tokens.done() && tokens.peek() != "}") {
    const std::string key(tokens.next());
    if (key == ";") continue;
    if (!key.empty() && key.front() == '#') {  // with an argument, without an end
      const std::string what(tokens.next());
      if (include && key.substr(0, 8) == "#include" && key != "#includeEtc") add_file(what, include);
      continue;
    }
    if (!key.empty() && key.front() == '$' && tokens.peek() == ";") continue;
    entries_[key] = tokens.entry();
  }
}

std::string_view FoamScope::own(std::string_view name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? std::string_view() : found->second;
}

std::string_view FoamScope::find(std::string_view name) const {
  const FoamScope* scope = this;
  bool upwards = true;
  if (name.substr(0, 1) == ":") {
    while (scope->parent_ != nullptr) scope = scope->parent_;
    name.remove_prefix(1);
    upwards = false;
  } else if (name.substr(0, 1) == ".") {
    name.remove_prefix(1);
    upwards = false;
    for (; name.substr(0, 1) == "."; name.remove_prefix(1)) {
      if (scope->parent_ == nullptr) return {};
      scope = scope->parent_;
    }
  }
  // A name may have dots of its own; else they lead into dictionaries.
  const auto within = [&](const FoamScope& at) -> std::string_view {
    if (const std::string_view whole = at.own(name); !whole.empty()) return whole;
    const std::size_t dot = name.find_first_of("./");
    if (dot == std::string_view::npos) return {};
    std::string_view text = at.own(name.substr(0, dot)), rest = name.substr(dot + 1);
    while (!text.empty() && !rest.empty()) {
      const std::size_t next = std::min(rest.find_first_of("./"), rest.size());
      text = entry_of(text, rest.substr(0, next));
      rest.remove_prefix(std::min(rest.size(), next + 1));
    }
    return text;
  };
  for (; scope != nullptr; scope = scope->parent_) {
    if (const std::string_view found = within(*scope); !found.empty() || !upwards) return found;
  }
  return {};
}

std::string FoamScope::expanded(std::string_view text, int depth) const {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '$') {
      out += text[at++];
      continue;
    }
    std::size_t begin = at + 1, end = begin;
    const bool braced = begin < text.size() && text[begin] == '{';
    if (braced) {
      begin = ++end;
      while (end < text.size() && text[end] != '}') ++end;
    } else {
      while (end < text.size() && in_name(text[end])) ++end;
    }
    const std::string_view name = text.substr(begin, end - begin);
    const std::string_view found = name.empty() ? std::string_view() : find(name);
    if (found.empty() || as_size(depth) > kDeepest || out.size() + found.size() > kLongest)
      throw FoamMalformed{"$" + std::string(name.substr(0, 40)) + ", which stands for nothing there"};
    out += expanded(found, depth + 1);
    at = std::min(text.size(), end + (braced ? 1 : 0));
  }
  return out;
}

}  // namespace palpate
