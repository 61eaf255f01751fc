// The photon mapper of tests/plugin, and a wrapper around it whose photons carry the wrong power, or that declares a shrinking
// of the radius other than the actual one: `verify` must find that it converges to a different image.

#include "../plugin/small_photon_mapper.cpp"

namespace etendue {
namespace {

class FaultyPhotonMapper final : public Renderer, public ShrinkingBias {
  Ref<Renderer> inner;
  float power = 1, declared_alpha = 0.7f;

 public:
  FaultyPhotonMapper() : inner(make<SmallPhotonMapper>()) {}
  static void describe(Description<FaultyPhotonMapper>& d) {
    d.summary("For tests: photon mapping with something wrong.")
        .member<&FaultyPhotonMapper::inner>("inner", "", "what it does")
        .member<&FaultyPhotonMapper::power>("power", "1", "what all light is multiplied by", range(0, 100))
        .member<&FaultyPhotonMapper::declared_alpha>("declared_alpha", "1", "how slowly it says that the radius shrinks",
                                                     range(0.01, 1));
  }
  PathClasses finds() const override { return inner->finds(); }
  Expectation expectation() const override { return Expectation::consistent; }
  std::uint32_t samples_per_step(std::uint32_t usual) const override { return inner->samples_per_step(usual); }
  Estimator estimator() const override { return inner->estimator(); }
  double bias_width(std::uint32_t step) const override {
    SmallPhotonMapper like;
    like.alpha = declared_alpha;
    return like.bias_width(step);
  }

 private:
  class Process final : public RenderProcess {
    const std::unique_ptr<RenderProcess> inner_;
    const float power_;

   public:
    Process(const FaultyPhotonMapper& r, const RenderContext& c)
        : RenderProcess(r, c), inner_(r.inner->start(c)), power_(r.power) {}
    void prepare_step(Schedule& schedule, const Step& step) override { inner_->prepare_step(schedule, step); }
    Spectrum radiance(const Ray& ray, SampleContext& sample) const override { return power_ * inner_->radiance(ray, sample); }
    Wavelengths wavelengths(SampleKey key, float u) const override { return inner_->wavelengths(key, u); }
  };
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return std::make_unique<Process>(*this, context);
  }
};
const Register<FaultyPhotonMapper> registered_faulty;

}  // namespace
}  // namespace etendue
