// Checks of every emission shader: its power is the integral of its radiance, and sampled directions follow the pdf.

#include <fmt/format.h>

#include <optional>

#include "conformance.h"
#include "etendue/describe/color.h"
#include "etendue/infinite_object.h"
#include "etendue/object_map.h"
#include "shader_trial.h"
#include "sphere_cells.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

/// Solid angles below this [sr] contain too few directions representable in floats for a chi-square test in cells.
constexpr double narrowest = 1e-7;

/// A prepared object of a class that has the emission, translated and rotated.
Ref<SceneObject> host_of(EmissionShader& emission, const std::string& name) {
  Ref<SceneObject> host = ref_cast<SceneObject>(Registry::instance().create(name));
  const Transform turn = Transform::rotate(0.8f, {1, 2, -0.5f});
  host->transform = host->infinite() ? turn : Transform::translate({0.3f, -0.2f, 0.5f}) * turn;
  host->emission = Ref<EmissionShader>(&emission);
  emission.prepare();  // as before every render: discards data of objects that are gone, whose address the new host may have
  host->prepare();
  if (const Ref<InfiniteObject> infinite = ref_cast<InfiniteObject>(host)) infinite->enclose({0.1f, 0.2f, 0.3f}, 1.5f);
  return host;
}

std::string text_of(const Vector3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

class EmissionTrial {
 public:
  EmissionTrial(Trial& t, EmissionShader& emission, const std::string& name)
      : trial(t),
        emission_(emission),
        host_(host_of(emission, name)),
        name_(name),
        wavelengths_(spread_wavelengths(lerp(t.uniform(), 400, 700))) {
    lowest_.fill(infinity);
  }

  /// Returns why the part refuses the object; empty: it does not.
  std::string check() {
    const std::string what = fmt::format("power is the integral of radiance, on a {}", name_);
    try {
      power_ = emission_.power(*host_, wavelengths_);
    } catch (const Error& error) {
      return error.what();
    }
    trial.expect(power_.finite() && power_.minimum() >= 0, "power is finite and not negative", [&] { return name_; });
    if (!host_->infinite()) {
      check_points();
      for (int i = 0; i < (name_ == "Sphere" ? 3 : 1); ++i) check_directions(host_->sample_area(trial.pair(), 0).point);
    }
    check_power(what);
    return {};
  }

 private:
  /// Checks radiance, and that sides that do not emit have zero radiance and pdf.
  void check_points() {
    for (int i = trial.samples(2000); i > 0; --i) {
      const SurfacePoint p = host_->sample_area(trial.pair(), 0).point;
      const Vector3 v = trial.direction();
      const Spectrum light = emission_.radiance(p, v, wavelengths_);
      const float pdf = emission_.pdf(p, v);
      const auto where = [&] {
        return fmt::format("on a {}, normal {}, direction {}: radiance {}, density {}", name_, text_of(Vector3(p.normal)),
                           text_of(v), light[0], pdf);
      };
      trial.expect(light.finite() && light.minimum() >= 0 && pdf >= 0 && pdf < infinity,
                   "radiance and densities are finite and not negative", where);
      trial.expect(emission_.emits(p, v) || (light.black() && pdf == 0), "sides that do not emit are dark", where);
    }
  }

  void check_directions(const SurfacePoint& p) {
    const Frame frame(p.normal == Normal3{} ? Normal3{0, 0, 1} : p.normal);
    check_samples(
        {.unit = "sampled directions are unit vectors",
         .same_pdf = "a sample's density is that of its direction",
         .follow_pdf = "sampled directions follow the density"},
        [&] { return emission_.sample(p, trial.pair()); }, [&](const Vector3& v) { return emission_.pdf(p, v); },
        [&](const Vector3& v) { return frame.to_local(v); }, [&](const Vector3& v) { return frame.to_world(v); });
  }

  /// The names of the checks of a way to sample directions.
  struct SampleChecks {
    const char *unit, *same_pdf, *follow_pdf;
  };
  /// Checks samples of directions against their pdf. They are counted in coordinates to which `to_local` turns directions, and
  /// from which `from_local` turns them back.
  template <class Sample, class Pdf, class ToLocal, class FromLocal>
  void check_samples(const SampleChecks& checks, const Sample& sample, const Pdf& pdf, const ToLocal& to_local,
                     const FromLocal& from_local) {
    Drawn drawn;
    const auto draw = [&](int count) {
      drawn = draw_directions(count, checks, sample, [&](const Vector3& v) { return Spectrum(pdf(v)); }, to_local);
      return drawn.list;
    };
    const std::vector<Vector3> first = draw(trial.samples(8000));
    if (first.size() < 200) return;
    compare(
        checks.follow_pdf, first, drawn.covered, [&](const Vector3& local) { return double(pdf(from_local(local))); },
        [&](int count) { return std::pair(draw(count), drawn.lost); });
  }

  struct Drawn {
    std::vector<Vector3> list;  ///< of the samples with a density
    long lost = 0;              ///< number of the others
    double covered = 0;         ///< the mean of 1 / density: the solid angle that is sampled [sr]
  };
  /// Draws directions and checks each; `turned` gives the coordinates of the list.
  template <class Sample, class Pdf, class Turn>
  Drawn draw_directions(int count, const SampleChecks& checks, const Sample& sample, const Pdf& pdf_at, const Turn& turned) {
    Drawn drawn;
    for (int i = 0; i < count; ++i) {
      const DirectionSample s = sample();
      trial.expect(s.pdf >= 0 && s.pdf < infinity && (s.pdf == 0 || std::abs(length(s.direction) - 1) < 1e-4f), checks.unit,
                   [&] { return fmt::format("{}, density {}", text_of(s.direction), s.pdf); });
      if (!(s.pdf > 0)) {
        ++drawn.lost;
        continue;
      }
      drawn.covered += 1 / double(s.pdf) / count;
      trial.expect(agree(Spectrum(s.pdf), pdf_at(s.direction), 2e-3f, true, [&] { return rounding_of(pdf_at, s.direction); }),
                   checks.same_pdf, [&] {
                     return fmt::format("on a {} towards {}: {} and {}", name_, text_of(s.direction), s.pdf,
                                        pdf_at(s.direction)[0]);
                   });
      drawn.list.push_back(turned(s.direction));
    }
    return drawn;
  }

  /// Samples may be lost (sent to a side that does not emit): their fraction is what the pdf's integral lacks to 1.
  template <class F, class D>
  void compare(const std::string& check, const std::vector<Vector3>& first, double covered, const F& pdf, const D& draw) {
    if (covered < narrowest) {
      trial.not_tried(check, fmt::format("all within {:.2g} sr, which floats do not resolve", covered));
      return;
    }
    const SphereCells cells(first, 96);
    const auto [drawn, lost] = draw(trial.samples(32000));
    const double n = double(drawn.size()) + double(lost), kept = double(drawn.size()) / n;
    std::vector<double> counts(cells.size());
    for (const Vector3& v : drawn) ++counts[cells.cell_of(v)];
    if (lost > 0) counts.push_back(double(lost));
    double sum = 0, p_value = 0;
    const double error = std::sqrt(kept * (1 - kept) / n);
    const auto integrates = [&] {
      return std::abs(sum - kept) < 3e-3 + Trial::significant_errors * error + (lost > 0 ? 10 / n : 0);
    };
    // A pdf with sharp edges may need more quadrature points than most.
    for (double tolerance = 1e-3; tolerance > 1e-5 && !(p_value > Trial::significance && integrates()); tolerance /= 10) {
      std::vector<double> expected;
      sum = 0;
      for (const auto& [share] : cells.integrate<1>([&](const Vector3& v) -> std::array<double, 1> { return {pdf(v)}; },
                                                    tolerance, long(1e3 / tolerance))) {
        sum += share;
        expected.push_back(share * n);
      }
      if (lost > 0) expected.push_back(std::max(0.0, 1 - sum) * n);
      p_value = statistics::chi_square(counts, expected, 10, 1e-3 * n);
    }
    trial.expect(integrates(), "the density integrates to 1, or to what is not lost",
                 [&] { return fmt::format("on a {}: {:.5f}, and {:.5f} of the samples have a density", name_, sum, kept); });
    trial.expect(p_value > Trial::significance, check,
                 [&] { return fmt::format("on a {}: p = {:.2g} in {} cells", name_, p_value, cells.size()); });
  }

 public:
  /// For emissions that sample incident directions (environments): the check is done in object space, whose y axis is up.
  void check_incident() {
    const auto up = [](const Vector3& v) { return Vector3{v.z, v.x, v.y}; };
    const auto down = [](const Vector3& v) { return Vector3{v.y, v.z, v.x}; };
    check_samples(
        {.unit = "sampled incident directions are unit vectors",
         .same_pdf = "an incident sample's density is that of its direction",
         .follow_pdf = "sampled incident directions follow the density"},
        [&] { return emission_.sample_incident(trial.pair()); }, [&](const Vector3& v) { return emission_.incident_pdf(v); },
        up, down);
  }

 private:
  /// One sample of the power: radiance times cosine over the pdfs of a point and of a direction. The direction is sampled by
  /// the emission or, with probability 1/2, uniformly, so that radiance where the emission's pdf is zero is found too.
  Spectrum power_sample() {
    const bool by_emission = trial.uniform() < 0.5f;
    if (host_->infinite()) {  // The projected area of the scene's bounding sphere is a quarter of its surface area, from all
                              // directions.
      const bool knows = emission_.knows_incident();
      const Transform& turn = host_->transform.still();
      Vector3 towards = trial.direction();
      if (by_emission && knows) {
        const DirectionSample s = emission_.sample_incident(trial.pair());
        if (!(s.pdf > 0)) return {};
        towards = normalize(turn(s.direction));
      }
      const float uniform = 1 / (4 * pi);
      const float pdf = knows ? (emission_.incident_pdf(normalize(turn.back(towards))) + uniform) / 2 : uniform;
      SurfacePoint p;
      Ray ray;
      ray.direction = towards;
      host_->surface_point(ray, {}, p);
      return note(emission_.radiance(p, -towards, wavelengths_)) * (host_->area() / (4 * pdf));
    }
    const SurfaceSample s = host_->sample_area(trial.pair(), 0);
    Vector3 v = trial.direction();
    if (by_emission) {
      const DirectionSample d = emission_.sample(s.point, trial.pair());
      if (!(d.pdf > 0)) return {};
      v = d.direction;
    }
    const float pdf = (emission_.pdf(s.point, v) + 1 / (4 * pi)) / 2;
    const float cosine = host_->delta() ? 1 : std::abs(dot(s.point.normal, v));
    return note(emission_.radiance(s.point, v, wavelengths_)) * (cosine / (s.pdf * pdf));
  }

  /// Records the range of each wavelength's value relative to the mean, to detect a spectrum that varies. All wavelengths are
  /// recorded, as different spectra may agree at some of them.
  Spectrum note(const Spectrum& light) {
    const float all = light.average();
    for (size_t k = 0; k < spectrum_size && all > 0; ++k) {
      lowest_[k] = std::min(lowest_[k], light[int(k)] / all);
      highest_[k] = std::max(highest_[k], light[int(k)] / all);
    }
    return light;
  }
  bool of_many_colours() const {
    for (size_t k = 0; k < spectrum_size; ++k)
      if (highest_[k] > 1.001f * lowest_[k]) return true;
    return false;
  }

  /// Whether the emission has a map that varies: its mean over an object is then estimated from some points.
  bool varies() const {
    for (const Member& m : emission_.class_info().members)
      if (m.kind == Kind::component && !m.list)
        if (const Value v = get(emission_, m.name); v.as<Ref<Component>>())
          if (const auto map = ref_cast<ObjectMap>(*v.as<Ref<Component>>()); map && !map->constant()) return true;
    return false;
  }

  void check_power(const std::string& what) {
    std::array<statistics::Mean, spectrum_size> sums;
    for (int i = trial.samples(60000); i > 0; --i) {
      const Spectrum s = power_sample();
      for (size_t k = 0; k < spectrum_size; ++k) sums[k].add(double(s[int(k)]));
    }
    if (of_many_colours()) return check_luminous_power(what);
    // With varying maps the power is an estimate from a thousand points: at most 3 % off among 400 random components.
    const double relative = varies() ? 0.05 : 0.01;
    for (size_t k = 0; k < spectrum_size; ++k)
      compare_power(what, sums[k], double(power_[int(k)]), relative, fmt::format("W/nm at {} nm", wavelengths_[int(k)]));
  }

  /// If the emission's spectrum varies over the surface, its power may be computed from a mean colour, which defines no exact
  /// spectrum. So luminous power is compared instead.
  void check_luminous_power(const std::string& what) {
    const auto seen = [&](const Spectrum& s) {
      double sum = 0;
      for (int k = 0; k < spectrum_size; ++k) sum += double(s[k]) * observer(wavelengths_[k]).y;
      return sum / spectrum_size;
    };
    const auto at = [&](double u) {
      wavelengths_ = spread_wavelengths(wavelength_low + float(u) * (wavelength_high - wavelength_low) / spectrum_size);
    };
    constexpr int steps = 32;
    double said = 0;
    for (int i = 0; i < steps; ++i) {
      at((i + 0.5) / steps);
      said += seen(emission_.power(*host_, wavelengths_)) / steps;
    }
    statistics::Mean sum;
    for (int i = trial.samples(60000); i > 0; --i) {
      at(double(trial.uniform()));
      sum.add(seen(power_sample()));
    }
    // ProjectorEmission assumes that its image's spectrum is the same all over the image: at most 6 % off among 100 random
    // components.
    compare_power(what, sum, said, 0.08, "W/nm as the eye weighs it");
  }

  void compare_power(const std::string& what, const statistics::Mean& m, double said, double relative,
                     const std::string& unit) {
    const double margin =
        Trial::significant_errors * m.error() + 10 * m.largest() / double(m.count()) + relative * said + 1e-30;
    trial.expect(std::abs(m.mean() - said) < margin, what,
                 [&] { return fmt::format("{} {}, but the integral is {} ± {}", said, unit, m.mean(), m.error()); });
  }

  Trial& trial;
  EmissionShader& emission_;
  Ref<SceneObject> host_;
  std::string name_;
  Wavelengths wavelengths_;
  Spectrum power_;
  std::array<float, spectrum_size> lowest_, highest_{};
};

void check_emission(Trial& trial) {
  EmissionShader& emission = trial.part<EmissionShader>();
  // Some light cannot be on every object: what lies at infinity has no intensity, for example.
  std::vector<std::string> refusals;
  int objects = 0;
  const auto check_on = [&](EmissionTrial& object) {
    ++objects;
    if (const std::string why = object.check(); !why.empty()) refusals.push_back(why);
  };
  if (!emission.only_at_infinity())
    for (const char* name : {"Rectangle", "Sphere", "Point"}) {
      EmissionTrial object(trial, emission, name);
      check_on(object);
    }
  EmissionTrial around(trial, emission, "Environment");
  check_on(around);
  if (int(refusals.size()) == objects)
    trial.not_tried("power is the integral of radiance", "the part refuses every object: " + refusals.front());
  if (emission.knows_incident()) around.check_incident();
}

const RegisterCheck<EmissionShader> registered(check_emission);

}  // namespace
}  // namespace etendue::conform
