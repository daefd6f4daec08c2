// Messages of OpenIGTLink, version 1 of the header: big-endian numbers in fields of fixed size.
// Source: "OpenIGTLink protocol", version 3 (openigtlink.org); the checksum is that of ECMA-182.
#include "library/palpate/slicer.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "common/base/files/unique_fd.h"
#include "common/base/index.h"
#include "library/access.h"

namespace palpate::api {
namespace {

/// Numbers and words one after the other, as the protocol has them.
class Bytes {
 public:
  template <class Number>
  void put(Number number) {
    for (int shift = 8 * static_cast<int>(sizeof(Number)) - 8; shift >= 0; shift -= 8)
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> shift));
  }
  void put_float(double number) { put(std::bit_cast<std::uint32_t>(static_cast<float>(number))); }
  void put_place(const Point& x, double scale) {
    for (const double c : x) put_float(scale * c);
  }
  /// In a field of `size` bytes. @pre it has room.
  void put_words(std::string_view words, std::size_t size) {
    bytes_.insert(bytes_.end(), words.begin(), words.end());
    bytes_.resize(bytes_.size() + size - words.size(), 0);
  }
  void put_bytes(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  [[nodiscard]] const std::vector<std::uint8_t>& all() const noexcept { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t kPolynomial = 0x42F0E1EBA9EA3693;
  std::uint64_t sum = 0;
  for (const std::uint8_t byte : bytes) {
    sum ^= std::uint64_t{byte} << 56U;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 63U) != 0 ? (sum << 1U) ^ kPolynomial : sum << 1U;
  }
  return sum;
}

/// Seconds since 1970 with 32 bits of fraction.
std::uint64_t time_stamp() {
  const double now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  return static_cast<std::uint64_t>(now * 0x1p32);
}

constexpr std::size_t kTypeSize = 12, kNameSize = 20;

std::vector<std::uint8_t> message(std::string_view type, const std::string& name, const Bytes& body) {
  if (name.size() > kNameSize)
    throw Error(Error::Kind::kUsage, "\"" + name + "\": a name of 20 bytes at most is expected");
  Bytes all;
  all.put(std::uint16_t{1});
  all.put_words(type, kTypeSize);
  all.put_words(name, kNameSize);
  all.put(time_stamp());
  all.put(std::uint64_t{body.all().size()});
  all.put(checksum(body.all()));
  all.put_bytes(body.all());
  return all.all();
}

/// Lines, each with its number of points, and a number for each point.
struct Polylines {
  std::vector<Point> points;
  std::vector<std::uint32_t> sizes;
  std::string scalar;  ///< empty: none
  std::vector<double> values;
};

Bytes body_of(const Polylines& lines, double scale) {
  Bytes body;
  const auto count = static_cast<std::uint32_t>(lines.points.size());
  const auto size =
      static_cast<std::uint32_t>(sizeof(std::uint32_t) * (lines.sizes.size() + lines.points.size()));
  // Points; vertices, lines, polygons and strips with their sizes in bytes; attributes.
  for (const std::uint32_t number : {count, 0U, 0U, static_cast<std::uint32_t>(lines.sizes.size()), size, 0U,
                                     0U, 0U, 0U, lines.scalar.empty() ? 0U : 1U})
    body.put(number);
  for (const Point& x : lines.points) body.put_place(x, scale);
  std::uint32_t at = 0;
  for (const std::uint32_t points : lines.sizes) {
    body.put(points);
    for (std::uint32_t i = 0; i < points; ++i) body.put(at++);
  }
  if (lines.scalar.empty()) return body;
  body.put(std::uint8_t{0});  // of points, scalars
  body.put(std::uint8_t{1});  // of one component
  body.put(count);
  const std::size_t words = lines.scalar.size() + 1;
  body.put_words(lines.scalar, words + words % 2);
  for (const double value : lines.values) body.put_float(value);
  return body;
}

Error failed(const std::string& what) { return {Error::Kind::kWorkFailed, what + ": " + errno_text()}; }

}  // namespace

struct Slicer::State {
  SlicerOptions options;
  UniqueFd door;
  int port = 0;
  std::vector<UniqueFd> clients;

