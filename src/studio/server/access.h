#pragma once
// Access control: authentication data in requests, and their checks.

#include <string>
#include <string_view>

namespace etendue::studio {

/// The path of a request target, without the query after '?'.
std::string path_of(std::string_view target);
/// A value in the query, such as "token" in "/?token=x"; empty if it is missing.
std::string query_value(std::string_view target, std::string_view key);
/// A value of a Cookie header.
std::string cookie_value(std::string_view cookies, std::string_view key);
/// Whether a Host header names this server. This prevents DNS rebinding: a foreign page could let its own host name resolve to
/// this machine and would then be of the same origin. Numeric addresses, localhost and this machine's name cannot be claimed by
/// others.
bool own_host(std::string_view host, unsigned short port, bool loopback_only);
/// Whether an Origin header, which browsers send, belongs to a page of this server.
bool own_origin(std::string_view origin, std::string_view host);

}  // namespace etendue::studio
