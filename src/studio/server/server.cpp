// Server: authentication, the page, and the upgrade to its WebSocket.

#include "server.h"

#include <fmt/format.h>

#include "access.h"
#include "connection.h"
#include "files/regular_file.h"

namespace etendue::studio {

namespace {

constexpr auto after_wrong_password = std::chrono::seconds(1);

constexpr const char* login_form = R"(<!doctype html><html lang="en"><meta charset="utf-8"><title>Étendue</title>
<style>body{font:16px sans-serif;display:grid;place-items:center;height:90vh;color-scheme:light dark}</style>
<form method="post" action="/login"><label>Password <input type="password" name="password" autofocus></label> <button>Enter</button></form>)";

/// A value of a submitted form.
std::string form_value(const std::string& body, const std::string& key) {
  const std::string coded = query_value("?" + body, key);
  std::string text;
  for (size_t i = 0; i < coded.size(); ++i) {
    if (coded[i] == '%' && i + 2 < coded.size()) {
      text += char(std::strtol(coded.substr(i + 1, 2).c_str(), nullptr, 16));
      i += 2;
    } else {
      text += coded[i] == '+' ? ' ' : coded[i];
    }
  }
  return text;
}

}  // namespace

// ---- access control ---------------------------------------------------------------------------------------------------------

bool Server::Members::knows(const http::request<http::string_body>& request) const {
  if (equal_in_constant_time(query_value({request.target().data(), request.target().size()}, "token"), token)) return true;
  const auto cookie = request[http::field::cookie];
  return !settings.password.empty() &&
         equal_in_constant_time(cookie_value({cookie.data(), cookie.size()}, "etendue_session"), session);
}

http::response<http::string_body> Server::Members::answer(const http::request<http::string_body>& request) {
  http::response<http::string_body> response(http::status::ok, request.version());
  const std::string host(request[http::field::host]);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("X-Frame-Options", "DENY");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(false);
  const auto refuse = [&](http::status status, const char* text) {
    response.result(status);
    response.body() = text;
  };
  const std::string path = path_of({request.target().data(), request.target().size()});
  const auto origin = request[http::field::origin];
  if (!own_host(host, port, loopback)) {
    refuse(http::status::misdirected_request, "This server goes by another name.\n");
  } else if (!origin.empty() && !own_origin({origin.data(), origin.size()}, host)) {
    refuse(http::status::forbidden, "Pages from elsewhere may not ask here.\n");
  } else if (path == "/login" && !settings.password.empty() && request.method() == http::verb::post) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_login) {
      refuse(http::status::too_many_requests, "Wait a second.\n");
    } else if (equal_in_constant_time(form_value(request.body(), "password"), settings.password)) {
      response.result(http::status::see_other);
      response.set(http::field::location, "/");
      response.set(http::field::set_cookie, "etendue_session=" + session + "; HttpOnly; SameSite=Strict; Path=/");
    } else {
      next_login = now + after_wrong_password;
      refuse(http::status::forbidden, "This is not the password.\n");
    }
  } else if (request.method() != http::verb::get) {
    refuse(http::status::method_not_allowed, "Only GET.\n");
  } else if (!knows(request)) {
    refuse(http::status::forbidden, "The token is missing or wrong: use the whole address that `etendue studio` printed.\n");
    if (!settings.password.empty() && path == "/") {
      response.set(http::field::content_type, "text/html; charset=utf-8");
      response.set("Content-Security-Policy", "default-src 'none'; style-src 'unsafe-inline'; form-action 'self'");
      response.body() = login_form;
    }
  } else if (path == "/") {
    response.set(http::field::content_type, "text/html; charset=utf-8");
    response.set(
        "Content-Security-Policy",
        fmt::format("default-src 'none'; script-src 'unsafe-inline' blob:; style-src 'unsafe-inline'; img-src data: blob:; "
                    "font-src data:; connect-src 'self' ws://{}; worker-src blob:; base-uri 'none'; form-action 'none'",
                    host));
    try {
      response.body() = read_regular_file(settings.page);
    } catch (const Error& error) {
      refuse(http::status::service_unavailable, "The page is not built: start the studio with ./etendue studio.\n");
    }
  } else if (path.starts_with("/manual/") && path.ends_with(".md")) {
    response.body() = Studio::manual_page(path.substr(8, path.size() - 11));
    if (response.body().empty()) refuse(http::status::not_found, "There is no such class.\n");
  } else {
    refuse(http::status::not_found, "There is nothing here.\n");
  }
  return response;
}

// ---- connections ------------------------------------------------------------------------------------------------------------

