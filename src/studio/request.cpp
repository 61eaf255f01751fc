// The arguments of requests, with checks, and the table of all requests.

#include "request.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue::studio {

namespace {

const Json& argument(const Call& call, const char* key) {
  if (!call.has(key)) throw RequestError("bad_request", fmt::format("'{}' is missing", key));
  return call.request[key];
}

[[noreturn]] void wrong(const char* key, const char* wanted) {
  throw RequestError("bad_request", fmt::format("'{}' must be {}", key, wanted));
}

}  // namespace

std::string Call::text(const char* key) const {
  const Json& value = argument(*this, key);
  if (!value.is_string()) wrong(key, "a text");
  return value.get<std::string>();
}

std::string Call::text_or(const char* key, const std::string& otherwise) const { return has(key) ? text(key) : otherwise; }

bool Call::flag(const char* key) const {
  if (!has(key)) return false;
  if (!request[key].is_boolean()) wrong(key, "true or false");
  return request[key].get<bool>();
}

std::int64_t Call::integer(const char* key, std::int64_t low, std::int64_t high) const {
  const Json& value = argument(*this, key);
  double x = value.is_number() ? value.get<double>() : std::nan("");
  if (!(x == std::floor(x)) || x < double(low) || x > double(high))
    throw RequestError("bad_request", fmt::format("'{}' must be a whole number from {} to {}", key, low, high));
  return std::int64_t(x);
}

std::int64_t Call::integer_or(const char* key, std::int64_t otherwise, std::int64_t low, std::int64_t high) const {
  return has(key) ? integer(key, low, high) : otherwise;
}

double Call::number(const char* key) const {
  const Json& value = argument(*this, key);
  if (!value.is_number() || !std::isfinite(value.get<double>())) wrong(key, "a finite number");
  return value.get<double>();
}

double Call::number_or(const char* key, double otherwise) const { return has(key) ? number(key) : otherwise; }

int Call::render_number() const { return int(integer_or("render", 0, 0, 2'000'000'000)); }

std::optional<size_t> Call::index(const char* key) const {
  if (!has(key)) return {};
  return size_t(integer(key, 0, 1'000'000'000));
}

Ref<Component> Call::component(const char* key) const {
  static_cast<void>(studio.valid_render());
  return studio.document().component(int(integer(key, 0, 2'000'000'000)));
}

const ClassInfo& class_named(const std::string& name) {
  const ClassInfo* info = Registry::instance().find(name);
  if (!info) static_cast<void>(Registry::instance().create(name));  // throws Error with a suggestion
  return *info;
}

// ---- the table of all requests ----------------------------------------------------------------------------------------------

namespace {

std::map<std::string, Request, std::less<>>& table() {
  static std::map<std::string, Request, std::less<>> all;
  return all;
}

}  // namespace

RegisterRequests::RegisterRequests(std::initializer_list<Request> requests) {
  for (const Request& request : requests) table().emplace(request.name, request);
}

const Request& request_named(const std::string& name) {
  const auto found = table().find(name);
  if (found != table().end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, request] : table()) known.push_back(key);
  throw RequestError("unknown_request",
                     fmt::format("there is no request '{}'{}", name.substr(0, largest_echo), suggestion(name, known)));
}

}  // namespace etendue::studio
