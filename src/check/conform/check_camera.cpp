// Checks of every camera: the film point of a ray is the one it was generated for, and sampling rays and sampling the lens
// measure the same light.

#include <fmt/format.h>

#include "conformance.h"
#include "etendue/camera.h"
#include "shader_trial.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

constexpr int width = 64, height = 48;

class CameraTrial {
 public:
  CameraTrial(Trial& t, Camera& camera) : trial(t), camera_(camera) {
    camera.set_film(width, height);
    time_ = lerp(trial.uniform(), camera.shutter_open, camera.shutter_close);
  }

  void check() {
    for (int i = trial.samples(2000); i > 0; --i) {
      check_ray();
      check_stray();
    }
    for (int i = 0; i < 4; ++i) check_both_ways();
  }

 private:
  /// A random point of the film. `inset` keeps it off the edge, where rounding decides whether it is on the film.
  Point2 film(float inset = 0) {
    const Point2 u = trial.pair();
    return {lerp(u.x, inset, width - inset), lerp(u.y, inset, height - inset)};
  }
  static bool on_film(Point2 f) { return f.x >= 0 && f.x <= width && f.y >= 0 && f.y <= height; }

  void check_ray() {
    const Point2 f = film(0.02f);
    const Point2 lens = trial.pair();
    CameraRay sample;
    Wavelengths wavelengths = spread_wavelengths(550);
    const bool passes = camera_.sample_ray(f, lens, time_, wavelengths, sample);
    const Ray ray = passes ? sample.ray : camera_.ray(f, lens, time_);
    const auto where = [&] {
      return fmt::format("film point ({}, {}): from ({}, {}, {}) towards ({}, {}, {})", f.x, f.y, ray.origin.x, ray.origin.y,
                         ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z);
    };
    trial.expect(is_finite(ray.origin) && std::abs(length(ray.direction) - 1) < 1e-4f && ray.time == time_ && ray.width >= 0 &&
                     ray.spread >= 0 && ray.width + ray.spread < infinity,
                 "rays are finite, of unit length and at the time asked for", where);
    if (!camera_.has_lens()) {
      const Ray other = camera_.ray(f, trial.pair(), time_);
      trial.expect(other.origin == ray.origin && other.direction == ray.direction,
                   "without a lens rays do not depend on the lens point", where);
    }
    if (!passes) return;  // a ray that the lens blocks need not have a film point
    const auto back = camera_.film_point(ray);
    trial.expect(back && std::abs(back->x - f.x) < 0.02f && std::abs(back->y - f.y) < 0.02f,
                 "a ray's film point is where it came from",
                 [&] { return where() + (back ? fmt::format(", back at ({}, {})", back->x, back->y) : ", not on the film"); });
    const float importance = camera_.importance(ray);
    const CameraPdf d = camera_.pdf(ray);
    trial.expect(importance > 0 && importance < infinity && d.position > 0 && d.position < infinity && d.direction > 0 &&
                     d.direction < infinity,
                 "a camera's own rays have importance and densities", [&] {
                   return fmt::format("{}: importance {}, densities {} and {}", where(), importance, d.position, d.direction);
                 });
    // W_e cos = weight p_position p_direction, for the cosine at the lens.
    const float cosine = sample.weight.average() * d.position * d.direction / importance;
    trial.expect(cosine > 0 && cosine < 1.001f, "importance times a cosine is the product of the densities and the weight",
                 [&] { return fmt::format("{}: that cosine would be {}", where(), cosine); });
    check_lens(ray);
    check_reach(ray);
  }

  void check_lens(const Ray& ray) {
    const Point3 seen = ray(0.5f + 5 * trial.uniform());
    const auto s = camera_.sample_lens(seen, time_, trial.pair());
    if (!s) return;  // seen from another point of the lens it may be off the film
    const auto where = [&] { return fmt::format("seen from ({}, {}, {})", seen.x, seen.y, seen.z); };
    trial.expect(std::abs(s->distance - distance(seen, s->lens)) < 1e-3f * s->distance &&
                     length(normalize(s->lens - seen) - s->direction) < 1e-3f && s->pdf > 0 && s->pdf < infinity &&
                     s->importance > 0 && s->importance < infinity && on_film(s->film),
                 "lens samples are whole", where);
    Ray back = ray;
    back.origin = s->lens;
    back.direction = -s->direction;
    const float nearest = camera_.reach(back).nearest;
    trial.expect(std::abs(s->nearest - nearest) <= 1e-3f * nearest && s->nearest <= s->distance * 1.001f,
                 "lens samples reach as far as rays", where);
    const auto f = camera_.film_point(back);
    // At the film's edge rounding decides whether a point is on it.
    const bool inside = s->film.x > 0.1f && s->film.x < width - 0.1f && s->film.y > 0.1f && s->film.y < height - 0.1f;
    if (!inside) return;
    trial.expect(f && std::abs(f->x - s->film.x) < 0.05f && std::abs(f->y - s->film.y) < 0.05f,
                 "a lens sample's film point is that of its ray", [&] {
                   return fmt::format("{}: ({}, {}){}", where(), s->film.x, s->film.y,
                                      f ? fmt::format(" and ({}, {})", f->x, f->y) : ", off the film");
                 });
    const float importance = camera_.importance(back);
    trial.expect(std::abs(importance - s->importance) < 3e-3f * importance, "a lens sample's importance is that of its ray",
                 [&] { return fmt::format("{}: {} and {}", where(), s->importance, importance); });
  }

