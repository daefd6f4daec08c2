#include "common/base/files/line_reader.h"

#include <filesystem>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {

LineReader::LineReader(std::string file, std::string expected)
    : file_(std::move(file)),
      expected_(std::move(expected)),
      buffer_(std::make_unique<char[]>(kLongestLine + 2)) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file_, ignored)) {
    throw input_error({file_, "", "is a folder", expected_, ""});
  }
  in_.open(file_, std::ios::binary);
  if (!in_) throw input_error({file_, "", "cannot be opened", expected_, ""});
}

bool LineReader::next() {
  in_.getline(buffer_.get(), static_cast<std::streamsize>(kLongestLine + 2));
  if (in_.bad()) throw input_error({file_, "line " + std::to_string(number_ + 1), "cannot be read", "", ""});
  const auto taken = as_size(in_.gcount());
  if (in_.fail() && taken == 0) return false;  // the end
  ++number_;
  if (in_.fail()) refuse("is longer than " + std::to_string(kLongestLine) + " bytes", expected_);
  complete_ = !in_.eof();  // the newline is counted as taken, but not stored
  line_ = {buffer_.get(), complete_ ? taken - 1 : taken};
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (number_ == 1 && line_.starts_with(kByteOrderMark)) line_.remove_prefix(kByteOrderMark.size());
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  return true;
}

void LineReader::refuse(const std::string& found, const std::string& expected) const {
  throw input_error({file_, "line " + std::to_string(number_), found, expected, ""});
}

}  // namespace palpate
