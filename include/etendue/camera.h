#pragma once
// Camera (Camera in pbrt, Sensor in Mitsuba): maps film points to rays and back. Film coordinates are in pixels: x to the
// right, y down, (0, 0) the upper left corner of the image.
//
// A new camera must implement `set_film`, `ray`, `film_point`, `sample_lens`, `importance` and `pdf`; the last four serve light
// tracing and bidirectional algorithms. Optional: `place` for precision far from the origin, `sample_ray` and `lens_weight` for
// vignetting and dispersion of lenses, `has_lens`, `parallel` for orthographic cameras, `reach` for clipping planes.

#include <optional>

#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"
#include "etendue/core/transform.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// A point on the lens seen from a point of the scene.
struct LensSample {
  Point3 lens;           ///< where on the lens
  Vector3 direction;     ///< unit, from the scene point to the lens
  float distance = 0;    ///< [m]
  float pdf = 0;         ///< [1/sr] at the scene point; for a pinhole distance^2 / cos (a delta in area, converted)
  float importance = 0;  ///< W_e [1/(m^2 sr)] of the connection, normalized as `Camera::importance`
  Point2 film;           ///< the film point that light from the scene point arrives at
  float nearest = 0;     ///< distance from the lens [m]; surfaces nearer than this do not occlude (Camera::Reach)
};

/// A sampled camera ray with its weight.
struct CameraRay {
  Ray ray;
  /// The factor for the radiance that arrives along the ray: transmittance of the glass and vignetting, over the ray's pdf.
  Spectrum weight{1.0f};
};

/// The pdfs of a camera ray when film points are uniform over the whole film.
struct CameraPdf {
  float position = 0;   ///< [1/m^2] on the lens; 1 for a pinhole
  float direction = 0;  ///< [1/sr]
};

/// See the beginning of the file for what subclasses implement.
class Camera : public Component {
 public:
  using Interface = Camera;
  using Parent = Component;
  static void describe(Description<Camera>&);

  float shutter_open = 0, shutter_close = 0;  ///< [s]
  /// The durations of opening and closing the shutter [s]; the open fraction changes linearly.
  float shutter_opening = 0, shutter_closing = 0;

  /// Samples a time [s] by a uniform number, with a pdf proportional to shutter_efficiency.
  float shutter_time(float u) const;
  /// The open fraction of the shutter at a time, from 0 to 1.
  float shutter_efficiency(float time) const;

  /// The camera's position in world space, and the approximate distance of the objects in view [m]; 0: unknown.
  struct Place {
    DoublePoint3 position;
    double distance = 0;
  };
  /// The place when the shutter opens; called before `prepare`. The origin of rendering space (pbrt's term: the space of all
  /// float coordinates while rendering) is chosen near this position, or at the centre of a scene that is far away, so that
  /// floats are precise in view. Without a place it is the world's origin.
  virtual std::optional<Place> place() const { return std::nullopt; }
  /// The origin of rendering space, in world space. For a camera that implements `place`, all rays, lens points and scene
  /// points are relative to it. Set by the Job before the camera is prepared.
  DoublePoint3 rendering_origin;

  /// The interval of distances from the lens point in which a ray sees surfaces [m]. A camera may have near and far clipping
  /// planes perpendicular to its axis. Surfaces beyond them are ignored by camera rays and by connections to the lens; for all
  /// other rays they exist: they cast shadows and are seen in mirrors.
  struct Reach {
    float nearest = 0, farthest = infinity;
  };

  /// Sets the size of the whole image in pixels. Called by the Job before rendering.
  virtual void set_film(int width, int height) = 0;
  /// The ray through a film point and the lens point sampled by `lens` (two uniform numbers): its geometry only, without
  /// vignetting. The ray's cone covers a pixel. The ray begins and ends at the limits of its `reach`.
  virtual Ray ray(Point2 film, Point2 lens, float time) const = 0;
  /// The same with the effects of real lenses. Light may be blocked (returns false: the sample is black, and counts),
  /// attenuated (the weight), or dispersed (calls Wavelengths::drop_secondary, and multiplies the weight by the returned
  /// factor). By default `ray` with weight 1: a pixel's value is then the mean radiance of its rays. `sample_lens` and
  /// `importance` must describe the same camera.
  virtual bool sample_ray(Point2 film, Point2 lens, float time, Wavelengths&, CameraRay& sample) const {
    sample.ray = ray(film, lens, time);
    return true;
  }
  /// Whether `ray` uses its argument `lens`. Returning false saves two random numbers.
  virtual bool has_lens() const { return true; }
  /// Whether the camera is orthographic: its rays are parallel, with a pdf per area [1/m^2] instead of per solid angle.
  virtual bool parallel() const { return false; }
  /// The film point at which light along a ray arrives, if it passes the lens and hits the film. The ray is given in the
  /// direction of camera rays, from the lens outward.
  virtual std::optional<Point2> film_point(const Ray&) const = 0;
  /// Samples a lens point as seen from a point of the scene. Empty when light from there does not reach the film, or the point
  /// is outside the clipping planes. The `importance` excludes factors that depend on wavelength: the light must also be
  /// multiplied by `lens_weight`.
  virtual std::optional<LensSample> sample_lens(const Point3& from, float time, Point2 u) const = 0;
  /// The transmittance of the lens per wavelength, for a sample of `sample_lens`.
  virtual Spectrum lens_weight(const LensSample&, const Wavelengths&) const { return Spectrum(1.0f); }
  /// The importance W_e of a camera ray [1/(m^2 sr)]; 0 outside the film. Its integral over lens area and projected solid angle
  /// is 1 for the whole film ([1/sr] for a pinhole, [1/m^2] for parallel rays).
  virtual float importance(const Ray&) const = 0;
  /// The pdfs of a camera ray; 0 outside the film.
  virtual CameraPdf pdf(const Ray&) const = 0;
  /// The reach of a camera ray, which may begin at the lens or at the near clipping plane.
  virtual Reach reach(const Ray&) const { return {}; }
  /// The lens point of a ray returned by `ray`, which begins at the near clipping plane if the camera has one.
  Point3 lens_point(const Ray& sent) const { return sent.origin - reach(sent).nearest * sent.direction; }
};

}  // namespace etendue
