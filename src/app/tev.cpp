#include "tev.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "etendue/film/image_tools.h"
#include "text.h"

namespace etendue {

TevAddress parse_tev_address(const std::string& text) {
  constexpr const char* usual_port = "14158";  // tev's own default
  TevAddress address;
  const bool bracketed = text.starts_with('[');
  const size_t end = bracketed ? text.find(']') : text.rfind(':');
  if (bracketed) {
    address.host = end == std::string::npos ? "" : text.substr(1, end - 1);
    const std::string rest = end == std::string::npos ? "" : text.substr(end + 1);
    address.port = rest.starts_with(':') ? rest.substr(1) : (rest.empty() ? usual_port : "");
  } else {
    address.host = text.substr(0, end);
    address.port = end == std::string::npos ? usual_port : text.substr(end + 1);
  }
  const bool digits =
      !address.port.empty() && address.port.size() <= 5 && address.port.find_first_not_of("0123456789") == std::string::npos;
  constexpr int largest_port = 65535;
  if (address.host.empty() || !digits || std::stoi(address.port) > largest_port || std::stoi(address.port) == 0)
    throw Error(fmt::format("'{}' is not an address of tev: HOST or HOST:PORT, such as 127.0.0.1:{}", text, usual_port),
                {intern("--tev"), 0, 0});
  return address;
}

// ---- packets ----------------------------------------------------------------------------------------------------------------

namespace {

enum class Operation : std::uint8_t { close_image = 2, create_image = 4, update_image_of_channels = 5 };

class Packet {
 public:
  explicit Packet(Operation o) {
    integer(0);  // a placeholder for the length, set in take()
    bytes_.push_back(std::byte(o));
  }
  Packet& flag(bool b) {
    bytes_.push_back(std::byte(b));
    return *this;
  }
  Packet& integer(std::int32_t n) {
    for (int shift = 0; shift < 32; shift += 8) bytes_.push_back(std::byte(std::uint32_t(n) >> shift));
    return *this;
  }
  Packet& text(const std::string& t) {
    for (const char c : t) bytes_.push_back(std::byte(c));
    bytes_.push_back(std::byte(0));
    return *this;
  }
  Packet& texts(const std::vector<std::string>& list) {
    for (const std::string& t : list) text(t);
    return *this;
  }
  Packet& number(float x) { return integer(std::bit_cast<std::int32_t>(x)); }
  std::vector<std::byte> take() {
    for (size_t i = 0; i < 4; ++i) bytes_[i] = std::byte(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace

std::vector<std::byte> tev_create_image(const std::string& name, int width, int height,
                                        const std::vector<std::string>& channels) {
  Packet packet(Operation::create_image);
  packet.flag(true).text(name).integer(width).integer(height).integer(int(channels.size())).texts(channels);
  return packet.take();
}

std::vector<std::byte> tev_update_image(const std::string& name, const std::vector<std::string>& channels,
                                        const std::vector<std::vector<float>>& planes, int width, int first, int last) {
  Packet packet(Operation::update_image_of_channels);
  packet.flag(false).text(name).integer(int(channels.size())).texts(channels);
  packet.integer(0).integer(first).integer(width).integer(last - first);
  for (const std::vector<float>& plane : planes)
    for (size_t i = size_t(first) * size_t(width); i < size_t(last) * size_t(width); ++i) packet.number(plane[i]);
  return packet.take();
}

std::vector<std::byte> tev_close_image(const std::string& name) {
  Packet packet(Operation::close_image);
  packet.text(name);
  return packet.take();
}

// ---- a connection -----------------------------------------------------------------------------------------------------------

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds patience(3);  // timeout to connect, and to send one packet
constexpr std::chrono::seconds farewell(5);  // timeout for all packets that are sent after the end of the render

/// Waits until a socket can be written to. Throws Error on failure or when `deadline` has passed.
void await_room(int socket, Clock::time_point deadline) {
  pollfd ready{socket, POLLOUT, 0};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    const int count = left > 0 ? poll(&ready, 1, int(left)) : 0;
    if (count > 0) return;
    if (count == 0) throw Error("there is no answer in time");
    if (errno != EINTR) throw Error(std::strerror(errno));
  }
}

int connected(const TevAddress& address) {
  const Clock::time_point deadline = Clock::now() + patience;
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int failed = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found))
    throw Error(gai_strerror(failed));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, freeaddrinfo);
  std::string reason = "there is no such address";
  for (const addrinfo* one = found; one; one = one->ai_next) {
    const int socket = ::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol);
    if (socket < 0) continue;
    try {
      int failure = connect(socket, one->ai_addr, one->ai_addrlen) == 0 ? 0 : errno;
      if (failure == EINPROGRESS) {
        await_room(socket, deadline);
        socklen_t size = sizeof failure;
        getsockopt(socket, SOL_SOCKET, SO_ERROR, &failure, &size);
      }
      if (failure == 0) return socket;
      reason = std::strerror(failure);
    } catch (const Error& error) {
      reason = error.what();
    }
    close(socket);
  }
  throw Error(reason);
}

}  // namespace

