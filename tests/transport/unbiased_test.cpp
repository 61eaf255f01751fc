// Whether the expectation is right at any number of samples: for every renderer, map and film filter. Images of 1, 4 and 16
// samples a pixel are compared with means in closed form, or with uniform surfaces rendered by the same renderer.
//
// The board. A checkerboard, or zigzag, is seen from above by parallel rays. Its squares are 1.25 pixels wide, so the image
// repeats after 5 pixels: pixels with equal remainders are independent trials of one experiment, 400 of each in an image of
// 100 x 100. Seeds are fixed. With the bounds below, five standard errors of normal means, the probability that a correct
// program fails in any of all these comparisons is about 1 in 1000.

#include <fmt/format.h>

#include <atomic>
#include <map>
#include <numbers>

#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/filter_support.h"
#include "support/image_file.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

constexpr double significant = 5;
constexpr int side = 100, period = 5;

Image render(const std::string& renderer, const std::string& members, int samples, const std::string& shader, int seed,
             const std::string& filter = "BoxFilter {}", const std::string& more = "") {
  const std::string text = fmt::format(
      R"(Job {{ seed: {}
  renderer: {} {{ samples: {} {} }}
  camera: OrthographicCamera {{ from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1 }}
  image: ImageBuffer {{ width: {}, height: {}, filter: {} }}
  scene: BruteForceScene {{ objects: [
    Rectangle {{ corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: {} }}
    Distant {{ direction: [1, 0.5, -1.5], emission: DiffuseEmission {{ radiance: 3, sides: both }} }}
    {}
  ] }} }})",
      seed, renderer, samples, members, side, side, filter, shader, more);
  const auto done = rendered(load_job_text(text, "unbiased.etd"));
  EXPECT_EQ(done->film().bad_samples(), 0u);
  return done->picture();
}

/// The built-in renderers that support this scene, an orthographic camera and a delta light.
std::vector<std::string> renderers_for_it() {
  std::vector<std::string> names;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer"))) {
    if (!info->provider.empty() || info->abstract() || info->name == "Renderer") continue;
    try {
      render(info->name, "", 1, "Lambertian { color: 0.5 }", 1);
      names.push_back(info->name);
    } catch (const Error&) {  // the renderer does not support the scene
    }
  }
  EXPECT_GE(names.size(), 14u);
  return names;
}

struct Mean {
  double sum = 0, squares = 0, count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    count += 1;
  }
  double mean() const { return sum / count; }
  /// Squared standard error.
  double variance() const { return std::max(0.0, squares / count - mean() * mean()) / (count - 1); }
};

/// The means of Y over pixels with equal remainders, without those near the border of the image.
std::vector<Mean> by_place(const Image& image) {
  std::vector<Mean> means(size_t(period * period));
  constexpr int margin = 5;
  for (int y = margin; y < image.height - margin; ++y)
    for (int x = margin; x < image.width - margin; ++x) means[size_t(y % period * period + x % period)].add(image.at(x, y, 1));
  return means;
}

Mean of_all(const Image& image) {
  Mean mean;
  for (const Mean& m : by_place(image)) {
    mean.sum += m.sum;
    mean.squares += m.squares;
    mean.count += m.count;
  }
  return mean;
}

/// Whether a film point lies on a square of `second`: u = 0.25 + x / 200 and v = 0.75 - y / 200, times `repeat`, 160.
bool on_second(double x, double y) {
  const auto square = [](double at) { return int(std::floor(at)) & 1; };
  return (square(40 + x / 1.25) ^ square(120 - y / 1.25)) != 0;
}
/// Whether the zigzag of period 2.5 pixels along u rises there.
bool rising(double x, double) { return x / 2.5 - std::floor(x / 2.5) < 0.5; }

