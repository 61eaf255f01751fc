// Tone maps with one fault each, which `etendue conform` must find.

#include "etendue/exposed_tone_map.h"

namespace etendue {
namespace {

class GlowingToneMap final : public ToneMap {
 public:
  static void describe(Description<GlowingToneMap>& d) { d.summary("Lifts black to a dark grey."); }

 protected:
  void map(Image& xyz) const override {
    for (double& v : xyz.values) v += 0.01;
  }
};
const Register<GlowingToneMap> glowing;

class SolarizingToneMap final : public ToneMap {
 public:
  static void describe(Description<SolarizingToneMap>& d) { d.summary("Turns around what is brighter than 10."); }

 protected:
  void map(Image& xyz) const override {
    for (double& v : xyz.values) v = v > 10 ? 10 / v : v / 10;
  }
};
const Register<SolarizingToneMap> solarizing;

class HalfExposedToneMap final : public ExposedToneMap {
 public:
  HalfExposedToneMap() { exposure = Exposure::fixed; }
  static void describe(Description<HalfExposedToneMap>& d) { d.summary("Takes the exposure back, by half of its stops."); }

 protected:
  void develop(Image& xyz) const override {
    for (double& v : xyz.values) v *= std::exp2(-double(stops) / 2);
  }
};
const Register<HalfExposedToneMap> half_exposed;

class PlaceToneMap final : public ToneMap {
 public:
  static void describe(Description<PlaceToneMap>& d) { d.summary("Darkens towards the lower end without saying so."); }

 protected:
  void map(Image& xyz) const override {
    for (size_t i = 0; i < xyz.values.size(); ++i) xyz.values[i] *= 1 - 0.5 * double(i / 3) / double(xyz.values.size() / 3);
  }
};
const Register<PlaceToneMap> place;

class UnclippedToneMap final : public ToneMap {
 public:
  static void describe(Description<UnclippedToneMap>& d) { d.summary("Makes bright light infinite."); }
  bool clips() const override { return false; }

 protected:
  void map(Image& xyz) const override {
    for (double& v : xyz.values) v = v > 100 ? std::numeric_limits<double>::infinity() : v;
  }
};
const Register<UnclippedToneMap> unclipped;

}  // namespace
}  // namespace etendue
