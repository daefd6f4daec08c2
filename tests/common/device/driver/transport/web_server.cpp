#include "tests/common/device/driver/transport/web_server.h"

#include <algorithm>
#include <array>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/common/device/driver/transport/loopback.h"

namespace palpate::test {
namespace {

std::array<std::uint8_t, 20> sha1(std::string text) {
  std::array<std::uint32_t, 5> h{0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
  const std::uint64_t bits = 8 * text.size();
  text += '\x80';
  while (text.size() % 64 != 56) text += '\0';
  for (int shift = 56; shift >= 0; shift -= 8) text += static_cast<char>(bits >> shift);
  const auto turn = [](std::uint32_t x, int n) { return x << n | x >> (32 - n); };
  for (std::size_t at = 0; at < text.size(); at += 64) {
    std::array<std::uint32_t, 80> w{};
    for (std::size_t i = 0; i < 64; ++i) w[i / 4] = w[i / 4] << 8 | static_cast<std::uint8_t>(text[at + i]);
    for (std::size_t i = 16; i < 80; ++i) w[i] = turn(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
    auto [a, b, c, d, e] = h;
    for (std::size_t i = 0; i < 80; ++i) {
      const std::uint32_t f = i < 20   ? (b & c) | (~b & d)
                              : i < 40 ? b ^ c ^ d
                              : i < 60 ? (b & c) | (b & d) | (c & d)
                                       : b ^ c ^ d;
      const std::array<std::uint32_t, 4> k{0x5A827999, 0x6ED9EBA1, 0x8F1BBCDC, 0xCA62C1D6};
      const std::uint32_t next = turn(a, 5) + f + e + k[i / 20] + w[i];
      e = d;
      d = c;
      c = turn(b, 30);
      b = a;
      a = next;
    }
    h[0] += a;
    h[1] += b;
    h[2] += c;
    h[3] += d;
    h[4] += e;
  }
  std::array<std::uint8_t, 20> digest{};
  for (std::size_t i = 0; i < 20; ++i) digest[i] = static_cast<std::uint8_t>(h[i / 4] >> (24 - 8 * (i % 4)));
  return digest;
}

bool readable(int client, int milliseconds) {
  pollfd poll{client, POLLIN, 0};
  return ::poll(&poll, 1, milliseconds) > 0;
}

/// Exactly `size` bytes; less where the client has gone or the server ends.
std::string receive(const std::stop_token& stop, int client, std::size_t size) {
  std::string bytes;
  while (bytes.size() < size && !stop.stop_requested()) {
    if (!readable(client, 20)) continue;
    std::array<char, 4096> part{};
    const ssize_t got = ::recv(client, part.data(), std::min(part.size(), size - bytes.size()), 0);
    if (got <= 0) break;
    bytes.append(part.data(), static_cast<std::size_t>(got));
  }
  return bytes;
}

void send_all(int client, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = ::send(client, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (sent <= 0) return;
    at += static_cast<std::size_t>(sent);
  }
}

std::string frame(int first, const std::string& text) {
  std::string bytes(1, static_cast<char>(first));
  if (text.size() < 126) {
    bytes += static_cast<char>(text.size());
  } else {
    bytes += '\x7E';
    bytes += static_cast<char>(text.size() >> 8);
    bytes += static_cast<char>(text.size());
  }
  return bytes + text;
}

constexpr int kFinalText = 0x81, kText = 0x01, kFinalMore = 0x80, kMore = 0x00, kPing = 0x89;

}  // namespace

std::string handshake_proof(const std::string& key) {
  const auto digest = sha1(key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11");
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < 21; i += 3) {
    const std::uint32_t three = digest[i] << 16U | digest[i + 1] << 8U | (i + 2 < 20 ? digest[i + 2] : 0U);
    for (int n = 18; n >= 0; n -= 6) text += letters[three >> n & 63U];
  }
  text.back() = '=';
  return text;
}

WebServer::WebServer(Manner manner, std::function<std::string(const std::string&)> answer)
    : manner_(manner), answer_(std::move(answer)) {
  socket_ = listen_on_loopback(port_);
  thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

WebServer::~WebServer() {
  thread_.request_stop();
  thread_.join();
  ::close(socket_);
}

void WebServer::serve(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!readable(socket_, 20)) continue;
    const int client = ::accept(socket_, nullptr, nullptr);
    if (client < 0) continue;
    ++clients_;
    talk(stop, client);
    ::close(client);
  }
}

bool WebServer::shake_hands(const std::stop_token& stop, int client) {
  std::string request;
  while (request.find("\r\n\r\n") == std::string::npos) {
    const std::string byte = receive(stop, client, 1);
    if (byte.empty()) return false;
    request += byte;
  }
  if (manner_ == Manner::kDeaf) {
    (void)receive(stop, client, 1 << 20);
    return false;
  }
  if (manner_ == Manner::kNotFound) {
    send_all(client, "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n");
    return false;
  }
  if (manner_ == Manner::kEndlessHeader) {
    send_all(client, "HTTP/1.1 101 Switching Protocols\r\n");
    for (int n = 0; n < 10'000 && !stop.stop_requested(); ++n)
      send_all(client, "X-More: " + std::string(100, 'x') + "\r\n");
    return false;
  }
  const std::string name = "Sec-WebSocket-Key: ";
  const std::size_t at = request.find(name);
  if (at == std::string::npos) return false;
  const std::size_t begin = at + name.size();
  std::string proof = handshake_proof(request.substr(begin, request.find('\r', begin) - begin));
  if (manner_ == Manner::kOtherHash) proof[3] = proof[3] == 'A' ? 'B' : 'A';
  send_all(client,
           "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Accept: " +
               proof + "\r\n\r\n");
  return true;
}

void WebServer::say(int client, const std::string& text) const {
  const std::size_t third = text.size() / 3;
  switch (manner_) {
    case Manner::kFragments:
      send_all(client, frame(kText, text.substr(0, third)));
      send_all(client, frame(kPing, "still there?"));
      send_all(client, frame(kMore, text.substr(third, third)) + frame(kFinalMore, text.substr(2 * third)));
      break;
    case Manner::kTrickle:
      for (const char byte : frame(kFinalText, text)) send_all(client, std::string(1, byte));
      break;
    case Manner::kHuge:
      send_all(client, std::string("\x81\x7F\x00\x00\x01\x00\x00\x00\x00\x00", 10) + std::string(1000, '{'));
      break;
    case Manner::kLong:
      send_all(client, frame(kText, std::string(10'000, '{')));
      for (int n = 0; n < 20; ++n) send_all(client, frame(kMore, std::string(10'000, '{')));
      break;
    case Manner::kMasked: {
      std::string bytes = frame(kFinalText, text.substr(0, 100));
      bytes[1] = static_cast<char>(bytes[1] | '\x80');
      send_all(client, bytes.insert(2, "abcd"));
      break;
    }
    case Manner::kReserved:
      send_all(client, frame(kFinalText | 0x70, text));
      break;
    case Manner::kReset: {
      const linger at_once{1, 0};
      send_all(client, frame(kFinalText, text).substr(0, 20));
      (void)::setsockopt(client, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
      break;
    }
    default:
      send_all(client, frame(kFinalText, text));
  }
}

void WebServer::talk(const std::stop_token& stop, int client) {
  if (!shake_hands(stop, client)) return;
  if (manner_ == Manner::kPings) {
    while (!stop.stop_requested()) {
      const std::string ping = frame(kPing, std::string(100, 'p'));
      pollfd poll{client, POLLOUT | POLLIN, 0};
      if (::poll(&poll, 1, 20) <= 0) continue;
      if ((poll.revents & POLLOUT) != 0 &&
          ::send(client, ping.data(), ping.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == 0)
        return;
      std::array<char, 4096> heard{};
      const ssize_t got =
          (poll.revents & POLLIN) != 0 ? ::recv(client, heard.data(), heard.size(), MSG_DONTWAIT) : 1;
      if (got == 0 || (poll.revents & (POLLERR | POLLHUP)) != 0) return;
      if (got > 1) ++pongs_;
    }
    return;
  }
  say(client, answer_(""));
  if (manner_ == Manner::kReset) return;
  while (!stop.stop_requested()) {
    const std::string head = receive(stop, client, 2);
    if (head.size() < 2) return;
    const int kind = head[0] & 0x0F;
    std::size_t size = static_cast<std::uint8_t>(head[1]) & 0x7FU;
    if ((static_cast<std::uint8_t>(head[1]) & 0x80U) == 0) unmasked_ = true;
    if (size == 126) {
      const std::string more = receive(stop, client, 2);
      if (more.size() < 2) return;
      size = static_cast<std::size_t>(static_cast<std::uint8_t>(more[0])) << 8U |
             static_cast<std::uint8_t>(more[1]);
    }
    const std::string mask = receive(stop, client, 4);
    std::string text = receive(stop, client, size);
    if (mask.size() < 4 || text.size() < size) return;
    for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(text[i] ^ mask[i % 4]);
    if (kind == 8) return;
    if (kind == 10) ++pongs_;
    if (kind == 1) say(client, answer_(text));
  }
}

}  // namespace palpate::test
