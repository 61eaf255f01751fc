#pragma once
// Compilation: a group on its way to machine code. One thread of the process compiles, in the order in which groups ask, while
// they are still interpreted: a render does not wait for it.

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "machine.h"

namespace etendue::osl {

class Compilation {
 public:
  /// `make` compiles; it is called once at most, and may throw Error.
  explicit Compilation(std::function<std::unique_ptr<GroupCode>()> make) : make_(std::move(make)) {}
  /// Waits if the code is being made.
  ~Compilation();

  /// The code of each layer, or null until there is some.
  const LayerCode* code() const { return code_.load(std::memory_order_acquire); }
  /// Asks for the code; only the first call does.
  void begin();
  /// Makes the code if there is none, and waits for it. Throws Error if there cannot be any.
  void finish();

 private:
  friend class CompilingThread;
  void make() noexcept;

  enum class State { none, waiting, running, done };  // guarded by the thread's lock
  std::atomic<bool> asked_ = false;
  std::function<std::unique_ptr<GroupCode>()> make_;
  State state_ = State::none;
  std::unique_ptr<GroupCode> made_;
  std::string fault_;
  std::atomic<const LayerCode*> code_ = nullptr;
};

}  // namespace etendue::osl
