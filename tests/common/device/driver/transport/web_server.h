/// A WebSocket server (RFC 6455) on a free port of this machine, of sockets alone: its handshake, its hash
/// and its frames are its own. One client at a time, on a thread; what it does wrong is told to it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace palpate::test {

class WebServer {
 public:
  enum class Manner : std::uint8_t {
    kGood,
    kFragments,      ///< each message in three frames, with a ping between them
    kTrickle,        ///< each message byte by byte
    kDeaf,           ///< takes the connection, never answers the handshake
    kOtherHash,      ///< the handshake's key is wrong
    kNotFound,       ///< HTTP 404
    kEndlessHeader,  ///< a handshake that does not end
    kHuge,           ///< a frame of 2^40 bytes is announced
    kLong,           ///< a message of 200 kB in frames of 10 kB
    kMasked,         ///< frames are masked, as a server's never are
    kReserved,       ///< reserved bits are set
    kPings,          ///< nothing but pings, as many as go
    kReset           ///< ends in the middle of a frame
  };

  /// @param answer to a message of the client; "" stands for its coming. Runs on the server's thread.
  WebServer(Manner manner, std::function<std::string(const std::string&)> answer);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int clients() const { return clients_; }
  [[nodiscard]] bool unmasked() const { return unmasked_; }  ///< a client's frame was not masked
  [[nodiscard]] int pongs() const { return pongs_; }

 private:
  void serve(const std::stop_token& stop);
  void talk(const std::stop_token& stop, int client);
  bool shake_hands(const std::stop_token& stop, int client);
  void say(int client, const std::string& text) const;

  Manner manner_;
  std::function<std::string(const std::string&)> answer_;
  int socket_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<int> clients_{0}, pongs_{0};
  std::atomic<bool> unmasked_{false};
  std::jthread thread_;
};

/// SHA-1 (FIPS 180-4) of `text`, in base 64: the proof of a handshake.
std::string handshake_proof(const std::string& key);

}  // namespace palpate::test
