#pragma once
// How Scatter's public calls are answered by a model's local functions: side tests and the two corrections that make f depend
// on what is carried; and ScatterModel, which spares a model the virtual calls.
//
// Notation: light or importance is carried along a path that came from `out` and goes on to `in`. The renderer
// multiplies f by |in . ns|, the cosine with the shading normal ns. ng is the geometric normal.
//
// Refraction (Veach 1997, section 5.2). A beam that is refracted keeps its power but not its spread:
// n_o^2 cos_o dw_o = n_i^2 cos_i dw_i, so radiance that arrives in a medium of index n_i leaves into one of index n_o as
// L_o = (1 - F) (n_o / n_i)^2 L_i (eq. 5.2). A path that carries radiance's adjoint from the camera looks from `out` to
// where light comes from, `in`: n_o is the index on the side of `out`, n_i that on the side of `in`, and with
// eta = n_i / n_o the factor is 1 / eta^2. A path from a light carries power: none of it is gained or lost by the change
// of spread, f integrates over `in` to 1 - F, and there is no factor. Local functions are in this second convention.
// Indices differ between wavelengths, and so does the factor. A specular refraction has the direction of one wavelength: where
// indices differ only the hero goes on, and its factor is all that counts.
//
// Shading normals (Veach 1997, section 5.3). Using f |in . ns| for radiance that arrives from `in` means a surface whose
// true function is f |in . ns| / |in . ng|, a function of where light comes from. On a path from a light, light comes from
// `out`: the true function is f |out . ns| / |out . ng|, and the true cosine |in . ng|. As the renderer multiplies by
// |in . ns|, f must be multiplied by |out . ns| |in . ng| / (|out . ng| |in . ns|) (eq. 5.19). Radiance needs no factor.
//
// Models that are not reciprocal. On a path from a light, light comes from `out` and leaves to `in`: f is asked for (in, out).
// Directions are still drawn as if it were (out, in), which is near, and weighed with what f then is.
//
// Sides. Whether a pair of directions is a reflection or a transmission is decided by ng, or light would leak through
// surfaces; the local functions decide by ns. A direction on whose side the two normals disagree carries nothing, which
// is the same for both roles of a direction, so reciprocity is kept.

#include "etendue/shader.h"

namespace etendue {

/// Model: Scatter, whose local functions are virtual, or a final class, in which they are public and the compiler sees which
/// they are.
template <class Model>
class ScatterAnswers {
  /// Two directions in local coordinates, and their cosines with the geometric normal.
  struct Pair {
    Vector3 out, in;
    float out_geometric, in_geometric;

    Pair() = default;
    Pair(const Model& m, const Vector3& world_out, const Vector3& world_in)
        : out(m.frame_.to_local(world_out)),
          in(m.frame_.to_local(world_in)),
          out_geometric(dot(m.normal_, world_out)),
          in_geometric(dot(m.normal_, world_in)) {}

    bool sides_agree() const { return out_geometric * out.z > 0 && in_geometric * in.z > 0; }
    bool reflection() const { return out.z * in.z > 0; }
    bool asked(Lobes which) const {
      return (which & smooth_lobes & (reflection() ? reflection_lobes : transmission_lobes)) != 0;
    }
    /// The shading-normal factor of importance.
    float importance_factor() const { return std::abs(out.z * in_geometric / (out_geometric * in.z)); }
  };

  static Spectrum squared(const Spectrum& s) { return s * s; }

  /// f of importance, but for shading normals.
  static Spectrum local_importance(const Model& m, const Pair& pair, Lobes which) {
    if (m.reciprocal_) return m.local_evaluate(pair.out, pair.in, which);
    const Spectrum f = m.local_evaluate(pair.in, pair.out, which);
    return pair.reflection() ? f : f / squared(m.relative_index(pair.in, pair.out));
  }

 public:
  static Spectrum evaluate(const Model& m, const Vector3& out, const Vector3& in, Transport transport, Lobes which) {
    const Pair pair(m, out, in);
    if (!pair.sides_agree() || !pair.asked(which)) return {};
    if (transport == Transport::importance) return local_importance(m, pair, which) * pair.importance_factor();
    const Spectrum value = m.local_evaluate(pair.out, pair.in, which);
    if (pair.reflection()) return value;
    return value / squared(m.relative_index(pair.out, pair.in));
  }

