#include "loaders/vtk/foam/foam_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <system_error>

#include <zlib.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

bool is_foam_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

template <typename T>
T number_in(std::string_view bytes, std::size_t i, bool swapped) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data() + i * sizeof(T), sizeof(T));
  if (swapped) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace

FoamText::FoamText(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    mapped_ = std::make_unique<MappedFile>(file.string());
    return;
  }
  const std::string name = file.string() + ".gz";
  const gzFile in = gzopen(name.c_str(), "rb");
  if (in == nullptr) throw input_error({file.string(), "", "cannot be opened", "", ""});
  constexpr std::size_t kMostBytes = std::size_t{1} << 33U;
  std::array<char, 1U << 16U> part{};
  int got = 0;
  while (unpacked_.size() < kMostBytes && (got = gzread(in, part.data(), part.size())) > 0)
    unpacked_.append(part.data(), as_size(got));
  gzclose(in);
  if (got < 0) throw input_error({name, "", "cannot be unpacked", "", "the file may be damaged"});
}

bool FoamTokens::done() {
  skip();
  return at_ >= text_.size();
}

std::string_view FoamTokens::peek() {
  const std::size_t before = at_;
  const std::string_view token = next();
  at_ = before;
  return token;
}

std::string_view FoamTokens::next() {
  skip();
  quoted_ = false;
  if (at_ >= text_.size()) return {};
  if (is_foam_mark(text_[at_])) return text_.substr(at_++, 1);
  if (text_[at_] == '"') {
    const std::size_t end = std::min(text_.size(), text_.find('"', at_ + 1));
    const std::string_view out = text_.substr(at_ + 1, end - at_ - 1);
    at_ = std::min(text_.size(), end + 1);
    quoted_ = true;
    return out;
  }
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_foam_space(text_[at_]) && !is_foam_mark(text_[at_]) && text_[at_] != '"')
    ++at_;
  return text_.substr(begin, at_ - begin);
}

void FoamTokens::expect(std::string_view mark) {
  const std::string_view token = next();
  if (token != mark)
    throw FoamMalformed{"'" + std::string(token.substr(0, 40)) + "' where '" + std::string(mark) +
                        "' is due"};
}

std::size_t FoamTokens::count() {
  const std::string_view token = next();
  const auto value = number(token);
  if (!value || !(*value >= 0.0) || *value > 4e9 || *value != std::floor(*value))
    throw FoamMalformed{"'" + std::string(token.substr(0, 40)) + "' where a count is due"};
  return floor_size(*value);
}

std::string_view FoamTokens::bytes(std::size_t count, std::size_t size) {
  if (count > (text_.size() - at_) / size)
    throw FoamMalformed{"a list of " + std::to_string(count) + " beyond the end"};
  const std::string_view out = text_.substr(at_, count * size);
  at_ += out.size();
  return out;
}

void FoamTokens::skip_entry() {
  for (int depth = 0; !done();) {
    if (depth == 0 && peek() == "}") return;
    const std::string_view token = next();
    if (token.substr(0, 5) == "List<" && storage_.binary) skip_binary(token);
    if (quoted_) continue;
    if (token == "{" || token == "(") ++depth;
    if (token == "}" || token == ")") --depth;
    if (depth <= 0 && (token == ";" || token == "}")) return;
  }
}

std::string_view FoamTokens::entry() {
  skip();
  const std::size_t begin = at_;
  skip_entry();
  std::string_view out = text_.substr(begin, at_ - begin);
  if (!out.empty() && out.back() == ';') out.remove_suffix(1);
  return out;
}

/// Over white space and comments.
void FoamTokens::skip() {
  while (at_ < text_.size()) {
    if (is_foam_space(text_[at_])) {
      ++at_;
    } else if (text_.substr(at_, 2) == "//") {
      at_ = std::min(text_.size(), text_.find('\n', at_));
    } else if (text_.substr(at_, 2) == "/*") {
      const std::size_t end = text_.find("*/", at_ + 2);
      at_ = end == std::string_view::npos ? text_.size() : end + 2;
    } else {
      return;
    }
  }
}

std::size_t foam_components(std::string_view list) {
  if (list == "List<scalar>") return 1;
  if (list == "List<vector>") return 3;
  if (list == "List<symmTensor>") return 6;
  if (list == "List<tensor>") return 9;
  if (list == "List<sphericalTensor>") return 1;
  throw FoamMalformed{"a binary " + std::string(list.substr(0, 40))};
}

void FoamTokens::skip_binary(std::string_view list) {
  const std::size_t size = foam_components(list) * storage_.scalar;
  const std::size_t values = count();
  if (values == 0 || peek() != "(") return;
  expect("(");
  (void)bytes(values, size);
  expect(")");
}

FoamStorage foam_storage(std::string_view text) {
  FoamStorage out;
  FoamTokens tokens(text.substr(0, 4096), out);
  if (tokens.peek() != "FoamFile") return out;
  (void)tokens.next();
  tokens.expect("{");
  while (!tokens.done() && tokens.peek() != "}") {
    const std::string_view key = tokens.next(), value = tokens.next();
    if (key == "format") out.binary = value == "binary";
    if (key == "arch") {
      out.swapped =
          (value.find("MSB") != std::string_view::npos) == (std::endian::native == std::endian::little);
      if (value.find("label=64") != std::string_view::npos) out.label = 8;
      if (value.find("scalar=32") != std::string_view::npos) out.scalar = 4;
    }
    while (!tokens.done() && tokens.next() != ";") {
    }
  }
  return out;
}

FoamTokens foam_body(std::string_view text) {
  const FoamStorage storage = foam_storage(text);
  FoamTokens tokens(text, storage);
  if (tokens.peek() == "FoamFile") {
    (void)tokens.next();
    tokens.skip_entry();
  }
  return tokens;
}

std::int64_t foam_label(std::string_view bytes, std::size_t i, const FoamStorage& storage) {
  return storage.label == 8 ? number_in<std::int64_t>(bytes, i, storage.swapped)
                            : std::int64_t{number_in<std::int32_t>(bytes, i, storage.swapped)};
}

double foam_scalar(std::string_view bytes, std::size_t i, const FoamStorage& storage) {
  return storage.scalar == 8 ? number_in<double>(bytes, i, storage.swapped)
                             : double{number_in<float>(bytes, i, storage.swapped)};
}

double foam_number(std::string_view token) {
  const auto value = number(token);
  if (!value) throw FoamMalformed{"'" + std::string(token.substr(0, 40)) + "' where a number is due"};
  return *value;
}

void append_foam_tuple(FoamTokens& tokens, std::size_t components, std::vector<double>& out) {
  if (components == 1) {
    out.push_back(foam_number(tokens.next()));
    return;
  }
  tokens.expect("(");
  for (std::size_t c = 0; c < components; ++c) out.push_back(foam_number(tokens.next()));
  tokens.expect(")");
}

}  // namespace palpate
