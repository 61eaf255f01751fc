// A ramp of colours.

#include "components/maps/footprint.h"
#include "etendue/object_map.h"

namespace etendue {
namespace {

enum class Along : std::uint8_t { u, v, input };
enum class Interpolation : std::uint8_t { step, linear, smooth };

// Between two positions the weight of the second colour is h(t). Its mean over [a, b] follows from its integral H(t), which is
// 0, t^2 / 2 or t^3 - t^4 / 2 for h = 0, t and 3 t^2 - 2 t^3.
class RampMap final : public ObjectMap {
 public:
  static void describe(Description<RampMap>& d) {
    d.summary("Colours at positions along u, v or the number of another map.")
        .member<&RampMap::along>("along", "", "u, v: surface coordinates; input: the map below", choices("u", "v", "input"))
        .member<&RampMap::input>("input", "1", "the map whose number is looked up, when `along` is input", Meaning::number,
                                 when("along", "input"))
        .member<&RampMap::positions>("positions", "1",
                                     "where the colours are, in increasing order; before the first and after "
                                     "the last, those go on")
        .member<&RampMap::colors>("colors", "1", "a colour or a map for each position")
        .member<&RampMap::interpolation>("interpolation", "",
                                         "step: each up to the next; linear: mixtures; smooth: mixtures without creases",
                                         choices("step", "linear", "smooth"));
  }

  void prepare() override {
    if (positions.empty()) fail("positions", "at least one position is needed");
    if (positions.size() != colors.size())
      fail("colors",
           std::to_string(colors.size()) + " colours for " + std::to_string(positions.size()) + " positions: give as many");
    for (size_t i = 0; i < positions.size(); ++i) {
      if (!std::isfinite(positions[i])) fail("positions", "must be finite numbers");
      if (i > 0 && !(positions[i - 1] < positions[i])) fail("positions", "must increase");
      if (!colors[i]) fail("colors", "a map or a colour is needed at each position");
    }
    if (along == Along::input && !input) fail("input", "a map is needed");
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    Spectrum sum;
    weigh(p, [&](size_t i, float weight) { sum += weight * colors[i]->color(p, w, use); });
    return use == ColorUse::reflectance ? clamp(sum, 0, 1) : sum;  // by rounding the sum of weights may exceed 1
  }
  float scalar(const SurfacePoint& p) const override {
    float sum = 0;
    weigh(p, [&](size_t i, float weight) { sum += weight * colors[i]->scalar(p); });
    return sum;
  }

  Along along = Along::u;
  Ref<ObjectMap> input = etendue::constant(0);
  std::vector<float> positions{0, 1};
  std::vector<Ref<ObjectMap>> colors{etendue::constant(0), etendue::constant(1)};
  Interpolation interpolation = Interpolation::linear;

 private:
  /// Calls use(i, weight) for every colour of positive weight.
  template <class Use>
  void weigh(const SurfacePoint& p, Use use) const {
    float x = 0, width = 0;
    if (along == Along::input) {
      x = input->scalar(p);
    } else {
      x = along == Along::u ? p.uv.x : p.uv.y;
      const Vector2 box = uv_box(p);
      width = along == Along::u ? box.x : box.y;
    }
    const size_t last = positions.size() - 1;
    const float range = positions[last] - positions[0];
    const float low = x - 0.5f * width, high = x + 0.5f * width;
    const bool wide = width > 1e-5f * range && width < infinity;
    width = high - low;  // as rounded
    if (!wide || !(width > 0)) {
      if (!(x > positions[0])) return use(size_t(0), 1.0f);  // or not a number
      if (x >= positions[last]) return use(last, 1.0f);
      const size_t i = size_t(std::upper_bound(positions.begin(), positions.end(), x) - positions.begin()) - 1;
      const float second = height((x - positions[i]) / (positions[i + 1] - positions[i]));
      if (second < 1) use(i, 1 - second);
      if (second > 0) use(i + 1, second);
      return;
    }
    float before = std::max(0.0f, std::min(high, positions[0]) - low) / width;  // weight of colour i from before position i
    for (size_t i = 0; i < last; ++i) {
      const float length = positions[i + 1] - positions[i];
      const float a = clamp((low - positions[i]) / length, 0, 1), b = clamp((high - positions[i]) / length, 0, 1);
      const float part = (b - a) * length / width, second = (integral(b) - integral(a)) * length / width;
      if (before + part - second > 0) use(i, before + part - second);
      before = second;
    }
    before += std::max(0.0f, high - std::max(low, positions[last])) / width;
    if (before > 0) use(last, before);
  }

  float height(float t) const {
    return interpolation == Interpolation::step ? 0 : (interpolation == Interpolation::linear ? t : t * t * (3 - 2 * t));
  }
  float integral(float t) const {
    return interpolation == Interpolation::step
               ? 0
               : (interpolation == Interpolation::linear ? 0.5f * t * t : t * t * t * (1 - 0.5f * t));
  }
};

const Register<RampMap> registered;

}  // namespace
}  // namespace etendue
