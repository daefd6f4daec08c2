#include "library/mpi/mapped_vectors.h"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>

#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate::mpi {
namespace {

/// Where a NRRD's numbers lie, as far as its header says so in the plainest way.
struct RawNumbers {
  std::filesystem::path file;
  std::size_t offset = 0;
  ScalarType type = ScalarType::kFloat32;
};

struct Header {
  std::map<std::string, std::string, std::less<>> fields;
  std::size_t bytes = 0;

  [[nodiscard]] std::string_view at(std::string_view name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? std::string_view() : std::string_view(found->second);
  }
};

Header read_header(std::string_view text) {
  Header header;
  while (header.bytes < text.size()) {
    const std::size_t end = std::min(text.find('\n', header.bytes), text.size());
    const std::string_view line = trimmed(text.substr(header.bytes, end - header.bytes));
    header.bytes = std::min(end + 1, text.size());
    if (line.empty()) break;
    const std::size_t colon = line.find(": ");
    if (line.front() != '#' && colon != std::string_view::npos)
      header.fields.emplace(lowered(line.substr(0, colon)), trimmed(line.substr(colon + 2)));
  }
  return header;
}

/// @return why they cannot be mapped; empty: they can, and `numbers` says where they are.
std::string find_numbers(const std::filesystem::path& nrrd, std::string_view text, RawNumbers& numbers) {
  const Header header = read_header(text);
  numbers = {.file = nrrd, .offset = header.bytes};
  if (const std::string_view apart = header.at("data file"); !apart.empty()) {
    if (apart.starts_with("LIST") || apart.find('%') != std::string_view::npos)
      return "its numbers stand in several files";
    numbers.file = nrrd.parent_path() / apart;
    numbers.offset = 0;
  }
  if (header.at("encoding") != "raw") return "its encoding is not raw";
  for (const char* skip : {"byte skip", "line skip", "byteskip", "lineskip"}) {
    if (!header.at(skip).empty()) return "its header skips bytes or lines";
  }
  if (header.at("type") == "double") {
    numbers.type = ScalarType::kFloat64;
  } else if (header.at("type") != "float") {
    return "its numbers are neither float nor double";
  }
  constexpr bool kLittle = std::endian::native == std::endian::little;
  if (header.at("endian") != (kLittle ? "little" : "big")) return "its byte order is not this machine's";
  if (!header.at("space").empty() || !header.at("measurement frame").empty())
    return "its vectors may have to be turned: the header names a space or a frame of measurement";
  if (header.at("dimension") != "4" || !header.at("sizes").starts_with("3 "))
    return "its vectors do not stand one after the other";
  const std::size_t size = byte_size(numbers.type);
  if (numbers.offset % size != 0)
    return "its numbers begin at byte " + std::to_string(numbers.offset) + ", which is no multiple of " +
           std::to_string(size) + ": pad the header with a comment";
  return {};
}

std::optional<DataArray> map_numbers(const RawNumbers& numbers, const DataSet& block,
                                     const VectorChoice& choice) {
  const auto file = std::make_shared<const MappedFile>(numbers.file.string());
  const std::size_t points = block.point_count();
  const std::size_t bytes = 3 * points * byte_size(numbers.type);
  const std::string_view all = file->text();
  if (numbers.offset > all.size() || all.size() - numbers.offset < bytes) return std::nullopt;
  return DataArray{.name = choice.arrays.front(),
                   .association = Association::kPoint,
                   .components = 3,
                   .type = numbers.type,
                   .tuples = points,
                   .bytes = std::as_bytes(std::span(all.substr(numbers.offset, bytes))),
                   .owner = file,
                   .sparse = nullptr};
}

}  // namespace

MappedField map_vectors(Input& input) {
  if (input.file() == nullptr || input.file()->format != "NRRD" || input.spec().files.size() != 1) return {};
  const std::filesystem::path& path = input.spec().files.front();
  const VectorChoice choice = input.choice();
  if (choice.kind != VectorChoice::Kind::kArray || !input.times().empty())
    return {.field = nullptr, .why = "it holds no single array of vectors"};
  RawNumbers numbers;
  if (std::string why = find_numbers(path, MappedFile(path.string()).text(), numbers); !why.empty())
    return {.field = nullptr, .why = std::move(why)};
  std::vector<DataSet> blocks = input.read({});
  if (blocks.size() != 1) return {.field = nullptr, .why = "it holds several blocks"};
  std::optional<DataArray> values = map_numbers(numbers, blocks.front(), choice);
  if (!values) return {.field = nullptr, .why = "it holds fewer numbers than its header says"};
  blocks.front().arrays.push_back(std::move(*values));
  return {.field = make_vector_field(blocks, choice, path.string(), 1), .why = {}};
}

}  // namespace palpate::mpi
