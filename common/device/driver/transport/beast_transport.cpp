#include <chrono>
#include <exception>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "common/device/driver/transport/web_transport.h"

namespace palpate {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;
using Tcp = asio::ip::tcp;

constexpr std::size_t kLongestBody = 4096;    // [bytes] of what get() brings
constexpr std::size_t kLongestHeader = 4096;  // [bytes]

/// One operation after another, each with its time: they are started, and the loop is run until they are
/// done or their time is over. What is still under way then ends with the connection.
class TimedLoop {
 public:
  [[nodiscard]] asio::io_context& context() noexcept { return context_; }

  /// Runs until `done`, but no longer, whatever the other side keeps it busy with. What is ready already is
  /// taken in any case. @return whether it became so.
  bool run(const bool& done, double seconds) {
    constexpr int kMostReady = 100;  // steps of what is ready: a message takes some
    const Clock::time_point until =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    context_.restart();
    for (int n = 0; n < kMostReady && !done && context_.poll_one() > 0; ++n) {
    }
    while (!done && Clock::now() < until) {
      context_.restart();
      if (context_.run_one_until(until) == 0) break;
    }
    return done;
  }

 private:
  asio::io_context context_;
};

TransferStatus status_of(const beast::error_code& error) {
  if (!error) return TransferStatus::kOk;
  return error == websocket::error::message_too_big ? TransferStatus::kFailed : TransferStatus::kGone;
}

/// Finds the host and connects to it. @return whether that was done in time.
bool connect(TimedLoop& loop, beast::tcp_stream& stream, const WebAddress& address, double seconds) {
  Tcp::resolver resolver(loop.context());
  beast::error_code error;
  bool done = false;
  resolver.async_resolve(address.host, std::to_string(address.port),
                         [&](const beast::error_code& problem, const Tcp::resolver::results_type& found) {
                           error = problem;
                           if (problem) {
                             done = true;
                             return;
                           }
                           stream.async_connect(
                               found, [&](const beast::error_code& refused, const Tcp::endpoint& /*to*/) {
                                 error = refused;
                                 done = true;
                               });
                         });
  if (!loop.run(done, seconds)) {
    // What is left of it refers to what ends with this function.
    resolver.cancel();
    stream.close();
    constexpr double kEnding = 0.05;  // [s]
    (void)loop.run(done, kEnding);
    if (!done) loop.context().stop();
    return false;
  }
  if (!error) stream.socket().set_option(Tcp::no_delay(true), error);
  return !error;
}

class BeastConnection final : public WebConnection {
 public:
  BeastConnection() : stream_(loop_.context()), buffer_(kLongestMessage) {}

  TransferStatus open(const WebAddress& address, double seconds) {
    beast::tcp_stream& socket = beast::get_lowest_layer(stream_);
    if (!connect(loop_, socket, address, seconds)) return TransferStatus::kGone;
    socket.expires_never();  // times are kept here
    stream_.set_option(websocket::stream_base::timeout{websocket::stream_base::none(),
                                                       websocket::stream_base::none(), false});
    stream_.read_message_max(kLongestMessage);
    bool done = false;
    beast::error_code error;
    stream_.async_handshake(address.host + ":" + std::to_string(address.port), "/",
                            [&](const beast::error_code& problem) {
                              error = problem;
                              done = true;
                            });
    if (!loop_.run(done, seconds)) {
      // The handler refers to this call: it is called off and awaited.
      socket.close();
      (void)loop_.run(done, seconds);
      return TransferStatus::kGone;
    }
    return status_of(error);
  }

  TransferStatus send(std::string_view message, double seconds) noexcept override {
    if (ended_) return TransferStatus::kGone;
    try {
      sent_ = message;
      written_ = false;
      stream_.text(true);
      stream_.async_write(asio::buffer(sent_),
                          [this](const beast::error_code& problem, std::size_t /*bytes*/) {
                            write_status_ = status_of(problem);
                            written_ = true;
                          });
      if (!loop_.run(written_, seconds)) write_status_ = TransferStatus::kTimeout;
    } catch (const std::exception&) {
      write_status_ = TransferStatus::kFailed;
    }
    ended_ = ended_ || write_status_ != TransferStatus::kOk;
    return write_status_;
  }

  TransferStatus receive(std::string& message, double seconds) noexcept override {
    if (ended_) return TransferStatus::kGone;
    try {
      if (!reading_) {
        reading_ = true;
        read_ = false;
        stream_.async_read(buffer_, [this](const beast::error_code& problem, std::size_t /*bytes*/) {
          read_status_ = status_of(problem);
          read_ = true;
        });
      }
      if (!loop_.run(read_, seconds)) return TransferStatus::kTimeout;
      reading_ = false;
      ended_ = read_status_ != TransferStatus::kOk;
      if (ended_) return read_status_;
      const auto data = buffer_.cdata();
      message.assign(static_cast<const char*>(data.data()), data.size());
      buffer_.consume(buffer_.size());
      return TransferStatus::kOk;
    } catch (const std::exception&) {
      ended_ = true;
      return TransferStatus::kFailed;
    }
  }

 private:
  // The loop goes last: what is still under way is dropped with it, and not called.
  TimedLoop loop_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  std::string sent_;
  bool reading_ = false, read_ = false, written_ = false, ended_ = false;
  TransferStatus read_status_ = TransferStatus::kOk, write_status_ = TransferStatus::kOk;
};

class BeastTransport final : public WebTransport {
 public:
  [[nodiscard]] double now() const noexcept override { return clock_.now(); }
  void sleep(double seconds) noexcept override { clock_.sleep(seconds); }

  WebOpened open(const WebAddress& address, double seconds) noexcept override {
    try {
      auto connection = std::make_unique<BeastConnection>();
      const TransferStatus status = connection->open(address, seconds);
      if (status != TransferStatus::kOk) return {status, nullptr};
      return {status, std::move(connection)};
    } catch (const std::exception&) {
      return {TransferStatus::kFailed, nullptr};
    }
  }

  std::optional<std::string> get(const WebAddress& address, const std::string& path,
                                 double seconds) noexcept override {
    try {
      HttpExchange exchange;
      return exchange.get(address, path, seconds);
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

 private:
  struct HttpExchange {
    std::optional<std::string> get(const WebAddress& address, const std::string& path, double seconds) {
      if (!connect(loop, stream, address, seconds)) return std::nullopt;
      request = {http::verb::get, path, 11};
      request.set(http::field::host, address.host + ":" + std::to_string(address.port));
      answer.body_limit(kLongestBody);
      answer.header_limit(kLongestHeader);
      http::async_write(stream, request, [this](const beast::error_code& problem, std::size_t /*bytes*/) {
        if (problem) {
          done = true;
          return;
        }
        http::async_read(stream, buffer, answer,
                         [this](const beast::error_code& refused, std::size_t /*bytes*/) {
                           got = !refused;
                           done = true;
                         });
      });
      if (!loop.run(done, seconds) || !got || answer.get().result() != http::status::ok) return std::nullopt;
      return answer.get().body();
    }

    TimedLoop loop;
    beast::tcp_stream stream{loop.context()};
    beast::flat_buffer buffer{kLongestHeader + kLongestBody};
    http::request<http::empty_body> request;
    http::response_parser<http::string_body> answer;
    bool done = false, got = false;
  };

  SystemLinkClock clock_;
};

}  // namespace

std::unique_ptr<WebTransport> make_beast_transport() { return std::make_unique<BeastTransport>(); }

}  // namespace palpate
