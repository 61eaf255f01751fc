#include "etendue/render/job.h"

#include <unordered_set>

#include "describe/expansion.h"
#include "etendue/describe/bands.h"
#include "etendue/describe/registry.h"
#include "etendue/render/follows_polarization.h"
#include "etendue/transport/light_groups.h"
#include "film/picture_format.h"
#include "geometry/rendering_space.h"

namespace etendue {

void Job::describe(Description<Job>& d) {
  d.summary("A whole render: what is seen, how it is computed, and where the picture goes.",
            "Demoreuille & Shaw 2002, section 3.2.2")
      .group("Picture")
      .member<&Job::renderer>("renderer", "", "the algorithm")
      .member<&Job::camera>("camera", "", "where the picture is taken from", required)
      .member<&Job::scene>("scene", "", "what is in front of it", required, Effect::rebuild)
      .member<&Job::image>("image", "", "where samples are collected")
      .member<&Job::wavelengths>("wavelengths", "", "which wavelengths paths carry")
      .member<&Job::groups>("groups", "", "objects of the scene under one name: see the layer crypto_group of the image")
      .group("Display")
      .member<&Job::tone_map>("tone_map", "", "from radiance to display values", Effect::retone)
      .member<&Job::outputs>("outputs", "", "files to write", Effect::retone)
      .group("Sampling and limits")
      .member<&Job::seed>("seed", "1", "chooses the random numbers", at_least(0))
      .member<&Job::time_limit>("time_limit", "s", "stops after the pass in which this time is over; 0: no limit", at_least(0),
                                Effect::none)
      .member<&Job::error_limit>(
          "error_limit", "1",
          "stops when the mean relative standard error of pixels is below this; 0: no limit. A small bias: samples that "
          "underestimate their error, as when rare light is missing, end the render early",
          at_least(0), Effect::none);
}
static const Register<Job> registered;

namespace {

template <class T>
Ref<T> created(const char* name) {
  return ref_cast<T>(Registry::instance().create(name));
}

/// Renderers that show something else than light make their colours of a few wavelengths: their spectra would mean nothing.
void require_light(const Renderer& renderer, const ImageBuffer& image) {
  if (image.format()->bands && renderer.finds() == no_paths)
    renderer.fail({}, "shows no light, so that there is no spectrum for a SpectralFilm");
  if (image.format()->stokes && !keeps_stokes(renderer)) {
    std::string others;
    for (const std::string& name : polarization_followers()) others += (others.empty() ? "" : ", ") + name;
    image.fail("layers", renderer.class_info().name +
                             " does not tell the polarization of its light, so that the layer 'stokes' "
                             "cannot be kept; these do: " +
                             others);
  }
}

}  // namespace

Job::Job()
    : renderer(created<Renderer>("PathTracer")),
      image(created<ImageBuffer>("ImageBuffer")),
      wavelengths(created<WavelengthSampler>("HeroWavelengths")),
      tone_map(created<ToneMap>("AgXToneMap")) {}

Job::~Job() = default;

void Job::set_rendering_origin(const DoublePoint3& new_origin) {
  rendering_origin_ = new_origin;
  camera->rendering_origin = new_origin;
  etendue::set_rendering_origin(*scene, new_origin, camera->shutter_open);
}

/// The camera's position, rounded to multiples of 16 times its viewing distance (the distance rounded up to a power of two).
/// Floats have a relative spacing of 2^-24, so this is fine enough for what the camera sees (decision 020), and a camera that
/// moves a little leaves the prepared scene unchanged.
DoublePoint3 Job::viewpoint() const {
  const std::optional<Camera::Place> place = camera->place();
  if (!place || !is_finite(place->position)) return {};
  if (!(place->distance > 0) || !std::isfinite(place->distance)) return place->position;
  const double step = 16 * std::exp2(std::ceil(std::log2(place->distance)));
  const auto rounded = [&](double x) { return step * std::round(x / step); };
  const DoublePoint3 point{rounded(place->position.x), rounded(place->position.y), rounded(place->position.z)};
  return is_finite(point) ? point : place->position;
}

void Job::before_prepare() {
  if (!camera || !scene) return;
  viewpoint_ = viewpoint();
  opened_ = camera->shutter_open;
  set_rendering_origin(viewpoint_);
}

namespace {

/// Heterogeneous media are evaluated in the object space of their object. Within a nested scene a path inside the medium does
/// not have this transform.
void refuse_heterogeneous_media_within(const Scene& scene, bool nested) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (nested && object->interior && !object->interior->homogeneous())
      object->fail("interior",
                   "a heterogeneous medium is not supported in a nested scene; put the object into the outer scene");
    if (const Scene* inner = scene_within(*object)) refuse_heterogeneous_media_within(*inner, true);
  }
}

