// What holds of every emission shader: its power is that of its radiance, and directions follow their density.

#include <fmt/format.h>

#include <optional>

#include "conformance.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "shader_trial.h"
#include "sphere_cells.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

/// Solid angles narrower than this [sr] hold too few directions of floats for a test in cells.
constexpr double narrowest = 1e-7;

/// An object of a class that has the emission, moved and turned. Prepared.
Ref<SceneObject> host_of(EmissionShader& emission, const std::string& name) {
  Ref<SceneObject> host = ref_cast<SceneObject>(Registry::instance().create(name));
  const Transform turn = Transform::rotate(0.8f, {1, 2, -0.5f});
  host->transform = host->infinite() ? turn : Transform::translate({0.3f, -0.2f, 0.5f}) * turn;
  host->emission = Ref<EmissionShader>(&emission);
  emission.prepare();  // as before every render: what it remembers is of objects that are gone, and this may lie where one was
  host->prepare();
  if (host->infinite()) host->enclose({0.1f, 0.2f, 0.3f}, 1.5f);
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

  void check() {
    const std::string what = fmt::format("power is the integral of radiance, on a {}", name_);
    try {
      power_ = emission_.power(*host_, wavelengths_);
    } catch (const Error& error) {
      trial.not_tried(what, std::string("the part refuses this object: ") + error.what());
      return;
    }
    trial.expect(power_.finite() && power_.minimum() >= 0, "power is finite and not negative", [&] { return name_; });
    if (!host_->infinite()) {
      check_points();
      for (int i = 0; i < (name_ == "Sphere" ? 3 : 1); ++i) check_directions(host_->sample_area(trial.pair(), 0).point);
    }
    check_power(what);
  }

 private:
  /// Radiance, and where it must be zero.
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
    long lost = 0;
    double covered = 0;
    const auto pdf_at = [&](const Vector3& v) { return Spectrum(emission_.pdf(p, v)); };
    const auto draw = [&](int count) {
      std::vector<Vector3> list;
      lost = 0;
      covered = 0;
      for (int i = 0; i < count; ++i) {
        const DirectionSample s = emission_.sample(p, trial.pair());
        trial.expect(s.pdf >= 0 && s.pdf < infinity && (s.pdf == 0 || std::abs(length(s.direction) - 1) < 1e-4f),
                     "sampled directions are unit vectors",
                     [&] { return fmt::format("{}, density {}", text_of(s.direction), s.pdf); });
        if (!(s.pdf > 0)) {
          ++lost;
          continue;
        }
        covered += 1 / double(s.pdf) / count;
        trial.expect(agree(Spectrum(s.pdf), pdf_at(s.direction), 2e-3f, true, [&] { return rounding_of(pdf_at, s.direction); }),
                     "a sample's density is that of its direction", [&] {
                       return fmt::format("on a {} towards {}: {} and {}", name_, text_of(s.direction), s.pdf,
                                          emission_.pdf(p, s.direction));
                     });
        list.push_back(frame.to_local(s.direction));
      }
      return list;
    };
    const std::vector<Vector3> first = draw(trial.samples(8000));
    if (first.size() < 200) return;
    compare(
        "sampled directions follow the density", first, covered,
        [&](const Vector3& local) { return double(emission_.pdf(p, frame.to_world(local))); },
        [&](int count) { return std::pair(draw(count), lost); });
  }

  /// Samples that were lost (sent to a side that does not emit) are what the density lacks to 1.
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
    // A density with sharp borders may need more points than most do.
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
  /// Of light that knows where it comes from: in the coordinates of the object, whose y axis is up.
  void check_incident() {
    const auto up = [](const Vector3& v) { return Vector3{v.z, v.x, v.y}; };
    const auto down = [](const Vector3& v) { return Vector3{v.y, v.z, v.x}; };
    const auto pdf_at = [&](const Vector3& v) { return Spectrum(emission_.incident_pdf(v)); };
    double covered = 0;
    long lost = 0;
    const auto draw = [&](int count) {
      std::vector<Vector3> list;
      covered = 0;
      lost = 0;
      for (int i = 0; i < count; ++i) {
        const DirectionSample s = emission_.sample_incident(trial.pair());
        trial.expect(s.pdf >= 0 && s.pdf < infinity && (s.pdf == 0 || std::abs(length(s.direction) - 1) < 1e-4f),
                     "sampled incident directions are unit vectors",
                     [&] { return fmt::format("{}, density {}", text_of(s.direction), s.pdf); });
        if (!(s.pdf > 0)) {
          ++lost;
          continue;
        }
        covered += 1 / double(s.pdf) / count;
        trial.expect(agree(Spectrum(s.pdf), pdf_at(s.direction), 2e-3f, true, [&] { return rounding_of(pdf_at, s.direction); }),
                     "an incident sample's density is that of its direction", [&] {
                       return fmt::format("from {}: {} and {}", text_of(s.direction), s.pdf,
                                          emission_.incident_pdf(s.direction));
                     });
        list.push_back(up(s.direction));
      }
      return list;
    };
    const std::vector<Vector3> first = draw(trial.samples(8000));
    if (first.size() < 200) return;
    compare(
        "sampled incident directions follow the density", first, covered,
        [&](const Vector3& local) { return double(emission_.incident_pdf(down(local))); },
        [&](int count) { return std::pair(draw(count), lost); });
  }

 private:
  /// One sample of the power: radiance times cosine over the densities of a point and of a direction that is drawn by the
  /// emission or, as often, uniformly, so that light which has no density is found too.
  Spectrum power_sample() {
    const bool by_emission = trial.uniform() < 0.5f;
    if (host_->infinite()) {  // the disc of the scene has a quarter of the area, and is seen alike from everywhere
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

  /// Remembers how far colours are from one another: wavelengths may agree in pairs where others do not.
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

  /// Whether a map in the emission varies: its mean over an object is found from some points.
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
    // Of maps that vary the power is an estimate, from a thousand points: 3 % off at most among 400 parts drawn.
    const double relative = varies() ? 0.05 : 0.01;
    for (size_t k = 0; k < spectrum_size; ++k)
      compare_power(what, sums[k], double(power_[int(k)]), relative, fmt::format("W/nm at {} nm", wavelengths_[int(k)]));
  }

  /// Of light whose colour varies the power may be that of a mean colour, which says no spectrum: what the eye sees is
  /// compared.
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
    // A projected image's is taken to be alike all over the image: that is 6 % off at most among 100 parts drawn.
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
  if (!emission.only_at_infinity())
    for (const char* name : {"Rectangle", "Sphere", "Point"}) EmissionTrial(trial, emission, name).check();
  EmissionTrial around(trial, emission, "Environment");
  around.check();
  if (emission.knows_incident()) around.check_incident();
}

const RegisterCheck<EmissionShader> registered(check_emission);

}  // namespace
}  // namespace etendue::conform