  /// The camera's nearest and farthest distances (reach) hold for rays and for lens samples alike.
  void check_reach(const Ray& ray) {
    const auto [nearest, farthest] = camera_.reach(ray);
    const auto where = [&] { return fmt::format("from {} m to {} m, and a ray of {} m", nearest, farthest, ray.maximum); };
    const float length = farthest - nearest;
    trial.expect(nearest >= 0 && nearest < infinity && length > 0 &&
                     (ray.maximum == length || std::abs(ray.maximum - length) < 1e-3f * farthest),
                 "a ray is as long as its camera reaches", where);
    const Point3 lens = camera_.lens_point(ray);
    const auto sees = [&](float distance) {
      return camera_.sample_lens(lens + distance * ray.direction, time_, trial.pair()).has_value();
    };
    trial.expect(!(nearest > 0 && sees(0.99f * nearest)) && !(farthest < infinity && sees(1.01f * farthest)),
                 "lens samples reach as far as rays", where);
  }

  /// Rays with directions that the camera did not generate.
  void check_stray() {
    Ray ray = camera_.ray(film(), trial.pair(), time_);
    ray.direction = trial.direction();
    const auto f = camera_.film_point(ray);
    const float importance = camera_.importance(ray);
    const CameraPdf d = camera_.pdf(ray);
    trial.expect((!f || on_film(*f)) && (f || (importance == 0 && d.direction == 0)),
                 "what misses the film has neither importance nor density", [&] {
                   return fmt::format("towards ({}, {}, {}): importance {}, density {}", ray.direction.x, ray.direction.y,
                                      ray.direction.z, importance, d.direction);
                 });
    const Point3 any = ray(3);
    const auto s = camera_.sample_lens(any, time_, trial.pair());
    trial.expect(!s || on_film(s->film), "lens samples are whole", [&] { return fmt::format("({}, {})", any.x, any.y); });
  }

  /// Estimates the image's mean for a disc of radiance 1 that faces the camera: by the fraction of rays that hit it, and by
  /// points of the disc that sample the lens, with the weight area cos W_e / pdf.
  void check_both_ways() {
    const Point2 f{width * (0.3f + 0.4f * trial.uniform()), height * (0.3f + 0.4f * trial.uniform())};
    const Point2 lens{0.5f, 0.5f};
    const Ray axis = camera_.ray(f, lens, time_),
              other = camera_.ray({f.x + (2 * f.x < width ? 0.25f : -0.25f) * width, f.y}, lens, time_);
    const float away = 1 + 4 * trial.uniform(), radius = 0.6f * distance(axis(away), other(away));
    const Point3 centre = axis(away);
    const Frame frame(Normal3(-axis.direction));
    statistics::Mean by_rays, by_lens;
    for (int i = trial.samples(60000); i > 0; --i) {
      CameraRay sample;
      Wavelengths wavelengths = spread_wavelengths(550);
      const bool passes = camera_.sample_ray(film(), trial.pair(), time_, wavelengths, sample);
      const Ray& ray = sample.ray;
      const float cosine = dot(frame.n, ray.direction), t = dot(frame.n, centre - ray.origin) / cosine;
      const bool meets = passes && cosine < 0 && t > 0 && t < ray.maximum && distance(ray(t), centre) < radius;
      by_rays.add(meets ? double(sample.weight.average()) : 0);

      const float r = radius * std::sqrt(trial.uniform()), phi = 2 * pi * trial.uniform();
      const auto s =
          camera_.sample_lens(centre + frame.to_world({r * std::cos(phi), r * std::sin(phi), 0}), time_, trial.pair());
      by_lens.add(s ? double(pi * radius * radius * std::max(0.0f, dot(frame.n, s->direction)) * s->importance / s->pdf) : 0);
    }
    const double margin = Trial::significant_errors * std::hypot(by_rays.error(), by_lens.error()) + 1e-3 * by_rays.mean() +
                          10 / double(by_rays.count());
    trial.expect(std::abs(by_rays.mean() - by_lens.mean()) < margin, "rays and lens samples measure the same light", [&] {
      return fmt::format(
          "a disc at film point ({}, {}), {} m away: {:.5f} ± {:.5f} of the rays, {:.5f} ± {:.5f} through the lens", f.x, f.y,
          away, by_rays.mean(), by_rays.error(), by_lens.mean(), by_lens.error());
    });
  }

  Trial& trial;
  Camera& camera_;
  float time_ = 0;
};

void check_camera(Trial& trial) { CameraTrial(trial, trial.part<Camera>()).check(); }

const RegisterCheck<Camera> registered(check_camera);

}  // namespace
}  // namespace etendue::conform