  static float density(const Model& m, const Vector3& out, const Vector3& in, Lobes which) {
    const Pair pair(m, out, in);
    return pair.sides_agree() && pair.asked(which) ? m.local_density(pair.out, pair.in, which) : 0;
  }

  static ScatterValue value_and_density(const Model& m, const Vector3& out, const Vector3& in, Transport transport,
                                        Lobes which) {
    const Pair pair(m, out, in);
    if (!pair.sides_agree() || !pair.asked(which)) return {};
    if (transport == Transport::radiance && pair.reflection()) return m.local_value_and_density(pair.out, pair.in, which);
    if (transport == Transport::importance && !m.reciprocal_)
      return {local_importance(m, pair, which) * pair.importance_factor(), m.local_density(pair.out, pair.in, which)};
    const ScatterValue local = m.local_value_and_density(pair.out, pair.in, which);
    if (transport == Transport::importance) return {local.value * pair.importance_factor(), local.density};
    return {local.value / squared(m.relative_index(pair.out, pair.in)), local.density};
  }

  static std::optional<ScatterSample> sample(const Model& m, const Vector3& out, float choice, Point2 u, Transport transport,
                                             Lobes which) {
    Pair pair;
    pair.out = m.frame_.to_local(out);
    pair.out_geometric = dot(m.normal_, out);
    // What passes straight on knows no normals.
    if (!(pair.out_geometric * pair.out.z > 0)) {
      which &= pass_through;
      if (which == no_lobes) return std::nullopt;
    }

    Scatter::LocalSample local;
    if (!m.local_sample(pair.out, choice, u, which, local) || !(local.density > 0)) return std::nullopt;
    pair.in = local.in;
    const Vector3 direction = m.frame_.to_world(local.in);
    pair.in_geometric = dot(m.normal_, direction);
    // Those of `out` agree, or nothing but passing through was asked.
    if (!(pair.in_geometric * pair.in.z > 0) && local.lobe != pass_through) return std::nullopt;

    Spectrum weight = local.value / local.density;
    if (transport == Transport::importance && !m.reciprocal_ && (local.lobe & smooth_lobes))
      weight = local_importance(m, pair, which) * (std::abs(pair.in.z) / local.density);
    if (local.lobe != pass_through) {
      if (transport == Transport::importance)
        weight *= pair.importance_factor();
      else if (!pair.reflection())
        weight = weight / squared(local.lobe & specular_lobes ? Spectrum(local.eta) : m.relative_index(pair.out, pair.in));
    }
    return ScatterSample{direction, weight, local.density, local.lobe, local.eta, local.dispersive};
  }

  static Spectrum albedo(const Model& m, const Vector3& out, Lobes which) {
    return m.local_albedo(m.frame_.to_local(out), which);
  }
};

/// The base of a model that is asked often: `class MyScatter final : public ScatterModel<MyScatter>`, with its local functions
/// public. A call of Scatter's is then one virtual call, in which what the model does not look at is not computed.
template <class Model>
class ScatterModel : public Scatter {
 protected:
  using Scatter::Scatter;
  ~ScatterModel() = default;

 private:
  using Answers = ScatterAnswers<Model>;
  const Model& model() const { return static_cast<const Model&>(*this); }

  Spectrum world_evaluate(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return Answers::evaluate(model(), out, in, transport, which);
  }
  float world_density(const Vector3& out, const Vector3& in, Transport, Lobes which) const final {
    return Answers::density(model(), out, in, which);
  }
  ScatterValue world_value_and_density(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return Answers::value_and_density(model(), out, in, transport, which);
  }
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, Transport transport,
                                            Lobes which) const final {
    return Answers::sample(model(), out, choice, u, transport, which);
  }
  Spectrum world_albedo(const Vector3& out, Lobes which) const final { return Answers::albedo(model(), out, which); }
};

}  // namespace etendue
