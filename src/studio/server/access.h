#pragma once
// Who may come in: what a request says of itself, and whether that is good enough.

#include <string>
#include <string_view>

namespace etendue::studio {

/// The path of a request's target, without what follows a '?'.
std::string path_of(std::string_view target);
/// A value of what follows the '?', as "token" in "/?token=x"; empty when it is not there.
std::string query_value(std::string_view target, std::string_view key);
/// A value of a Cookie header.
std::string cookie_value(std::string_view cookies, std::string_view key);
/// Whether a Host header names this server: a page elsewhere could have its own name lead to this machine, and would then be of
/// the same origin. Addresses in numbers, localhost and this machine's name cannot be had by others.
bool own_host(std::string_view host, unsigned short port, bool loopback_only);
/// Whether an Origin header, which browsers send along, is of a page from this server.
bool own_origin(std::string_view origin, std::string_view host);

}  // namespace etendue::studio
