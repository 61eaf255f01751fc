#pragma once
// Connections to browsers.

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <deque>
#include <list>
#include <map>
#include <set>

#include "server.h"

namespace etendue::studio {

namespace beast = boost::beast;
namespace http = beast::http;
namespace asio = boost::asio;
using tcp = asio::ip::tcp;

class Visitor;
class Page;

/// The state that connections share. Used only by the server's thread, except where noted.
struct Server::Members {
  Members(Studio& s, ServerSettings wanted) : studio(s), settings(std::move(wanted)) {}

  Studio& studio;
  const ServerSettings settings;
  const std::string token = settings.token.empty() ? random_token() : settings.token, session = random_token();
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  unsigned short port = 0;
  bool loopback = true;
  std::list<std::weak_ptr<Visitor>> visitors;  ///< without a token so far, or only fetching the page; oldest first
  std::set<std::shared_ptr<Page>> pages;
  std::chrono::steady_clock::time_point next_login{};
  bool ending = false;
  asio::steady_timer farewell{context};  ///< limits the time for sending the remaining messages to pages at the end

  void end();
  void accept();
  bool knows(const http::request<http::string_body>&) const;
  http::response<http::string_body> answer(const http::request<http::string_body>&);
};

/// Limits for unauthenticated clients and for browsers.
namespace limits {
inline constexpr size_t visitors = 64, pages = 32;
inline constexpr auto patience = std::chrono::seconds(10);  ///< time until a request must arrive
inline constexpr size_t header = 8 << 10, body = 4 << 10;   ///< [bytes]
inline constexpr size_t message = 32 << 20;                 ///< of a message from a page: a text may be large [bytes]
inline constexpr size_t unsent = 64 << 20;                  ///< messages queued for a page that does not read them [bytes]
inline constexpr int unanswered = 64;                       ///< pending requests of a page
inline constexpr auto farewell = std::chrono::seconds(2);   ///< time for sending the remaining messages at the end
}  // namespace limits

/// A connection before it becomes a Page: one request at a time.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(tcp::socket socket, Server::Members& server) : stream_(std::move(socket)), server_(server) {}
  void read();
  void close();

 private:
  void have(beast::error_code);
  beast::tcp_stream stream_;
  Server::Members& server_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
};

/// The WebSocket of a page.
class Page : public Browser, public std::enable_shared_from_this<Page> {
 public:
  Page(beast::tcp_stream stream, Server::Members& server) : socket_(std::move(stream)), server_(server) {}
  void begin(http::request<http::string_body>);
  /// Closes the connection when all messages are sent.
  void finish();
  void end();

  // Called from the studio's threads.
  void send(std::shared_ptr<const std::string> words) override;
  void frame_ready() override;
  void answered() override;

 private:
  void read();
  void write();
  void lost();
  beast::websocket::stream<beast::tcp_stream> socket_;
  Server::Members& server_;
  beast::flat_buffer buffer_;
  std::deque<std::shared_ptr<const std::string>> words_;
  size_t unsent_ = 0;
  std::vector<std::uint8_t> pixels_;
  std::map<int, std::shared_ptr<const Frame>> shown_;  // the last frames that were sent, by slot
  int last_slot_ = 0;
  int unanswered_ = 0;
  bool writing_ = false, reading_ = false, lost_ = false, finishing_ = false, closing_ = false;
};

}  // namespace etendue::studio