/// The fraction of a pixel's filter where `inside` is true. Borders lie on eighths of pixels, so that sums over 64ths are exact
/// except for the curvature of the filter.
template <class Inside>
double share(const Filter* filter, int px, int py, Inside inside) {
  constexpr double step = 1.0 / 64;
  const int reach = filter ? int(std::ceil(double(filter->radius()))) * 64 : 32;
  double sum = 0, whole = 0;
  for (int j = -reach; j < reach; ++j)
    for (int i = -reach; i < reach; ++i) {
      const double x = (i + 0.5) * step, y = (j + 0.5) * step, w = filter ? double(filter->weight(float(x), float(y))) : 1;
      whole += w;
      if (w != 0 && inside(px + 0.5 + x, py + 0.5 + y)) sum += w;
    }
  return sum / whole;
}

const std::string board_of = "CheckerMap {{ repeat: [160, 160, 160], first: {}, second: {} }}";

struct Experiment {
  const char* name;
  std::string mixed, first, second;  ///< shaders
  bool (*inside)(double, double);    ///< where `second` is seen
};

std::vector<Experiment> experiments() {
  const auto board = [](const char* shader, double a, double b) {
    return fmt::format(fmt::runtime(shader), fmt::format(fmt::runtime(board_of), a, b));
  };
  const auto diffuse = "Lambertian {{ color: {} }}";
  const auto metal = "Conductor {{ roughness: {} }}";
  const auto mask = "MaskShader {{ shader: Lambertian {{ color: 0.9 }}, opacity: {} }}";
  const auto bump = [](const std::string& formula) {
    return "BumpShader { shader: Lambertian { color: 0.8 }, height: FormulaMap { formula: \"" + formula + "\" } }";
  };
  const auto plain = [](const char* shader, double a) { return fmt::format(fmt::runtime(shader), a); };
  // u spans 2 m, a tooth is 0.0125 u long, and each of its sides is half as high as wide: slopes of +- 0.5
  return {{"color", board(diffuse, 0.02, 0.9), plain(diffuse, 0.02), plain(diffuse, 0.9), on_second},
          {"roughness", board(metal, 0.15, 0.6), plain(metal, 0.15), plain(metal, 0.6), on_second},
          {"opacity", board(mask, 0.0, 0.9), plain(mask, 0), plain(mask, 0.9), on_second},
          {"bump", bump("0.0125 * abs(fract(80 * u + 0.5) - 0.5)"), bump("1 - u"), bump("u"), rising}};
}

TEST(Unbiased, EveryRendererAtAnyNumberOfSamples) {
  int seed = 1;
  for (const std::string& name : renderers_for_it()) {
    // For renderers whose pixels share wavelengths, photons or chains, the variance between pixels does not give the error.
    // Such renderers evaluate maps as the others do (MapsAreFilteredOnRequestByOneWidth).
    if (load_job_text(job_text(name + " {}", "PerspectiveCamera {}", 1, ""), "")->renderer->estimator() !=
        Estimator::independent)
      continue;
    for (const Experiment& e : experiments()) {
      const Mean first = of_all(render(name, "", 4, e.first, ++seed)), second = of_all(render(name, "", 4, e.second, ++seed));
      const double range = std::max(first.mean(), second.mean());
      for (const int samples : {1, 4, 16}) {
        const std::vector<Mean> means = by_place(render(name, "", samples, e.mixed, ++seed));
        for (int i = 0; i < period * period; ++i) {
          const double w = share(nullptr, i % period, i / period, e.inside);
          const double truth = w * second.mean() + (1 - w) * first.mean();
          const double error =
              std::sqrt(means[size_t(i)].variance() + w * w * second.variance() + (1 - w) * (1 - w) * first.variance());
          EXPECT_NEAR(means[size_t(i)].mean(), truth, significant * error + 1e-3 * range)
              << name << ", " << e.name << ", " << samples << " samples, pixel " << i % period << " " << i / period;
        }
      }
    }
  }
}