TevDisplay::TevDisplay(const Render& render, TevAddress address, std::string name)
    : render_(render), address_(std::move(address)), name_(std::move(name)), thread_([this] { work(); }) {}

TevDisplay::~TevDisplay() {
  finish(true);
  if (socket_ >= 0) close(socket_);
}

void TevDisplay::finish(bool keep) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(guard_);
    ending_ = true;
    keep_ = keep;
    last_moment_ = Clock::now() + farewell;
  }
  changed_.notify_all();
  thread_.join();
}

void TevDisplay::send(const std::vector<std::byte>& bytes) {
  // The deadline is for the whole packet, so a viewer that accepts only a few bytes at a time cannot block for longer.
  const Clock::time_point whole = Clock::now() + patience;
  for (size_t sent = 0; sent < bytes.size();) {
    Clock::time_point deadline = whole;
    {
      const std::lock_guard lock(guard_);
      if (ending_) deadline = std::min(deadline, last_moment_);
    }
    await_room(socket_, deadline);
    const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno != EAGAIN && errno != EINTR) throw Error(std::strerror(errno));
    if (count > 0) sent += size_t(count);
  }
}

/// Sends the image in linear sRGB, which tev expects, in bands of rows that keep packets small.
void TevDisplay::show() {
  const Image picture = convert_color_space(render_.picture(), "srgb");
  static const std::vector<std::string> channels = {"R", "G", "B"};
  if (picture.width != width_ || picture.height != height_) {
    width_ = picture.width;
    height_ = picture.height;
    send(tev_create_image(name_, width_, height_, channels));
  }
  std::vector<std::vector<float>> planes(channels.size());
  for (size_t c = 0; c < planes.size(); ++c)
    for (size_t i = c; i < picture.values.size(); i += picture.channels.size()) planes[c].push_back(float(picture.values[i]));
  constexpr int pixels = 1 << 16;
  const int rows = std::max(1, pixels / std::max(width_, 1));
  for (int y = 0; y < height_; y += rows)
    send(tev_update_image(name_, channels, planes, width_, y, std::min(y + rows, height_)));
}

void TevDisplay::work() {
  try {
    socket_ = connected(address_);
    for (bool last = false; !last;) {
      const Clock::time_point began = Clock::now();
      show();
      // Pauses at least 20 times as long as sending took, so that the display costs little of the render's time.
      const auto pause = std::max<Clock::duration>(std::chrono::seconds(1), 20 * (Clock::now() - began));
      std::unique_lock lock(guard_);
      changed_.wait_for(lock, pause, [&] { return ending_; });
      last = ending_;
    }
    if (keep_)
      show();
    else
      send(tev_close_image(name_));
  } catch (const std::exception& error) {
    warn(fmt::format("the picture is not shown in tev at {}:{}: {}", address_.host, address_.port, error.what()));
  }
}

}  // namespace etendue
