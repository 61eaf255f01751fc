#pragma once
// Server: the studio on the network, with one page and one WebSocket, in a single thread.

#include <memory>
#include <string>

#include "studio/studio.h"

namespace etendue::studio {

struct ServerSettings {
  std::string address = "127.0.0.1";
  unsigned short port = 0;  ///< 0: any free port
  std::string password;     ///< empty: no password, access by token only
  std::string page;         ///< path of the page's file
  std::string token;        ///< access token; empty: a random one
};

class Server {
 public:
  /// Listens; throws Error if it cannot.
  Server(Studio&, ServerSettings);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// "http://127.0.0.1:7007/?token=…"
  std::string address() const;
  /// "7007 TOKEN": the data with which a new server can be reached at the same address.
  std::string port_and_token() const;
  /// Serves until `stop`. Before it returns, pending messages are sent to pages for a short time.
  void run();
  /// Called from any thread, or a signal handler's thread.
  void stop();

  struct Members;

 private:
  std::unique_ptr<Members> m;
};

/// A text that cannot be guessed: 128 random bits from the system, in hexadecimal.
std::string random_token();
/// Compares two texts in a time that does not depend on where they differ.
bool equal_in_constant_time(const std::string& a, const std::string& b);

}  // namespace etendue::studio