TEST(Unbiased, EveryFilmFilterForCameraSamplesAndSplats) {
  // The table of a filter's weights is exact to about 1e-3.
  const std::string mixed = fmt::format("Lambertian {{ color: {} }}", fmt::format(fmt::runtime(board_of), 0.02, 0.9));
  int seed = 1000;
  for (const char* renderer : {"PathTracer", "LightTracer", "BidirectionalPathTracer"}) {
    const Mean white = of_all(render(renderer, "", 16, "Lambertian { color: 1 }", ++seed));
    for (const Ref<Filter>& filter : all_filters())
      for (const int samples : {1, 2, 8}) {
        const std::vector<Mean> means = by_place(render(renderer, "", samples, mixed, ++seed, name(*filter) + " {}"));
        for (int i = 0; i < period * period; ++i) {
          const double w = share(filter.get(), i % period, i / period, on_second);
          const double truth = 0.02 + (0.9 - 0.02) * w;
          const double error = std::sqrt(means[size_t(i)].variance() + truth * truth * white.variance());
          EXPECT_NEAR(means[size_t(i)].mean(), truth * white.mean(), significant * error + 2e-3 * white.mean())
              << renderer << ", " << name(*filter) << ", " << samples << " samples, pixel " << i % period << " " << i / period;
        }
      }
  }
}

// The film alone, up to its border: a part of it is bright, and the expected pixel is the mean of that, weighted with the part
// of its filter that lies on the film, for any number of samples, and for different numbers in different pixels.
TEST(Unbiased, TheFilmAtItsBorder) {
  const Wavelengths w = wavelengths();
  const Xyz unit = to_xyz(Spectrum(1.0f), w);
  constexpr int size = 7;
  constexpr double edge = 2.3125;  // bright left of it
  for (const Ref<Filter>& filter : all_filters())
    for (const bool splats : {false, true})
      for (const int samples : {1, 3, -1}) {  // -1: 1 or 3
        if (splats && samples < 0) continue;
        std::array<Mean, size * size> means;
        Random random(unsigned(7 + samples));
        const auto buffer = make<ImageBuffer>();
        buffer->width = buffer->height = size;
        buffer->filter = filter;
        buffer->prepare();
        Film film(*buffer);
        ImageTile tile;
        for (int trial = 0; trial < 6000; ++trial) {
          film.clear();
          tile.begin(*buffer, buffer->area());
          for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
              for (int k = 0; k < (samples > 0 ? samples : 1 + 2 * ((x + y) & 1)); ++k) {
                tile.count_path();
                const Point2 u = random.pair();
                const Point2 at = splats ? Point2{size * u.x, size * u.y} : Point2{float(x) + u.x, float(y) + u.y};
                const Spectrum light(at.x < float(edge) ? 1.0f : 0.0f);
                if (splats)
                  tile.splat(at, x, y, 0, light, w, 1);
                else
                  tile.contribute(at, x, y, 0, light, w);
              }
          film.merge(tile);
          const Image image = film.develop();
          for (int i = 0; i < size * size; ++i) means[size_t(i)].add(image.at(i % size, i / size, 1) / unit.y);
        }
        for (int i = 0; i < size * size; ++i) {
          const int px = i % size, py = i / size;
          // Outside of the film there are no light and no samples.
          const auto pdf = [&](double x, double y) {
            if (!(x >= 0 && x < size && y >= 0 && y < size)) return 0;
            return samples > 0 ? 1 : 1 + 2 * ((int(x) + int(y)) & 1);
          };
          double light = 0, whole = 0;
          const int reach = int(std::ceil(double(filter->radius()))) * 64;
          for (int j = -reach; j < reach; ++j)
            for (int k = -reach; k < reach; ++k) {
              const double x = (k + 0.5) / 64, y = (j + 0.5) / 64;
              const double part = double(filter->weight(float(x), float(y))) * pdf(px + 0.5 + x, py + 0.5 + y);
              whole += part;
              if (px + 0.5 + x < edge) light += part;
            }
          const Mean& m = means[size_t(i)];
          EXPECT_NEAR(m.mean(), light / whole, significant * std::sqrt(m.variance()) + 2e-3)
              << name(*filter) << (splats ? " splats " : " samples ") << samples << ", pixel " << px << " " << py;
        }
      }
}

