#pragma once
// Messages: values that layers of a group leave for later layers by name (setmessage, getmessage).

#include <string>
#include <vector>

#include "etendue/core/error.h"
#include "osl/values/interned_string.h"
#include "osl/values/type.h"

namespace etendue::osl {

/// The messages of one run. A message that was looked for in vain may not be set afterwards: what a shader sees must not depend
/// on the order in which the lazy evaluation of layers happens to run.
class Messages {
 public:
  void clear() { messages_.clear(); }

  /// Both return false and set `fault` if the message contradicts what was done before.
  bool set(const String* name, const Type&, bool derivatives, const void* value, int layer, Location, std::string& fault);
  /// False without a fault: there is no such message.
  bool get(const String* name, const Type&, bool derivatives, void* out, int layer, Location, std::string& fault);

 private:
  struct Message {
    const String* name;
    Type type;  // void: it was looked for, but not there
    bool derivatives;
    int layer;
    Location at;
    std::vector<std::byte> value;
  };
  Message* find(const String*);
  std::vector<Message> messages_;
};

}  // namespace etendue::osl
