#include "loaders/cardiac/text_lines.h"

#include <cmath>
#include <cstring>
#include <utility>

#include <zlib.h>

#include "common/base/error.h"
#include "common/base/number_text.h"

namespace palpate {

struct TextLines::Unpacker {
  gzFile file = nullptr;  ///< reads files that are not packed as they are
  explicit Unpacker(const std::string& path) : file(gzopen(path.c_str(), "rb")) {}
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
      buffer_(std::make_unique<char[]>(kLongestLine + 2)) {
  if (unpacker_->file == nullptr) throw input_error({file_, "", "cannot be opened"});
}
TextLines::~TextLines() = default;

bool TextLines::next() {
  if (given_back_) {
    given_back_ = false;
    rest_ = line_;
    return true;
  }
  line_ = rest_ = {};
  // A mark behind the text tells how far a line reaches even where it holds zero bytes.
  char* const text = buffer_.get();
  std::memset(text, '\n', kLongestLine + 2);
  if (gzgets(unpacker_->file, text, static_cast<int>(kLongestLine + 1)) == nullptr) {
    int status = Z_OK;
    (void)gzerror(unpacker_->file, &status);
    if (status != Z_OK && status != Z_STREAM_END)
      refuse("holds gzip data that are damaged or cut off", "a whole file");
    return false;
  }
  ++number_;
  const std::size_t length = std::strlen(text);
  // gzgets() ends what it read with a zero behind the newline: another zero before it is part of the text.
  const bool ended = length > 0 && text[length - 1] == '\n';
  if (!ended && !gzeof(unpacker_->file)) {
    refuse(length >= kLongestLine ? "is longer than 65536 bytes" : "holds zero bytes", "a line of text");
  }
  line_ = {text, length};
  if (comment_ != '\0') line_ = line_.substr(0, line_.find(comment_));
  line_ = trimmed(line_);
  rest_ = line_;
  return true;
}

std::string_view TextLines::word_here() noexcept {
  constexpr const char* kBetween = " \t\r\n,";
  const std::size_t first = rest_.find_first_not_of(kBetween);
  if (first == std::string_view::npos) {
    rest_ = {};
    return {};
  }
  rest_.remove_prefix(first);
  const std::string_view word = rest_.substr(0, rest_.find_first_of(kBetween));
  rest_.remove_prefix(word.size());
  return word;
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
    refuse("has " + std::to_string(value),
           std::string(what) + " from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return static_cast<std::int64_t>(value);
}

void TextLines::refuse(const std::string& found, const std::string& expected,
                       const std::string& remedy) const {
  throw input_error({file_, "line " + std::to_string(number_), found, expected, remedy});
}

}  // namespace palpate
