#pragma once
// Conformance: what must hold of every part of an interface, tested for all classes that the registry knows, plugins
// included, with default and with randomly drawn valid members.

#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

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
  const Fixtures* fixtures_;
  Effort effort_;
  bool by_default_;
  std::vector<Outcome> outcomes_;
  std::map<std::string, size_t> places_;
};

/// The checks of an interface, run on each part of it; each in a file of its own (check_shader.cpp, ...). Which class gets
/// which is said in conformance.cpp.
void check_component(Trial&);  ///< of every part
void check_shader(Trial&);
void check_volume(Trial&);
void check_camera(Trial&);
void check_filter(Trial&);
void check_sampler(Trial&);
void check_emission(Trial&);
void check_object_map(Trial&);
void check_scene_object(Trial&);
void check_light_sampler(Trial&);
void check_renderer(Trial&);
void check_tone_map(Trial&);

struct Options {
  std::vector<std::string> classes;  ///< names of classes or interfaces; empty: all
  Effort effort = Effort::standard;
  int drawn = 3;  ///< how many parts with random members, beside the one with defaults
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  /// Told after each part, from any thread, one at a time.
  std::function<void(const std::string& class_name, int done, int of)> progress = {};
};

/// Runs all checks of the classes asked for; the outcomes depend on the options but for the threads, and on nothing else. A
/// part that cannot be made or throws is an outcome too. Throws Error for a class that is unknown.
std::vector<Outcome> conform(const Options&);

/// The interfaces that have checks of their own.
std::vector<std::string> checked_interfaces();

/// A page that shows outcomes: classes, checks, failures with the parts that failed.
std::string html_report(const std::vector<Outcome>&, const std::string& command_line);

}  // namespace etendue::conform
