// Checks of every object map: numbers and colours are finite everywhere, reflectances are in [0, 1], and values filtered over a
// footprint are the mean over it. See also check_map_space.cpp.

#include <fmt/format.h>

#include "etendue/scene_object.h"
#include "map_trial.h"
#include "shader_trial.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

/// A unit square (1 m) in the xy plane whose uv coordinates are metres.
Ref<SceneObject> ground() {
  Ref<SceneObject> square = ref_cast<SceneObject>(Registry::instance().create("Rectangle"));
  set(*square, "corner", Value(Numbers{{0, 0, 0}, 1, Dimension::none}));
  square->prepare();
  return square;
}

SurfacePoint ground_point(const SceneObject& square, float u, float v, float footprint) {
  SurfacePoint p;
  p.position = p.object_position = {u, v, 0};
  p.normal = p.shading_normal = p.object_normal = {0, 0, 1};
  p.uv = {u, v};
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.footprint = footprint;
  p.ray_direction = {0, 0, -1};
  p.object = &square;
  return p;
}

class MapTrial {
 public:
  MapTrial(Trial& t, const ObjectMap& map) : trial(t), map_(map), square_(ground()) {}

  void check() {
    check_objects();
    check_extremes();
    check_constant();
    if (over_constants()) check_filter();
    check_map_space(trial, map_);
  }

 private:
  void check_point(const SurfacePoint& p, bool extreme) {
    const Wavelengths w = spread_wavelengths(lerp(trial.uniform(), 400, 700));
    const float scalar = map_.scalar(p);
    const Spectrum reflectance = map_.reflectance(p, w);
    const auto where = [&] {
      return fmt::format("uv ({}, {}), position ({}, {}, {}), footprint {}: scalar {}, reflectance {} .. {}", p.uv.x, p.uv.y,
                         p.object_position.x, p.object_position.y, p.object_position.z, p.footprint, scalar,
                         reflectance.minimum(), reflectance.maximum());
    };
    trial.expect(std::isfinite(scalar), "scalars are finite", where);
    for (const ColorUse use : {ColorUse::reflectance, ColorUse::radiance, ColorUse::coefficient})
      trial.expect(map_.color(p, w, use).finite(), "colours are finite", where);
    trial.expect(reflectance.minimum() >= 0 && reflectance.maximum() <= 1 + 1e-6f, "reflectances are in [0, 1]", where);
    if (extreme || !std::isfinite(scalar) || !over_constants()) return;
    // The scalar is a mean over channels or wavelengths, so it lies within the range of the values at all wavelengths.
    float least = 1, most = 0;
    for (int i = 0; i < 5; ++i) {
      const Spectrum s = map_.reflectance(p, spread_wavelengths(400 + 20 * float(i)));
      least = std::min(least, s.minimum());
      most = std::max(most, s.maximum());
    }
    const float bounded = clamp(scalar, 0, 1);
    trial.expect(bounded > least - 0.03f && bounded < most + 0.03f, "the scalar is a mean of the colour's values",
                 [&] { return where() + fmt::format("; over all wavelengths {} .. {}", least, most); });
  }

  void check_objects() {
    for (const char* name : {"Rectangle", "Sphere"}) {
      const Ref<SceneObject> object = ref_cast<SceneObject>(Registry::instance().create(name));
      object->transform = Transform::translate({0.5f, 1, -0.3f}) * Transform::rotate(1, {1, 0.5f, 2}) *
                          Transform::scale({2, 2, trial.uniform() < 0.5f ? 2.0f : 0.7f});
      object->prepare();
      for (int i = trial.samples(1000); i > 0; --i) {
        SurfacePoint p = object->sample_area(trial.pair(), 0).point;
        if (trial.uniform() < 0.5f) object->tangents(p);
        if (trial.uniform() < 0.7f) {
          p.ray_direction = trial.direction();
          p.footprint = std::exp(lerp(trial.uniform(), -9, 3));
          p.footprint_cosine = std::abs(dot(p.normal, p.ray_direction));
        }
        check_point(p, false);
      }
    }
  }

  void check_extremes() {
    for (const float u : {0.0f, 1.0f, -1.0f, 0.5f, 1e-30f, 123456.75f, -1e9f, 1e30f})
      for (const float v : {0.0f, 1.0f, -3.25f, one_minus_epsilon, 1e9f})
        for (const float footprint : {0.0f, 1e-20f, 0.1f, 1e10f, 1e30f}) {
          SurfacePoint p = ground_point(*square_, u, v, footprint);
          p.object_position.z = trial.uniform() < 0.5f ? 0 : u;
          if (trial.uniform() < 0.5f) {  // seen at grazing incidence
            p.ray_direction = {1, 0, 0};
            p.footprint_cosine = 0;
          }
          check_point(p, true);
        }
  }

