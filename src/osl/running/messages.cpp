#include "messages.h"

#include <fmt/format.h>

#include <cstring>

#include "places.h"

namespace etendue::osl {

Messages::Message* Messages::find(const String* name) {
  for (Message& message : messages_)
    if (message.name == name) return &message;
  return nullptr;
}

bool Messages::set(const String* name, const Type& type, bool derivatives, const void* value, int layer, Location at,
                   std::string& fault) {
  if (const Message* old = find(name)) {
    if (old->type.is_void())
      fault = fmt::format(
          "message \"{}\" was queried before being set (queried here: {}) setting it now ({}) would lead to "
          "inconsistent results",
          name->text(), place_text(old->at), place_text(at));
    else
      fault = fmt::format("message \"{}\" already exists (created here: {}) cannot set again from {}", name->text(),
                          place_text(old->at), place_text(at));
    return false;
  }
  const auto* bytes = static_cast<const std::byte*>(value);
  messages_.push_back({name, type, derivatives, layer, at, {bytes, bytes + type.size() * (derivatives ? 3 : 1)}});
  return true;
}

bool Messages::get(const String* name, const Type& type, bool derivatives, void* out, int layer, Location at,
                   std::string& fault) {
  const Message* message = find(name);
  if (!message) {
    messages_.push_back({name, Type(), false, layer, at, {}});
    return false;
  }
  if (message->type.is_void()) return false;
  if (message->type != type) {
    fault = fmt::format("type mismatch for message \"{}\" (created as {} here: {}) cannot fetch as {} from {}", name->text(),
                        message->type.name(), place_text(message->at), type.name(), place_text(at));
    return false;
  }
  if (message->layer > layer) {
    fault = fmt::format(
        "message \"{}\" was set by layer #{} ({}) but is being queried by layer #{} ({}): messages pass from "
        "earlier layers to later ones only",
        name->text(), message->layer, place_text(message->at), layer, place_text(at));
    return false;
  }
  const std::size_t size = type.size();
  if (derivatives && !message->derivatives) {
    std::memcpy(out, message->value.data(), size);
    std::memset(static_cast<std::byte*>(out) + size, 0, 2 * size);
  } else {
    std::memcpy(out, message->value.data(), size * (derivatives ? 3 : 1));
  }
  return true;
}

}  // namespace etendue::osl