/// Records the smallest and largest footprint with which a map is evaluated.
class FootprintProbe final : public ObjectMap {
 public:
  static void describe(Description<FootprintProbe>& d) { d.summary("For tests: notes what footprints it is asked with."); }
  Spectrum color(const SurfacePoint& p, const Wavelengths&, ColorUse) const override { return Spectrum(scalar(p)); }
  float scalar(const SurfacePoint& p) const override {
    const auto keep = [&](std::atomic<float>& kept, auto better) {
      float now = kept;
      while (better(p.footprint, now) && !kept.compare_exchange_weak(now, p.footprint)) {
      }
    };
    keep(least, std::less());
    keep(most, std::greater());
    return 0.5f;
  }
  static void clear() { least = infinity, most = -1.0f; }
  static inline std::atomic<float> least = infinity, most = -1.0f;
};

/// The text that sets map_filter, as a member of the renderer or of its inner renderer. Empty: it has no such member.
std::string with_map_filter(const ClassInfo& renderer, const std::string& pixels) {
  if (renderer.find("map_filter")) return "map_filter: " + pixels;
  const Member* inner = renderer.find("inner");
  if (!inner) return {};
  const Ref<Component> inside = *inner->default_value.as<Ref<Component>>();
  return "inner: " + inside->class_info().name + " { map_filter: " + pixels + " }";
}

TEST(Unbiased, MapsAreFilteredOnRequestByOneWidth) {
  if (!Registry::instance().find("FootprintProbe")) static const Register<FootprintProbe> registered;
  const std::string shader = "Lambertian { color: FootprintProbe {} }";
  // A mirror, so that maps are also evaluated at later vertices.
  const std::string more =
      "Rectangle { corner: [-1, -1, 6], edge_u: [0, 2, 0], edge_v: [2, 0, 0], shader: PerfectSpecular {} }";
  // Light subpaths evaluate maps without a filter; so do those that Automatic tries, and chains that are searched.
  const std::vector<std::string> from_both_ends = {"Automatic",
                                                   "BidirectionalPathTracer",
                                                   "InstantRadiosity",
                                                   "ManifoldPathTracer",
                                                   "ManyLights",
                                                   "MultiplexedMetropolis",
                                                   "PhotonMapper",
                                                   "PrimarySampleMetropolis",
                                                   "ProgressivePhotonMapper",
                                                   "VertexConnectionMerging"};
  for (const std::string& name : renderers_for_it()) {
    if (name == "AmbientOcclusionRenderer") continue;  // evaluates no map
    const std::string show = name == "FeatureRenderer" ? ", feature: albedo" : "";
    FootprintProbe::clear();
    render(name, show, 2, shader, 1, "BoxFilter {}", more);
    EXPECT_EQ(FootprintProbe::least, 0) << name;
    EXPECT_EQ(FootprintProbe::most, 0) << name;
    const std::string filtered = with_map_filter(*Registry::instance().find(name), "1.5");
    if (name == "LightTracer") EXPECT_EQ(filtered, "");  // none of its paths begins at the camera
    if (filtered.empty()) continue;
    for (const int samples : {1, 3}) {
      FootprintProbe::clear();
      render(name, show + ", " + filtered, samples, shader, 1, "BoxFilter {}", more);
      // With an orthographic camera the footprint is the same everywhere.
      EXPECT_FLOAT_EQ(FootprintProbe::most, 1.5f / side) << name;
      const bool from_lights = std::ranges::find(from_both_ends, name) != from_both_ends.end();
      EXPECT_FLOAT_EQ(FootprintProbe::least, from_lights ? 0 : 1.5f / side) << name;
    }
  }
}

