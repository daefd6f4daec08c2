#include "common/load/helper/channel.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <poll.h>
#include <sys/socket.h>

namespace palpate {
namespace {

/// Room for the one descriptor that a frame may carry.
union ControlBuffer {
  cmsghdr align;
  char bytes[CMSG_SPACE(sizeof(int))];
};

}  // namespace

bool send_frame(int socket, const Frame& frame, int fd) noexcept {
  iovec part{const_cast<Frame*>(&frame), sizeof(frame)};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  ControlBuffer control{};
  if (fd >= 0) {
    message.msg_control = control.bytes;
    message.msg_controllen = sizeof(control.bytes);
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(header), &fd, sizeof(int));
  }
  ssize_t sent = 0;
  do {
    sent = ::sendmsg(socket, &message, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(sizeof(frame));
}

Received receive_frame(int socket, int milliseconds, Frame& frame, UniqueFd& fd) noexcept {
  pollfd wait{socket, POLLIN, 0};
  const int ready = ::poll(&wait, 1, milliseconds);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return Received::kTimeOut;
  if (ready < 0) return Received::kClosed;

  iovec part{&frame, sizeof(frame)};
  ControlBuffer control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.bytes;
  message.msg_controllen = sizeof(control.bytes);
  const ssize_t got = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
  if (got < 0) return errno == EAGAIN || errno == EINTR ? Received::kTimeOut : Received::kClosed;
  if (got == 0) return Received::kClosed;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr; header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    if (header->cmsg_len != CMSG_LEN(sizeof(int))) return Received::kMalformed;
    int received = -1;
    std::memcpy(&received, CMSG_DATA(header), sizeof(int));
    fd.reset(received);
  }
  const bool whole =
      got == static_cast<ssize_t>(sizeof(frame)) && (message.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) == 0;
  return whole && frame.magic == Frame::kMagic ? Received::kFrame : Received::kMalformed;
}

bool send_message(int socket, MemoryFile& memory, std::string_view json, Frame::Kind kind) {
  Frame frame;
  frame.kind = kind;
  frame.json_offset = memory.append(std::as_bytes(std::span(json)));
  frame.json_bytes = json.size();
  memory.seal();
  return send_frame(socket, frame, memory.fd());
}

std::string_view json_of(const Frame& frame, std::span<const std::byte> memory) {
  if (frame.json_offset > memory.size() || frame.json_bytes > memory.size() - frame.json_offset) {
    throw std::runtime_error("message lies outside its memory");
  }
  const std::span<const std::byte> json = memory.subspan(frame.json_offset, frame.json_bytes);
  return {reinterpret_cast<const char*>(json.data()), json.size()};
}

}  // namespace palpate