  void send(const std::vector<std::uint8_t>& bytes) {
    // Who has gone, or does not read, is let go: a part of a message would spoil all that come after it.
    std::erase_if(clients, [&](const UniqueFd& client) {
      for (std::size_t sent = 0; sent < bytes.size();) {
        const ssize_t part = ::send(client.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (part <= 0) return true;
        sent += static_cast<std::size_t>(part);
      }
      return false;
    });
  }

  void send(const std::string& name, const Polylines& lines, double scale) {
    send(message("POLYDATA", name, body_of(lines, scale)));
  }
};

Slicer::Slicer(const SlicerOptions& options) : state_(std::make_unique<State>()) {
  if (!(options.scale > 0.0) || options.port < 0 || options.port > std::numeric_limits<std::uint16_t>::max())
    throw Error(Error::Kind::kUsage, "a port of 0 to 65535 and a scale above zero are expected");
  state_->options = options;
  state_->door = UniqueFd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (state_->door.get() < 0) throw failed("a socket");
  const int on = 1;
  ::setsockopt(state_->door.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(options.everywhere ? INADDR_ANY : INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(options.port));
  auto* const where = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  constexpr int kWaiting = 4;
  if (::bind(state_->door.get(), where, size) != 0 || ::listen(state_->door.get(), kWaiting) != 0 ||
      ::getsockname(state_->door.get(), where, &size) != 0)
    throw failed("port " + std::to_string(options.port));
  state_->port = ntohs(address.sin_port);
}

Slicer::~Slicer() = default;
Slicer::Slicer(Slicer&&) noexcept = default;
Slicer& Slicer::operator=(Slicer&&) noexcept = default;

int Slicer::port() const noexcept { return state_->port; }

int Slicer::clients() {
  for (;;) {
    UniqueFd client(::accept4(state_->door.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (client.get() < 0) break;
    const timeval patience{.tv_sec = 1, .tv_usec = 0};
    const int on = 1;
    ::setsockopt(client.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    ::setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    state_->clients.push_back(std::move(client));
  }
  return static_cast<int>(state_->clients.size());
}

void Slicer::send_place(const std::string& name, const Point& x) {
  Bytes body;
  // The columns of a turn, here none, then the place.
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) body.put_float(row == column ? 1.0 : 0.0);
  }
  body.put_place(x, state_->options.scale);
  state_->send(message("TRANSFORM", name, body));
}

void Slicer::send_marks(const std::string& name, const std::vector<Mark>& marks) {
  constexpr std::size_t kMarkSize = 64, kGroupSize = 32;
  Bytes body;
  for (const Mark& mark : marks) {
    if (mark.name.size() >= kMarkSize)
      throw Error(Error::Kind::kUsage, "\"" + mark.name + "\": a name of 63 bytes at most is expected");
    body.put_words(mark.name, kMarkSize);
    body.put_words("Fiducial", kGroupSize);
    for (const std::uint8_t part : mark.color) body.put(part);
    body.put_place(mark.position, state_->options.scale);
    body.put_float(0.0);  // diameter
    body.put_words("", kNameSize);
  }
  state_->send(message("POINT", name, body));
}

void Slicer::send_lines(const std::string& name, const Lines& lines) {
  Polylines all{.points = {lines.points().begin(), lines.points().end()},
                .sizes = {},
                .scalar = "error",
                .values = {lines.error().begin(), lines.error().end()}};
  for (std::size_t l = 0; l < lines.count(); ++l)
    all.sizes.push_back(static_cast<std::uint32_t>(lines.offsets()[l + 1] - lines.offsets()[l]));
  state_->send(name, all, state_->options.scale);
}

void Slicer::send_lines(const std::string& name, const Tracts& tracts) {
  Polylines all{
      .points = {}, .sizes = {}, .scalar = "error", .values = {tracts.error().begin(), tracts.error().end()}};
  for (const std::array<float, 3>& x : tracts.points()) all.points.push_back({x[0], x[1], x[2]});
  for (std::size_t l = 0; l < tracts.count(); ++l)
    all.sizes.push_back(static_cast<std::uint32_t>(tracts.offsets()[l + 1] - tracts.offsets()[l]));
  state_->send(name, all, 1.0);
}

void Slicer::send_touch(const std::string& name, const ServoNow& now) {
  send_place(name + "Probe", now.probe);
  send_place(name + "Proxy", now.proxy);
  const double scale = state_->options.scale;
  const Vec3 from = scale * vec_of(now.proxy);
  state_->send(name + "Force",
               {.points = {point_of(from), point_of(from + state_->options.newton * vec_of(now.force))},
                .sizes = {2},
                .scalar = {},
                .values = {}},
               1.0);
}

void Slicer::send_status(const std::string& name, int code, const std::string& words) {
  Bytes body;
  body.put(static_cast<std::uint16_t>(code));
  body.put(std::int64_t{0});
  body.put_words("", kNameSize);
  body.put_words(words, words.size() + 1);
  state_->send(message("STATUS", name, body));
}

}  // namespace palpate::api
