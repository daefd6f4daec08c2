#include "loaders/mesh/mesh_words.h"

#include <charconv>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/written_number.h"

namespace palpate {
namespace {

bool parts_words(char c) { return is_blank(c) || c == ','; }

std::string quote(std::string_view word) { return "'" + printable(word.substr(0, 40)) + "'"; }

}  // namespace

void MeshWords::skip() {
  while (at_ < text_.size()) {
    if (parts_words(text_[at_])) {
      ++at_;
    } else if (comment_ != '\0' && text_[at_] == comment_) {
      at_ = std::min(text_.size(), text_.find('\n', at_));
    } else {
      return;
    }
  }
}

bool MeshWords::done() {
  skip();
  return at_ >= text_.size();
}

std::string_view MeshWords::word() {
  skip();
  last_ = at_;
  quoted_ = false;
  if (at_ >= text_.size()) return {};
  if (text_[at_] == '"') {
    const std::size_t end = std::min(text_.size(), text_.find('"', at_ + 1));
    const std::string_view out = text_.substr(at_ + 1, end - at_ - 1);
    at_ = std::min(text_.size(), end + 1);
    quoted_ = true;
    return out;
  }
  std::size_t end = at_;
  while (end < text_.size() && !parts_words(text_[end]) && text_[end] != '"') ++end;
  const std::string_view out = text_.substr(at_, end - at_);
  at_ = end;
  return out;
}

std::string_view MeshWords::peek() {
  const std::size_t before = at_, last = last_;
  const std::string_view out = word();
  at_ = before;
  last_ = last;
  return out;
}

std::string_view MeshWords::rest_of_line() {
  last_ = at_;
  const std::size_t end = std::min(text_.size(), text_.find('\n', at_));
  std::string_view out = text_.substr(at_, end - at_);
  at_ = std::min(text_.size(), end + 1);
  if (comment_ != '\0') out = out.substr(0, out.find(comment_));
  return trimmed(out);
}

double MeshWords::number(const char* what) {
  const std::string_view text = word();
  if (const auto value = written_number(text)) return *value;
  refuse(text.empty() ? "ends" : quote(text), what, text.empty() ? "the file may be truncated" : "");
}

std::int64_t MeshWords::integer(const char* what, std::int64_t least, std::int64_t most) {
  std::string_view text = word();
  if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
  const auto value = parsed<std::int64_t>(text);
  if (value && *value >= least && *value <= most) return *value;
  refuse(text.empty() ? "ends" : quote(text),
         std::string(what) + " from " + std::to_string(least) + " to " + std::to_string(most),
         text.empty() ? "the file may be truncated" : "");
}

std::size_t MeshWords::count(const char* what, std::size_t least_bytes) {
  return as_size(integer(what, 0, static_cast<std::int64_t>(left() / least_bytes + 1)));
}

void MeshWords::end_line() {
  const std::size_t end = text_.find('\n', at_);
  at_ = end == std::string_view::npos ? text_.size() : end + 1;
}

std::string_view MeshWords::bytes(std::size_t count, const char* what) {
  last_ = at_;
  if (count > left()) refuse("ends", what, "the file may be truncated");
  const std::string_view out = text_.substr(at_, count);
  at_ += count;
  return out;
}

void MeshWords::skip_behind(std::string_view word) {
  const std::size_t found = text_.find(word, at_);
  if (found == std::string_view::npos) refuse("ends", std::string(word), "the file may be truncated");
  at_ = found + word.size();
}

void MeshWords::refuse(const std::string& found, const std::string& expected,
                       const std::string& remedy) const {
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(last_), '\n');
  throw input_error({file_, "line " + std::to_string(line), found, expected, remedy});
}

}  // namespace palpate
