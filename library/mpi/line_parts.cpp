#include "library/mpi/line_parts.h"

#include <cstring>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/trace/walk/walk_state.h"

namespace palpate::mpi {
namespace {

template <class T>
void append(std::span<const T> numbers, std::vector<std::byte>& bytes) {
  const auto raw = std::as_bytes(numbers);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// The next `count` numbers of `reader`.
template <class T>
void take(StateReader& reader, std::size_t count, std::vector<T>& numbers) {
  if (count > reader.left().size() / sizeof(T)) throw work_error("a line on its way is cut short");
  numbers.resize(count);
  for (T& number : numbers) reader(number);
}

}  // namespace

void pack(const HeldLine& held, std::vector<std::byte>& bytes) {
  StateWriter head;
  head(held.line, held.part, held.block, std::uint64_t{held.state.size()});
  append<std::byte>(head.bytes(), bytes);
  append<std::byte>(held.state, bytes);
}

std::vector<HeldLine> unpack_held(std::span<const std::byte> bytes) {
  std::vector<HeldLine> lines;
  for (StateReader reader(bytes); !reader.left().empty();) {
    HeldLine& held = lines.emplace_back();
    std::uint64_t size = 0;
    reader(held.line, held.part, held.block, size);
    take(reader, size, held.state);
  }
  return lines;
}

void pack(const LinePart& part, std::vector<std::byte>& bytes) {
  StateWriter head;
  head(part.line, part.part, part.last, part.outside, part.end, std::uint64_t{part.points.size()});
  append<std::byte>(head.bytes(), bytes);
  append<LinePoint>(part.points, bytes);
}

std::vector<LinePart> unpack_parts(std::span<const std::byte> bytes) {
  std::vector<LinePart> parts;
  for (StateReader reader(bytes); !reader.left().empty();) {
    LinePart& part = parts.emplace_back();
    std::uint64_t size = 0;
    reader(part.line, part.part, part.last, part.outside, part.end, size);
    take(reader, size, part.points);
  }
  return parts;
}

}  // namespace palpate::mpi
