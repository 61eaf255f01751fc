#pragma once
// The studio on the network: one page and one WebSocket. All of it happens in one thread.

#include <memory>
#include <string>

#include "studio/studio.h"

namespace etendue::studio {

struct ServerSettings {
  std::string address = "127.0.0.1";
  unsigned short port = 0;  ///< 0: any that is free
  std::string password;     ///< empty: none, and only the token lets in
  std::string page;         ///< the file of the page
  std::string token;        ///< that lets in; empty: a new one
};

class Server {
 public:
  /// Listens; throws Error when it cannot.
  Server(Studio&, ServerSettings);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// "http://127.0.0.1:7007/?token=…"
  std::string address() const;
  /// "7007 TOKEN": what a server needs to be found where this one was.
  std::string port_and_token() const;
  /// Serves until `stop`; before it returns, pages hear what they have been told, for a moment at most.
  void run();
  /// From any thread, or a signal handler's thread.
  void stop();

  struct Members;

 private:
  std::unique_ptr<Members> m;
};

/// A text that cannot be guessed: 128 bits of the system's randomness, in hexadecimal.
std::string random_token();
/// Whether two texts are equal, in a time that does not tell where they differ.
bool equal_in_constant_time(const std::string& a, const std::string& b);

}  // namespace etendue::studio
