#pragma once
// Conformance checks: tests that every implementation of an interface must pass. `etendue conform` runs them. The author of a
// new interface, also in a plugin, registers its checks with RegisterCheck.

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

/// The result of one check of one component.
enum class Result : std::uint8_t { passed, failed, not_tried };
struct Outcome {
  std::string class_name;
  std::string check;   ///< such as "samples follow the density"
  std::string part;    ///< the component as in a render description, so that it can be made again
  std::string detail;  ///< for a failure the actual and the expected value; for a check that was not tried the reason
  Result result = Result::passed;
};

/// The context of testing one component: the prepared component, random numbers, and the list of outcomes. Checks are
/// identified by name; a check that fails several times for one component is reported once, with its first failure.
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
  /// Whether all members that are not required have their default values.
  bool by_default() const { return by_default_; }
  /// The number of samples to take, if the standard effort (that of CI) takes `standard`.
  int samples(int standard) const {
    return effort_ == Effort::quick ? std::max(1, standard / 4) : effort_ == Effort::thorough ? 10 * standard : standard;
  }
  /// The significance level: the probability that one statistical test of a correct component fails. There are tens of
  /// thousands of tests in a run, with fixed seeds: together they fail with a probability of about one in a hundred.
  static constexpr double significance = 1e-7;
  /// The same as a number of standard errors, two-sided.
  static constexpr double significant_errors = 5.33;

  /// Records whether a check holds; `detail` is called only if it does not. Returns `holds`.
  bool expect(bool holds, const std::string& check, const std::function<std::string()>& detail = {});
  /// Records that a check could not be made.
  void not_tried(const std::string& check, const std::string& why);

  /// A temporary folder for this trial, created at the first call and deleted with its content at the end of the run.
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

/// A node in the linked list of all checks; it is removed from the list when its library is unloaded.
struct CheckNode {
  const std::type_info& interface;
  void (*check)(Trial&);
  CheckNode* next;
};
void enlist(CheckNode&) noexcept;
void delist(CheckNode&) noexcept;

/// `static const RegisterCheck<Shader> registered(check_shader);` lets check_shader be called for every shader; an interface
/// may have several checks. The constructor only links a node into a list.
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
