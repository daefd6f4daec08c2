#include "loaders/cardiac/text_lines.h"

#include <cmath>
#include <cstring>
#include <utility>

#include <zlib.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {

namespace {

constexpr std::size_t kBuffer = 4 * TextLines::kLongestLine;  // [bytes]

/// Where words end.
constexpr bool between_text(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
}

}  // namespace

struct TextLines::Unpacker {
  gzFile file = nullptr;  ///< reads files that are not packed as they are
  explicit Unpacker(const std::string& path) : file(gzopen(path.c_str(), "rb")) {
    if (file != nullptr) (void)gzbuffer(file, kBuffer);
  }
  ~Unpacker() {
    if (file != nullptr) gzclose(file);
  }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
};

TextLines::TextLines(std::string file, char comment)
    : file_(std::move(file)),
      comment_(comment),
      unpacker_(std::make_unique<Unpacker>(file_)),
      buffer_(std::make_unique<char[]>(kBuffer)) {
  if (unpacker_->file == nullptr) throw input_error({file_, "", "cannot be opened"});
}
TextLines::~TextLines() = default;

bool TextLines::take_line(std::string_view& line) {
  std::size_t searched = begin_;
  for (;;) {
    const char* const text = buffer_.get();
    const void* const newline = std::memchr(text + searched, '\n', end_ - searched);
    if (newline != nullptr) {
      const auto length = as_size(static_cast<const char*>(newline) - text) - begin_;
      line = {text + begin_, length};
      begin_ += length + 1;
      return true;
    }
    if (end_ - begin_ > kLongestLine) {
      ++number_;
      refuse("is longer than 65536 bytes", "a line of text");
    }
    std::memmove(buffer_.get(), text + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    searched = end_;
    const int got = gzread(unpacker_->file, buffer_.get() + end_, static_cast<unsigned>(kBuffer - end_));
    if (got > 0) {
      end_ += as_size(got);
      continue;
    }
    int status = Z_OK;
    (void)gzerror(unpacker_->file, &status);
    if (status != Z_OK && status != Z_STREAM_END)
      refuse("holds gzip data that are damaged or cut off", "a whole file");
    line = {buffer_.get(), end_};
    begin_ = end_;
    return !line.empty();
  }
}

bool TextLines::next() {
  if (given_back_) {
    given_back_ = false;
    rest_ = line_;
    return true;
  }
  line_ = rest_ = {};
  std::string_view line;
  if (!take_line(line)) return false;
  ++number_;
  if (line.size() > kLongestLine) refuse("is longer than 65536 bytes", "a line of text");
  if (line.find('\0') != std::string_view::npos) refuse("holds zero bytes", "a line of text");
  if (comment_ != '\0') line = line.substr(0, line.find(comment_));
  line_ = trimmed(line);
  rest_ = line_;
  return true;
}

std::string_view TextLines::word_here() noexcept {
  const char* first = rest_.data();
  const char* const end = first + rest_.size();
  while (first != end && between_text(*first)) ++first;
  const char* last = first;
  while (last != end && !between_text(*last)) ++last;
  rest_ = {last, as_size(end - last)};
  return {first, as_size(last - first)};
}

std::string_view TextLines::word() {
  for (;;) {
    const std::string_view word = word_here();
    if (!word.empty()) return word;
    if (!next()) return {};
  }
}

double TextLines::number(const char* what) {
  const std::string_view text = word();
  if (text.empty()) refuse("ends too early", what);
  const auto value = palpate::number(text);
  if (!value || !std::isfinite(*value)) refuse("has \"" + std::string(text.substr(0, 40)) + "\"", what);
  return *value;
}

std::int64_t TextLines::integer(const char* what, std::int64_t least, std::int64_t most) {
  const double value = number(what);
  if (value != std::floor(value) || value < static_cast<double>(least) || value > static_cast<double>(most)) {
    refuse("has " + short_number(value),
           std::string(what) + " from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return static_cast<std::int64_t>(value);
}

void TextLines::refuse(const std::string& found, const std::string& expected,
                       const std::string& remedy) const {
  throw input_error({file_, "line " + std::to_string(number_), found, expected, remedy});
}

}  // namespace palpate