TEST(Unbiased, FilteringIsNamedAsABias) {
  const auto job = [](const char* members) {
    return load_job_text(job_text(fmt::format("PathTracer {{ samples: 1 {} }}", members), "PerspectiveCamera {}", 2,
                                  "Environment { emission: DiffuseEmission { radiance: 1, sides: both } }"),
                         "bias.etd");
  };
  const Ref<Job> sound = job(""), filtered = job(", map_filter: 2");
  EXPECT_EQ(sound->renderer->bias(), "");
  EXPECT_FALSE(rendered(sound)->picture().metadata.contains("bias"));
  const std::string bias = filtered->renderer->bias();
  EXPECT_NE(bias.find("maps are averaged over 2 pixels"), std::string::npos) << bias;
  EXPECT_EQ(rendered(filtered)->picture().metadata.at("bias"), bias);
  const Member* member = filtered->renderer->class_info().find("map_filter");
  ASSERT_TRUE(member);
  EXPECT_NE(member->text.find("bias"), std::string::npos);
}

/// A map of each class, with edges. If it has none of its own, the first map it is made from is a checkerboard.
std::string map_text(const ClassInfo& info, const std::string& image) {
  const std::map<std::string, std::string> own = {
      {"ImageMap", fmt::format("file: \"{}\", interpolation: \"nearest\"", image)},
      {"FormulaMap", "formula: \"step(0.5, fract(9 * u)) * fract(5 * v)\""},
      {"RampMap", "along: \"u\", positions: [0.3, 0.5, 0.62], colors: [0.1, 0.9, 0.4], interpolation: \"step\""},
      {"PowerMap", "exponent: 3"},
      {"AddMap", "third: 0"},
      {"UvTransformMap", "scale: [3, 2]"},
      {"TransformedMap", "transform: rotate(20 deg, [0, 0, 1])"}};
  std::string text = info.name + " { ";
  if (const auto found = own.find(info.name); found != own.end()) text += found->second + ", ";
  // Only the first part: with all parts replaced, patterns would not show. The map of a group is a shader.
  bool made = info.name == "CheckerMap" || info.name == "OslGroupMap";
  for (const Member& m : info.members) {
    const bool said = text.find(" " + m.name + ":") != std::string::npos;
    if (m.kind == Kind::component && !m.list && m.component_class == "ObjectMap" && !said && !made) {
      made = true;
      text += m.name + ": CheckerMap { repeat: [9.3, 7.1, 3] }, ";
    } else if (m.name == "size" && !said)
      text += "size: 0.07, ";
    else if (m.name == "repeat" && m.kind == Kind::vector2)
      text += "repeat: [11, 17], ";
  }
  return text + "}";
}

