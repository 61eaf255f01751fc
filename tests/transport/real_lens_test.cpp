// A camera whose lens weakens light, vignettes, and has a transmittance that depends on the wavelength.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue {
namespace {

/// An orthographic camera that looks down from z = 5 at 2 m by 2 m around the origin. The left quarter of its film is
/// vignetted; the rest has the transmittance `clear`, and in its right half, beyond 550 nm, half of that.
class RealLensCamera final : public Camera {
 public:
  static void describe(Description<RealLensCamera>& d) {
    d.summary("For tests: a lens with a rim and a filter.")
        .member<&RealLensCamera::clear>("clear", "1", "what the lens lets through", range(0, 1));
  }
  float clear = 0.8f;

  void set_film(int width, int height) override {
    width_ = float(width);
    height_ = float(height);
  }
  Ray ray(Point2 film, Point2, float time) const override {
    Ray r;
    r.origin = {2 * film.x / width_ - 1, 1 - 2 * film.y / height_, 5};
    r.direction = {0, 0, -1};
    r.time = time;
    return r;
  }
  bool sample_ray(Point2 film, Point2 lens, float time, Wavelengths& w, CameraRay& sample) const override {
    sample.ray = ray(film, lens, time);
    sample.weight = weight(film, w);
    return film.x >= width_ / 4;
  }
  bool has_lens() const override { return false; }
  bool parallel() const override { return true; }
  std::optional<Point2> film_point(const Ray& r) const override {
    const Point2 film{(r.origin.x + 1) / 2 * width_, (1 - r.origin.y) / 2 * height_};
    if (r.direction.z > -0.9999f || film.x < width_ / 4 || film.x >= width_ || film.y < 0 || film.y >= height_)
      return std::nullopt;
    return film;
  }
  std::optional<LensSample> sample_lens(const Point3& from, float, Point2) const override {
    LensSample s;
    s.lens = {from.x, from.y, 5};
    s.direction = {0, 0, 1};
    s.distance = 5 - from.z;
    s.film = {(from.x + 1) / 2 * width_, (1 - from.y) / 2 * height_};
    if (s.film.x < width_ / 4 || s.film.x >= width_ || s.film.y < 0 || s.film.y >= height_) return std::nullopt;
    s.pdf = 1;
    s.importance = 1.0f / 4;  // 1 over the 4 m^2 of the whole film
    return s;
  }
  Spectrum lens_weight(const LensSample& s, const Wavelengths& w) const override { return weight(s.film, w); }
  float importance(const Ray& r) const override { return film_point(r) ? 0.25f : 0; }
  CameraPdf pdf(const Ray& r) const override { return film_point(r) ? CameraPdf{0.25f, 1} : CameraPdf{}; }

 private:
  Spectrum weight(Point2 film, const Wavelengths& w) const {
    Spectrum s(clear);
    if (film.x >= width_ / 2)
      for (int i = 0; i < spectrum_size; ++i)
        if (w[i] > 550) s.set(i, clear / 2);
    return s;
  }
  float width_ = 1, height_ = 1;
};

// A white plate under uniform light from above has radiance 1 everywhere. The film has nothing in the left quarter, 0.8 in the
// second, and in the right half 0.8 (Y below 550 nm + half of Y above) over all Y.
TEST(RealLens, WeakensTheSameForAllAlgorithms) {
  static const Register<RealLensCamera> registered;
  const auto picture = [](const std::string& renderer, const std::string& camera, const std::string& radiance, int samples) {
    const Ref<Job> job = load_job_text(
        fmt::format(
            "Job {{ renderer: {}, camera: {}, image: ImageBuffer {{ width: 4, height: 2, filter: BoxFilter {{}} }}, scene: "
            "EmbreeScene {{ objects: [ Rectangle {{ corner: [-4, -4, 0], edge_u: [8, 0, 0], edge_v: [0, 8, 0], shader: "
            "Lambertian {{ color: 1 }} }}, Rectangle {{ corner: [-1.5, -1.5, -1], edge_u: [0, 3, 0], edge_v: [3, 0, 0] }}, "
            "Environment {{ emission: DiffuseEmission {{ radiance: {} }} }} ] }} }}",
            renderer, camera, radiance),
        "lens.etd");
    job->renderer->samples = samples;
    return test::rendered(job)->picture();
  };
  const std::string lens = "RealLensCamera {}";
  const std::string whole = "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 2 }";
  const std::string filtered = "spectrum([360, 549.99, 550.01, 830], [1, 1, 0.5, 0.5])";
  const double all = picture("PathTracer {}", whole, "1", 4096).at(0, 0, 1);
  const double half = picture("PathTracer {}", whole, filtered, 4096).at(0, 0, 1);
  EXPECT_NEAR(half / all, 0.75, 0.1);
  for (const char* renderer : {"PathTracer {}", "BidirectionalPathTracer {}", "LightTracer {}"}) {
    const bool light = std::string(renderer).starts_with("Light");
    const Image seen = picture(renderer, lens, "1", light ? 1 << 18 : 4096);
    for (int y = 0; y < 2; ++y) {
      const double expected[] = {0, 0.8 * all, 0.8 * half, 0.8 * half};
      for (int x = 0; x < 4; ++x)
        EXPECT_NEAR(seen.at(x, y, 1), expected[x], (light ? 0.06 : 0.01) * all) << renderer << " at " << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace etendue
