#pragma once
// Letter: a message of a ProcessTeam: its kind, and packed values.

#include <string>

#include "etendue/core/packing.h"
#include "messages.h"

namespace etendue {

enum class LetterKind : std::uint8_t {
  hello,     ///< of each follower, first of all: who it is
  render,    ///< of the leader: prepare this render
  prepared,  ///< of a follower: it is ready
  step,      ///< of the leader: take this step
  drop,      ///< of the leader: abort the step
  finished,  ///< of a follower: the step is finished
  failed,    ///< of a follower: the step or the preparation failed
  warning,   ///< of a follower: for the user
  rendered,  ///< of the leader: the render has ended
  over,      ///< of the leader: there are no more renders
  want,      ///< of a follower, within a step: more items
  deal,      ///< of the leader: these items
  item,      ///< of anybody: the results of an item
  scene,     ///< of anybody, before `prepared`: about the scene's files (scene_transfer.h)
};

/// Writes a letter.
class Writing {
 public:
  explicit Writing(LetterKind kind) { add(kind); }
  template <class T>
  Writing& add(const T& value) {
    Packing::pack(bytes_, value);
    return *this;
  }
  Writing& add(const std::string& text) { return add(std::vector<char>(text.begin(), text.end())); }
  std::vector<std::byte>& bytes() { return bytes_; }
  Parcel parcel() { return std::make_shared<const std::vector<std::byte>>(std::move(bytes_)); }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads a letter, and owns its bytes. Throws Error if it ends early.
class Reading {
 public:
  Reading(int from_, std::vector<std::byte> bytes) : from(from_), bytes_(std::move(bytes)), rest(bytes_) {
    Packing::unpack(rest, kind);
  }
  Reading(Reading&&) = default;  // a vector that is moved keeps its memory
  Reading& operator=(Reading&&) = default;
  Reading(const Reading&) = delete;

  template <class T>
  T take() {
    T value{};
    Packing::unpack(rest, value);
    return value;
  }
  std::string take_text() {
    const auto text = take<std::vector<char>>();
    return {text.begin(), text.end()};
  }

  int from = 0;
  LetterKind kind{};

 private:
  std::vector<std::byte> bytes_;

 public:
  std::span<const std::byte> rest;  ///< what is not yet read
};

}  // namespace etendue
