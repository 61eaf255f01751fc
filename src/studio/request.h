#pragma once
// Requests: what a browser asks of a studio (docs/studio-protocol.md). src/studio/requests answers them.

#include <initializer_list>

#include "studio.h"

namespace etendue::studio {

/// An error with a code, to which a page may react.
class RequestError : public Error {
 public:
  RequestError(std::string c, const std::string& message) : Error(message), code(std::move(c)) {}
  std::string code;
};

/// The arguments of a request that is being answered.
struct Call {
  Studio& studio;
  Browser& browser;
  const Json& request;
  Json id;

  bool has(const char* key) const { return request.contains(key) && !request[key].is_null(); }
  // Each function throws RequestError if the argument is missing or of the wrong type.
  std::string text(const char* key) const;
  std::string text_or(const char* key, const std::string& otherwise) const;
  bool flag(const char* key) const;
  std::int64_t integer(const char* key, std::int64_t low, std::int64_t high) const;
  std::int64_t integer_or(const char* key, std::int64_t otherwise, std::int64_t low, std::int64_t high) const;
  double number(const char* key) const;
  double number_or(const char* key, double otherwise) const;
  std::optional<size_t> index(const char* key = "index") const;
  /// The render that the argument 'render' names; by default the document's own.
  int render_number() const;
  std::shared_ptr<Render> render() const { return studio.render_of(render_number()); }
  Ref<Component> component(const char* key = "component") const;
};

struct Request {
  const char* name;
  bool read_only;  ///< allowed when nothing may be changed
  Json (*answer)(const Call&);
};

/// How much of what a browser sent is repeated in a reply [bytes].
constexpr size_t largest_echo = 200;

/// Adds requests to those that a studio answers, at the start of the program. A file that answers requests has one of these.
struct RegisterRequests {
  RegisterRequests(std::initializer_list<Request>);
};

/// The request with this name. Throws RequestError with a suggestion if there is none.
const Request& request_named(const std::string& name);

/// The class that an argument names. Throws Error with a suggestion if there is none.
const ClassInfo& class_named(const std::string& name);

}  // namespace etendue::studio
