#pragma once
// Checks of what must hold of every part of an interface. Whoever defines an interface, in a plugin too, says here how its
// parts are tested; `etendue conform` does it.

#include <functional>
#include <map>
#include <random>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "etendue/core/math.h"
#include "etendue/core/vector.h"
#include "etendue/describe/component.h"
#include "etendue/describe/registry.h"

namespace etendue::conform {

class Fixtures;

enum class Effort { quick, standard, thorough };  ///< a quarter of the samples, CI's setting, ten times the samples

/// What became of one check of one part.
enum class Result : std::uint8_t { passed, failed, not_tried };
struct Outcome {
  std::string class_name;
  std::string check;   ///< such as "samples follow the density"
  std::string part;    ///< the part as in a render description, so that it can be made again
  std::string detail;  ///< of a failure: what was found and what was expected; of what was not tried: why
  Result result = Result::passed;
};

/// A part on trial: the part, prepared, random numbers, and where outcomes go. Checks are told apart by name; of one
/// part a check that fails several times is reported once, with its first failure.
class Trial {
 public:
  Trial(Component& part, std::string text, bool by_default, const Fixtures& fixtures, Effort effort, std::uint64_t seed)
      : random(seed),
        part_(&part),
        text_(std::move(text)),
        class_name_(part.class_info().name),
        fixtures_(&fixtures),
        effort_(effort),
        by_default_(by_default) {}

  template <class T = Component>
  T& part() const {
    return static_cast<T&>(*part_);
  }
  const std::string& text() const { return text_; }
  const Fixtures& fixtures() const { return *fixtures_; }
  Effort effort() const { return effort_; }
  /// Whether all members that need not be written have their defaults.
  bool by_default() const { return by_default_; }
  /// How many samples to take where CI's setting takes `standard`.
  int samples(int standard) const {
    return effort_ == Effort::quick ? std::max(1, standard / 4) : effort_ == Effort::thorough ? 10 * standard : standard;
  }
  /// The chance by which one statistical test of a right part may fail. There are tens of thousands of tests in a run, with
  /// fixed seeds: together they have a chance of about one in a hundred.
  static constexpr double significance = 1e-7;
  /// As many standard errors, two-sided.
  static constexpr double significant_errors = 5.33;

  /// Says whether a check holds; `detail` is only asked when it is needed. Returns `holds`.
  bool expect(bool holds, const std::string& check, const std::function<std::string()>& detail = {});
  /// Says that a check could not be made.
  void not_tried(const std::string& check, const std::string& why);

  /// A folder for files of this trial alone, made when first asked for and removed with what is in it at the end of the run.
  std::string folder() const;

  /// Uniform in [0, 1).
  float uniform() { return to_unit_float(std::uint32_t(random() >> 32)); }
  Point2 pair() {
    const float x = uniform();
    return {x, uniform()};
  }
  /// A unit vector, uniform over the sphere.
  Vector3 direction() {
    const float z = 1 - 2 * uniform(), phi = 2 * pi * uniform(), r = safe_sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  std::mt19937_64 random;

  const std::vector<Outcome>& outcomes() const { return outcomes_; }

 private:
  Outcome& outcome(const std::string& check);

  Component* part_;
  std::string text_, class_name_;
  mutable std::string folder_;
  const Fixtures* fixtures_;
  Effort effort_;
  bool by_default_;
  std::vector<Outcome> outcomes_;
  std::map<std::string, size_t> places_;
};

/// A check in the list of all; it leaves the list when its library is closed.
struct CheckNode {
  const std::type_info& interface;
  void (*check)(Trial&);
  CheckNode* next;
};
void enlist(CheckNode&) noexcept;
void delist(CheckNode&) noexcept;

/// `static const RegisterCheck<Shader> registered(check_shader);` has every shader tried by check_shader; an interface may have
/// several checks. It only links a node into a list.
template <class Interface>
class RegisterCheck {
 public:
  explicit RegisterCheck(void (*check)(Trial&)) noexcept : node_{typeid(Interface), check, nullptr} { enlist(node_); }
  ~RegisterCheck() { delist(node_); }
  RegisterCheck(const RegisterCheck&) = delete;
  RegisterCheck& operator=(const RegisterCheck&) = delete;

 private:
  CheckNode node_;
};

}  // namespace etendue::conform
