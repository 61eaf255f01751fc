#include "access.h"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "etendue/core/error.h"
#include "server.h"

namespace etendue::studio {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  std::ifstream source("/dev/urandom", std::ios::binary);
  if (!source.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) throw Error("the system gives no random numbers");
  std::string text;
  for (const unsigned char b : bytes) {
    text += "0123456789abcdef"[b >> 4];
    text += "0123456789abcdef"[b & 15];
  }
  return text;
}

bool equal_in_constant_time(const std::string& a, const std::string& b) {
  // The length is not secret.
  if (a.size() != b.size()) return false;
  unsigned char differs = 0;
  for (size_t i = 0; i < a.size(); ++i) differs |= static_cast<unsigned char>(a[i] ^ b[i]);
  return differs == 0;
}

std::string path_of(std::string_view target) { return std::string(target.substr(0, target.find('?'))); }

std::string query_value(std::string_view target, std::string_view key) {
  size_t at = target.find('?');
  while (at != std::string_view::npos) {
    const size_t next = target.find('&', at + 1);
    const std::string_view pair = target.substr(at + 1, next == std::string_view::npos ? next : next - at - 1);
    if (pair.starts_with(key) && pair.size() > key.size() && pair[key.size()] == '=')
      return std::string(pair.substr(key.size() + 1));
    at = next;
  }
  return {};
}

std::string cookie_value(std::string_view cookies, std::string_view key) {
  while (!cookies.empty()) {
    const size_t end = cookies.find(';');
    std::string_view pair = cookies.substr(0, end);
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    if (pair.starts_with(key) && pair.size() > key.size() && pair[key.size()] == '=')
      return std::string(pair.substr(key.size() + 1));
    if (end == std::string_view::npos) break;
    cookies.remove_prefix(end + 1);
  }
  return {};
}

bool own_host(std::string_view host, unsigned short port, bool loopback_only) {
  const std::string ending = ":" + std::to_string(port);
  std::string name(host);
  if (name.ends_with(ending))
    name.resize(name.size() - ending.size());
  else if (port != 80)
    return false;
  if (name == "localhost" || name == "127.0.0.1" || name == "[::1]") return true;
  if (loopback_only) return false;
  std::array<unsigned char, 16> number{};
  if (inet_pton(AF_INET, name.c_str(), number.data()) == 1) return true;
  if (name.size() > 2 && name.front() == '[' && name.back() == ']' &&
      inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), number.data()) == 1)
    return true;
  std::array<char, 256> own{};
  return gethostname(own.data(), own.size() - 1) == 0 && name == own.data();
}

bool own_origin(std::string_view origin, std::string_view host) { return origin == "http://" + std::string(host); }

}  // namespace etendue::studio