  void check_constant() {
    const Color only = map_.constant();
    if (!only) return;
    const Wavelengths w = spread_wavelengths(500);
    for (int i = 0; i < 200; ++i) {
      const SurfacePoint p = ground_point(*square_, 4 * trial.uniform(), 4 * trial.uniform(), trial.uniform());
      for (const ColorUse use : {ColorUse::reflectance, ColorUse::radiance, ColorUse::coefficient}) {
        const Spectrum here = map_.color(p, w, use), said = only->evaluate(w, use);
        trial.expect((here - said).maximum() < 1e-5f && (said - here).maximum() < 1e-5f,
                     "a map that has only one colour has it everywhere",
                     [&] { return fmt::format("{} at uv ({}, {}), not {}", here[0], p.uv.x, p.uv.y, said[0]); });
      }
    }
  }

  /// Whether no input of the map is a varying map. A map may be nonlinear in its inputs: then its filtered value need not be
  /// the mean.
  bool over_constants() const {
    for (const Member& m : map_.class_info().members) {
      if (m.kind != Kind::component) continue;
      if (m.list) return false;
      const Value v = get(map_, m.name);
      if (!v.as<Ref<Component>>()) continue;
      if (const auto inner = ref_cast<ObjectMap>(*v.as<Ref<Component>>()); inner && !inner->constant()) return false;
    }
    return true;
  }

  /// Compares values filtered over squares on the ground, seen from above, with the mean over the square. If the map reacts to
  /// footprints, the filtered value must be nearer to the mean than the unfiltered one, and over many places it must not be
  /// biased.
  void check_filter() {
    // These maps form sharp patterns of the noise that they filter, or end an image at its border, where its averages do not
    // include what is beyond. Their filtered values only approximate the mean.
    for (const char* nonlinear : {"HypertextureMap", "MarbleMap", "TurbulenceMap", "CellularMap"})
      if (map_.class_info().name == nonlinear) return;
    for (const char* member : {"wrap", "wrap_v"}) {
      if (!map_.class_info().find(member)) continue;
      const Value value = get(map_, member);
      if (const auto* how = value.as<std::string>(); how && (*how == "black" || *how == "clamp")) return;
    }
    constexpr int side = 24;
    for (const float width : {0.05f, 0.4f, 3.0f}) {
      statistics::Mean difference;
      double filtered_square = 0, contrast = 0;
      bool reacts = false;
      const int places = trial.samples(400);
      for (int i = 0; i < places; ++i) {
        // The places are far enough apart that they do not all contain the same few features.
        const float reach = std::max(1.0f, 8 * width);
        const float u = 0.5f + reach * (trial.uniform() - 0.5f), v = 0.5f + reach * (trial.uniform() - 0.5f);
        const double filtered = double(map_.scalar(ground_point(*square_, u, v, width)));
        double mean = 0, squares = 0;
        for (int k = 0; k < side * side; ++k) {
          const float x = u + width * ((float(k % side) + trial.uniform()) / side - 0.5f);
          const float y = v + width * ((float(k / side) + trial.uniform()) / side - 0.5f);
          const double value = double(map_.scalar(ground_point(*square_, x, y, 0)));
          mean += value / (side * side);
          squares += value * value / (side * side);
        }
        const double spread = squares - mean * mean;
        if (std::abs(filtered - double(map_.scalar(ground_point(*square_, u, v, 0)))) > 1e-4 * std::sqrt(std::max(spread, 0.0)))
          reacts = true;
        difference.add(filtered - mean);
        filtered_square += (filtered - mean) * (filtered - mean) / places;
        contrast += std::max(spread, 0.0) / places;
      }
      const double rms = std::sqrt(filtered_square), all = std::sqrt(contrast);
      if (!reacts || !(all > 1e-3)) continue;
      const auto detail = [&] {
        return fmt::format(
            "footprint {} m: off the mean by {:.4f} ± {:.4f} on average and {:.4f} rms, where values spread by "
            "{:.4f}",
            width, difference.mean(), difference.error(), rms, all);
      };
      trial.expect(rms < 0.8 * all, "a filtered value is nearer to the mean over the footprint than a sharp one", detail);
      trial.expect(std::abs(difference.mean()) < Trial::significant_errors * difference.error() + 0.1 * all,
                   "filtering keeps the mean", detail);
    }
  }

  Trial& trial;
  const ObjectMap& map_;
  Ref<SceneObject> square_;
};

void check_object_map(Trial& trial) { MapTrial(trial, trial.part<ObjectMap>()).check(); }

const RegisterCheck<ObjectMap> registered(check_object_map);

}  // namespace
}  // namespace etendue::conform
