#pragma once
// A render shown in tev while it goes on: `etendue render --tev HOST[:PORT]`. tev (https://github.com/Tom94/tev) is a viewer of
// pictures that takes them over TCP; its README says how (section "Over a Network").

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// Where a tev listens.
struct TevAddress {
  std::string host, port;
};
/// "HOST", "HOST:PORT", "[IPv6]:PORT". Throws Error, naming --tev, when it is none.
TevAddress parse_tev_address(const std::string&);

// Packets: a length that counts itself, an operation, and what belongs to that, all little endian.
std::vector<std::byte> tev_create_image(const std::string& name, int width, int height,
                                        const std::vector<std::string>& channels);
/// Rows [first, last) of a picture; `planes` are its channels, one after the other.
std::vector<std::byte> tev_update_image(const std::string& name, const std::vector<std::string>& channels,
                                        const std::vector<std::vector<float>>& planes, int width, int first, int last);
std::vector<std::byte> tev_close_image(const std::string& name);

/// Sends the picture about once a second, from a thread of its own. Whatever goes wrong is said once, as a warning, and the
/// render goes on without.
class TevDisplay {
 public:
  TevDisplay(const Render&, TevAddress, std::string name);
  ~TevDisplay();
  TevDisplay(const TevDisplay&) = delete;
  TevDisplay& operator=(const TevDisplay&) = delete;

  /// The last picture is shown; or, of a render that came to nothing, taken away. Waits for that, but a few seconds at most:
  /// what is to be kept is better written before.
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
  std::chrono::steady_clock::time_point last_moment_;  // for what is sent when ending_
  std::thread thread_;
};

}  // namespace etendue