/// Whether a scene is so far from the camera that coordinates relative to the camera would be too coarse for it. Its own centre
/// is then the origin.
bool is_far(const Camera& camera, const Scene& scene) {
  constexpr float far = 4;
  const Vector3 away = scene.centre() - Point3{};
  return camera.place() && length(away) > far * scene.radius() && is_finite(away);
}

}  // namespace

void Job::require_parts() const {
  if (!renderer) fail("renderer", "a job needs a renderer, such as PathTracer {}");
  if (!camera) fail("camera", "a job needs a camera, such as PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m }");
  if (!scene) fail("scene", "a job needs a scene, such as BvhScene { objects: [ Sphere {} ] }");
  if (!image) fail("image", "a job needs an image buffer, such as ImageBuffer { width: 512, height: 512 }");
  if (!wavelengths) fail("wavelengths", "a job needs a wavelength sampler, such as HeroWavelengths {}");
  if (camera->shutter_close < camera->shutter_open) camera->fail("shutter_close", "the shutter closes before it opens");
  for (const Ref<Output>& output : outputs)
    if (!output) fail("outputs", "an output is none");
  for (const Ref<ObjectGroup>& group : groups)
    if (!group) fail("groups", "a group is none");
}

/// Throws Error if a layer of the image cannot be made of the rest of the job.
void Job::require_layers() const {
  const LightGroups known(*scene, *image);  // throws Error for an unknown name
  require_groups(groups, *scene);
  const SurfaceLayers& surfaces = image->format()->surfaces;
  if (surfaces.ranks[size_t(MatteKind::group)] > 0 && groups.empty())
    image->fail("layers",
                fmt::format("'{}' needs groups: Job {{ groups: [ ObjectGroup {{ name: \"…\", objects: [ \"…\" ] }} ] … }}",
                            matte_layers[size_t(MatteKind::group)]));
  if (surfaces.motion() && surfaces.motion_time == 0 && !(camera->shutter_close > camera->shutter_open))
    image->fail(
        "layers",
        "'motion' leads to the ends of the shutter, which is open for no time: set the camera's shutter_close, or follow "
        "the motion for some seconds, as in 'motion = 0.04'");
}

namespace {

constexpr const char* advice = ", which RgbWavelengths do not carry: use HeroWavelengths";

/// Each wavelength is refracted into a direction of its own. (A metal, whose index is complex, refracts nothing.)
void refuse_dispersion(const Component& c) {
  for (const Member& m : c.class_info().members) {
    if (m.meaning != Meaning::index || m.kind != Kind::color) continue;
    const Value value = m.get(c, m);
    const Color* const index = value.as<Color>();
    if (!index || !*index || (*index)->imaginary() || !(*index)->varies()) continue;
    const ValueRange range = range_of(**index, ColorUse::coefficient);
    if (range.least < range.most)
      c.fail(m.name, "this index of refraction disperses light into its wavelengths" + std::string(advice) +
                         ", or give the index as a number");
  }
}

void refuse(const Component& c) {
  refuse_dispersion(c);
  const auto* const needs = dynamic_cast<const NeedsWavelengths*>(&c);
  if (!needs) return;
  try {
    needs->refuse_bands();
  } catch (const Error& e) {
    throw Error(e.what() + std::string(advice), e.location.known() ? e.location : c.location_of());
  }
}

/// If the job's paths carry bands (RgbWavelengths), throws an Error at the first part of the job whose light needs wavelengths:
/// an index of refraction that varies, a component that refuses, a film of spectra.
void refuse_bands_where_they_lack(const Job& job) {
  if (!in_bands(job.wavelengths->sample({}, 0))) return;
  if (job.image->format()->bands) job.image->fail({}, "holds spectra of wavelengths" + std::string(advice));
  std::unordered_set<const Component*> seen{&job};
  std::vector<const Component*> left{&job};
  while (!left.empty()) {
    const Component& c = *left.back();
    left.pop_back();
    refuse(c);
    for (const Component* const part : components_of(c))
      if (seen.insert(part).second) left.push_back(part);
  }
}

}  // namespace

void Job::prepare() {
  require_parts();
  if (is_far(*camera, *scene)) {
    set_rendering_origin(rendering_origin_ + DoubleVector3(scene->centre() - Point3{}));
    prepare_tree(*scene);
    camera->prepare();
  }
  refuse_heterogeneous_media_within(*scene, false);
  camera->set_film(image->width, image->height);
  require_layers();
  require_light(*renderer, *image);
  refuse_bands_where_they_lack(*this);
}

void Job::prepare_again() {
  require_parts();
  refuse_heterogeneous_media_within(*scene, false);
  camera->set_film(image->width, image->height);
  require_layers();
  require_light(*renderer, *image);
  refuse_bands_where_they_lack(*this);
}

bool Job::rendering_origin_is_stale() const {
  if (!camera || !scene) return false;  // preparing reports it
  return viewpoint() != viewpoint_ || camera->shutter_open != opened_ || (origin_is_near_camera() && is_far(*camera, *scene));
}

}  // namespace etendue
