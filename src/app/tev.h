#pragma once
// Shows a render in the viewer tev during rendering: `etendue render --tev HOST[:PORT]`. tev (https://github.com/Tom94/tev)
// receives images over TCP; its README describes the protocol (section "Over a Network").

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// The address of a running tev.
struct TevAddress {
  std::string host, port;
};
/// "HOST", "HOST:PORT", "[IPv6]:PORT". Throws Error, with --tev as location, for anything else.
TevAddress parse_tev_address(const std::string&);

// Packets: the length in bytes (including itself), the operation, and its arguments, all little endian.
std::vector<std::byte> tev_create_image(const std::string& name, int width, int height,
                                        const std::vector<std::string>& channels);
/// Rows [first, last) of an image; `planes` are its channels, one after the other.
std::vector<std::byte> tev_update_image(const std::string& name, const std::vector<std::string>& channels,
                                        const std::vector<std::vector<float>>& planes, int width, int first, int last);
std::vector<std::byte> tev_close_image(const std::string& name);

/// Sends the image about once a second, from its own thread. An error is reported once, as a warning; the render continues
/// without the display.
class TevDisplay {
 public:
  TevDisplay(const Render&, TevAddress, std::string name);
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  /// Shows the final image or, if `keep` is false because the render was aborted, closes the image in tev. Blocks until this is
  /// sent, at most a few seconds, so files should be written before.
  void finish(bool keep);

 private:
  void work();
  void show();
  void send(const std::vector<std::byte>&);

  const Render& render_;
  const TevAddress address_;
  const std::string name_;
  int socket_ = -1;
  int width_ = 0, height_ = 0;
  std::mutex guard_;
  std::condition_variable changed_;
  bool ending_ = false, keep_ = true;
  std::chrono::steady_clock::time_point last_moment_;  // the deadline once ending_ is set
  std::thread thread_;
};

}  // namespace etendue