void Server::Members::accept() {
  acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted || ending) return;
    if (!error) {
      visitors.remove_if([](const auto& v) { return v.expired(); });
      if (visitors.size() >= limits::visitors) {  // the oldest connection without a complete request is closed
        if (const auto oldest = visitors.front().lock()) oldest->close();
        visitors.pop_front();
      }
      beast::error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      // A small send buffer: data that wait in it are shown late.
      socket.set_option(asio::socket_base::send_buffer_size(1 << 20), ignored);
      const auto visitor = std::make_shared<Visitor>(std::move(socket), *this);
      visitors.push_back(visitor);
      visitor->read();
      return accept();
    }
    // Perhaps the process has run out of file descriptors: retries after a delay.
    auto timer = std::make_shared<asio::steady_timer>(context, std::chrono::milliseconds(100));
    timer->async_wait([this, timer](beast::error_code stopped) {
      if (!stopped && !ending) accept();
    });
  });
}

void Server::Members::end() {
  if (std::exchange(ending, true)) return;
  beast::error_code ignored;
  acceptor.close(ignored);
  for (const auto& v : visitors)
    if (const auto visitor = v.lock()) visitor->close();
  // Pages that do not receive their messages in time are disconnected.
  farewell.expires_after(limits::farewell);
  farewell.async_wait([this](beast::error_code) { context.stop(); });
  const auto all = pages;  // `finish` may remove an element
  for (const auto& page : all) page->finish();
  if (pages.empty()) farewell.cancel();
}

void Visitor::read() {
  parser_.emplace();
  parser_->header_limit(limits::header);
  parser_->body_limit(limits::body);
  stream_.expires_after(limits::patience);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](beast::error_code error, size_t) { self->have(error); });
}

void Visitor::close() { stream_.close(); }

void Visitor::have(beast::error_code error) {
  if (error || server_.ending) return close();
  http::request<http::string_body> request = parser_->release();
  auto response = std::make_shared<http::response<http::string_body>>();
  try {
    *response = server_.answer(request);
    const bool socket =
        beast::websocket::is_upgrade(request) && path_of({request.target().data(), request.target().size()}) == "/socket";
    // `answer` returns "not found" for this path if all other checks have passed.
    if (socket && response->result() == http::status::not_found) {
      if (server_.pages.size() < limits::pages) {
        std::make_shared<Page>(std::move(stream_), server_)->begin(std::move(request));
        return;
      }
      response->result(http::status::service_unavailable);
      response->body() = "Too many pages are open.\n";
    }
  } catch (const std::exception&) {
    response->result(http::status::internal_server_error);
    response->keep_alive(false);
  }
  response->prepare_payload();
  http::async_write(stream_, *response, [self = shared_from_this(), response](beast::error_code, size_t) {
    beast::error_code ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

// ---- the server -------------------------------------------------------------------------------------------------------------

Server::Server(Studio& studio, ServerSettings settings) : m(std::make_unique<Members>(studio, std::move(settings))) {
  try {
    const asio::ip::address address = asio::ip::make_address(m->settings.address);
    m->loopback = address.is_loopback();
    const tcp::endpoint endpoint(address, m->settings.port);
    m->acceptor.open(endpoint.protocol());
    m->acceptor.set_option(asio::socket_base::reuse_address(true));
    m->acceptor.bind(endpoint);
    m->acceptor.listen();
    m->port = m->acceptor.local_endpoint().port();
  } catch (const boost::system::system_error& error) {
    throw Error(fmt::format("cannot listen at {} port {}: {}", m->settings.address, m->settings.port, error.code().message()));
  }
  if (!m->loopback && m->settings.password.empty()) throw Error("others are let in with a password only");
}

Server::~Server() = default;

std::string Server::address() const {
  const asio::ip::address address = m->acceptor.local_endpoint().address();
  std::string host = address.to_string();
  if (address.is_unspecified()) host = address.is_v6() ? "::1" : "127.0.0.1";
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return fmt::format("http://{}:{}/?token={}", host, m->port, m->token);
}

std::string Server::port_and_token() const { return fmt::format("{} {}", m->port, m->token); }

void Server::run() {
  m->accept();
  while (true) {
    try {
      m->context.run();
      break;
    } catch (const std::exception&) {  // an error of one connection does not end the server
    }
  }
  while (!m->pages.empty()) {
    const std::shared_ptr<Page> page = *m->pages.begin();
    m->studio.leave(*page);
    page->end();
    m->pages.erase(page);
  }
}

void Server::stop() {
  asio::post(m->context, [members = m.get()] { members->end(); });
}

}  // namespace etendue::studio
