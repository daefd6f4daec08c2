#include "common/render/png.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>

#include <stb_image_write.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"

// Exported by the library; its header shows it only where the implementation is compiled.
extern "C" unsigned char* stbi_write_png_to_mem(const unsigned char* pixels, int stride_bytes, int x, int y,
                                                int n, int* out_len);

namespace palpate {
namespace {

constexpr std::size_t kSignature = 8;     // bytes before the first chunk
constexpr std::size_t kHeaderChunk = 25;  // IHDR: length 4, type 4, data 13, CRC 4

// CRC-32 of ISO 3309, as the PNG standard asks for.
std::uint32_t crc(const std::uint8_t* bytes, std::size_t count) {
  std::uint32_t value = 0xFFFFFFFFU;
  for (std::size_t i = 0; i < count; ++i) {
    value ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1U) ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~value;
}

void append_number(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::vector<std::uint8_t> text_chunk(const PngText& entry) {
  const bool ascii =
      std::all_of(entry.text.begin(), entry.text.end(), [](char c) { return (c & 0x80) == 0; });
  std::string body = entry.keyword + '\0';
  // iTXt: not compressed, method 0, no language tag, no translated keyword.
  if (!ascii) body.append(4, '\0');
  body += entry.text;
  std::vector<std::uint8_t> chunk;
  append_number(chunk, static_cast<std::uint32_t>(body.size()));
  for (const char c : std::string_view(ascii ? "tEXt" : "iTXt"))
    chunk.push_back(static_cast<std::uint8_t>(c));
  chunk.insert(chunk.end(), body.begin(), body.end());
  append_number(chunk, crc(chunk.data() + 4, chunk.size() - 4));
  return chunk;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image, const std::vector<PngText>& texts) {
  PALPATE_CHECK(image.width > 0 && image.height > 0);
  int size = 0;
  const std::unique_ptr<unsigned char, decltype(&std::free)> bytes(
      stbi_write_png_to_mem(image.rgba.data(), 4 * image.width, image.width, image.height, 4, &size),
      &std::free);
  if (!bytes) throw work_error("out of memory while a PNG was written");
  std::vector<std::uint8_t> png(bytes.get(), bytes.get() + kSignature + kHeaderChunk);
  for (const PngText& entry : texts) {
    PALPATE_CHECK(!entry.keyword.empty() && entry.keyword.size() <= 79);
    const auto chunk = text_chunk(entry);
    png.insert(png.end(), chunk.begin(), chunk.end());
  }
  png.insert(png.end(), bytes.get() + kSignature + kHeaderChunk, bytes.get() + size);
  return png;
}

void write_png(const std::filesystem::path& path, const Image& image, const std::vector<PngText>& texts) {
  OutputFile file(path, true);
  const auto png = encode_png(image, texts);
  file.write(std::as_bytes(std::span(png)));
  file.finish();
}

}  // namespace palpate