TEST(Unbiased, EveryMapAtAnyNumberOfSamples) {
  const ImageFile image("board.exr", {4, 4, 1, NumberType::single}, {0, 1, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1, 0});
  constexpr int size = 20, fine = 32;
  // The map is squared, so that using the mean of the map would be wrong; it is the opacity of a surface.
  const auto job_with = [&](const std::string& opacity, int samples, int seed) {
    return load_job_text(fmt::format(R"(Job {{ seed: {}, renderer: PathTracer {{ samples: {} }}
          camera: OrthographicCamera {{ from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1 }}
          image: ImageBuffer {{ width: {}, height: {}, filter: BoxFilter {{}} }}
          scene: BruteForceScene {{ objects: [
            Rectangle {{ corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0]
              shader: MaskShader {{ shader: Lambertian {{ color: 1 }}, opacity: {} }} }}
            Distant {{ direction: [0, 0, -1], emission: DiffuseEmission {{ radiance: 3, sides: both }} }} ] }} }})",
                                     seed, samples, size, size, opacity),
                         "maps.etd");
  };
  Mean white;
  for (int seed = 0; seed < 20; ++seed) {
    const Image picture = rendered(job_with("1", 1, seed))->picture();
    for (size_t i = 1; i < picture.values.size(); i += 3) white.add(picture.values[i]);
  }
  size_t varying = 0;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("ObjectMap"))) {
    if (!info->provider.empty() || info->name == "FootprintProbe") continue;
    const std::string opacity =
        "FormulaMap { formula: \"clamp(m * m, 0, 1)\", names: [\"m\"], maps: [" + map_text(*info, image.path) + "] }";
    const Ref<Job> job = job_with(opacity, 1, 1);
    prepare_tree(*job);
    const Ref<ObjectMap> map = ref_cast<ObjectMap>(parse_component(opacity, "map"));
    prepare_tree(*map);
    // The expected value, from stratified points in every pixel, without a footprint.
    Random random(5);
    std::vector<double> truth(size * size), squares(size * size);
    double least = 1, greatest = 0;
    for (int i = 0; i < size * size; ++i) {
      for (int k = 0; k < fine * fine; ++k) {
        const Point2 film{float(i % size) + (float(k % fine) + random()) / fine,
                          float(i / size) + (float(k / fine) + random()) / fine};
        Ray ray = job->camera->ray(film, {}, 0);
        ray.width = 0;
        Hit hit;
        ASSERT_TRUE(job->scene->nearest(ray, hit));
        SurfacePoint point;
        job->scene->locate(ray, hit, point);
        const double value = double(map->scalar(point));
        truth[size_t(i)] += value / (fine * fine);
        squares[size_t(i)] += value * value / (fine * fine);
      }
      least = std::min(least, truth[size_t(i)]);
      greatest = std::max(greatest, truth[size_t(i)]);
    }
    varying += greatest - least > 0.01;

    for (const auto& [samples, trials] : {std::pair(1, 60), {16, 8}}) {
      std::vector<Mean> means(size * size);
      for (int seed = 0; seed < trials; ++seed) {
        const Image picture = rendered(job_with(opacity, samples, 100 * samples + seed))->picture();
        for (size_t i = 0; i < means.size(); ++i) means[i].add(picture.values[3 * i + 1]);
      }
      double statistic = 0;
      for (size_t i = 0; i < means.size(); ++i) {
        // The variance of independent samples, from the map's variation in the pixel and from the wavelengths; stratified
        // samples have less. The expected value itself is known to half a percent.
        const double of_map = std::max(0.0, squares[i] - truth[i] * truth[i]) * white.mean() * white.mean();
        const double variance = (of_map + squares[i] * white.variance() * white.count) / (samples * trials);
        const double known = (0.005 * (greatest - least) + 1e-3) * white.mean();
        const double off = means[i].mean() - truth[i] * white.mean();
        statistic += off * off / (variance + known * known);
      }
      // Squares of nearly normal numbers: mean 1, variance 2 and somewhat more, since some are means of few rare values.
      constexpr double n = size * size;
      EXPECT_LT(statistic, n + significant * std::sqrt(3 * n)) << info->name << ", " << samples << " samples";
    }
  }
  EXPECT_GE(varying, 25u);  // maps that had something to show
}

// Ripples of slope cos(2 pi k u) / 2, as fine as a thousandth of the surface, tilt the shading normal by that slope.
TEST(Unbiased, SlopesOfFineBumps) {
  for (const int k : {1, 30, 1000}) {
    const Ref<ObjectMap> height =
        create<ObjectMap>("FormulaMap", {{"formula", fmt::format("sin(2 * pi * fract({} * u)) / (4 * pi * {})", k, k)}});
    const Ref<Shader> shader = create<Shader>("BumpShader", {{"shader", create<Shader>("Lambertian")}, {"height", height}});
    Random random(3);
    Arena arena;
    for (int i = 0; i < 200; ++i) {
      SurfacePoint p = test::surface_point({0, 0, 1});
      p.uv = random.pair();
      p.position = p.object_position = {p.uv.x, p.uv.y, 0};
      p.dpdu = {1, 0, 0};
      p.dpdv = {0, 1, 0};
      const double slope = 0.5 * std::cos(2 * std::numbers::pi * (k * double(p.uv.x)));
      const Vector3 n(shader->bind(p, wavelengths(), arena)->frame().n);
      EXPECT_NEAR(-n.x / n.z, slope, 0.006) << k << " ripples, u " << p.uv.x;
      arena.reset();
    }
  }
}

}  // namespace
}  // namespace etendue::test
