#pragma once
// Connections of browsers.

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

/// What connections share. Of the server's thread alone, but for what says otherwise.
struct Server::Members {
  Members(Studio& s, ServerSettings wanted) : studio(s), settings(std::move(wanted)) {}

  Studio& studio;
  const ServerSettings settings;
  const std::string token = settings.token.empty() ? random_token() : settings.token, session = random_token();
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  unsigned short port = 0;
  bool loopback = true;
  std::list<std::weak_ptr<Visitor>> visitors;  ///< who has not shown a token yet or only fetches the page, oldest first
  std::set<std::shared_ptr<Page>> pages;
  std::chrono::steady_clock::time_point next_login{};
  bool ending = false;
  asio::steady_timer farewell{context};  ///< runs while pages are told what they have not heard yet

  void end();
  void accept();
  bool knows(const http::request<http::string_body>&) const;
  http::response<http::string_body> answer(const http::request<http::string_body>&);
};

/// How much is taken from strangers and from browsers.
namespace limits {
inline constexpr size_t visitors = 64, pages = 32;
inline constexpr auto patience = std::chrono::seconds(10);  ///< until a request is there
inline constexpr size_t header = 8 << 10, body = 4 << 10;   ///< [bytes]
inline constexpr size_t message = 32 << 20;                 ///< of a page: a text may be large [bytes]
inline constexpr size_t unsent = 64 << 20;                  ///< words for a page that does not read them [bytes]
inline constexpr int unanswered = 64;                       ///< requests of a page
inline constexpr auto farewell = std::chrono::seconds(2);   ///< for what pages are still to hear at the end
}  // namespace limits

/// A connection before it is a page's: one request at a time.
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

/// A page's WebSocket.
class Page : public Browser, public std::enable_shared_from_this<Page> {
 public:
  Page(beast::tcp_stream stream, Server::Members& server) : socket_(std::move(stream)), server_(server) {}
  void begin(http::request<http::string_body>);
  /// Says goodbye when all words are sent.
  void finish();
  void end();

  // Of the studio's threads.
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
  std::map<int, std::shared_ptr<const Frame>> shown_;  // the frames that were sent last, by slots
  int last_slot_ = 0;
  int unanswered_ = 0;
  bool writing_ = false, reading_ = false, lost_ = false, finishing_ = false, closing_ = false;
};

}  // namespace etendue::studio
