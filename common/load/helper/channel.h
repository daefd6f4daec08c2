/// The wire between an explorer and its helper program: a SOCK_SEQPACKET socket pair on which every packet
/// is one Frame. A message is JSON inside a sealed memory file whose descriptor travels with the frame; the
/// arrays that the JSON speaks of lie in the same memory file. The messages are in protocol.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "common/base/files/unique_fd.h"
#include "common/load/helper/memory_file.h"

namespace palpate {

/// The descriptor on which a helper program finds its end of the socket pair.
inline constexpr int kHelperSocket = 3;

/// One packet. Both ends are of one build, so the struct travels as it lies in memory.
struct Frame {
  static constexpr std::uint32_t kMagic = 0x31504c50;  // "PLP1"
  enum Kind : std::uint32_t {
    kMessage = 1,  ///< a request, or its answer
    kProgress = 2,
    kNews = 3  ///< a message that is no answer yet: something for the user in the middle of the work
  };

  std::uint32_t magic = kMagic;
  std::uint32_t kind = kMessage;
  std::uint64_t json_offset = 0;  ///< message, news: where in the memory file the JSON lies
  std::uint64_t json_bytes = 0;
  double fraction = 0.0;  ///< progress: part done, 0 to 1; negative: unknown
  /// Progress: what is being done, ended by a zero; empty: what it was before.
  std::array<char, 64> stage{};
};

/// Sends one frame and, where `fd` >= 0, a descriptor. False where the other end is gone.
[[nodiscard]] bool send_frame(int socket, const Frame& frame, int fd) noexcept;

enum class Received { kFrame, kTimeOut, kClosed, kMalformed };

/// Waits up to `milliseconds` (-1: for ever) for one frame; `fd` gets the descriptor that came along.
[[nodiscard]] Received receive_frame(int socket, int milliseconds, Frame& frame, UniqueFd& fd) noexcept;

/// Appends `json` to `memory`, seals it and sends it. False where the other end is gone.
/// @throws std::system_error where memory runs out.
[[nodiscard]] bool send_message(int socket, MemoryFile& memory, std::string_view json,
                                Frame::Kind kind = Frame::kMessage);

/// The JSON that `frame` points at. @throws std::runtime_error where it lies outside `memory`.
[[nodiscard]] std::string_view json_of(const Frame& frame, std::span<const std::byte> memory);

}  // namespace palpate
