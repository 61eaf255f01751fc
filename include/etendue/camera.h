#pragma once
// Camera (a sensor): from film points to rays and back. Film coordinates are pixels: x to the right, y down, (0, 0) the
// upper left corner of the picture.

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
  float pdf = 0;         ///< [1/sr] at the scene point; a pinhole: distance^2 / cos (a delta in area, converted)
  float importance = 0;  ///< W_e [1/(m^2 sr)] of the connection, normalized as `Camera::importance`
  Point2 film;           ///< where on the film light from the point arrives
  float nearest = 0;     ///< [m] from the lens: what is nearer does not stand in the way (Camera::Reach)
};

/// A ray that a camera sends, and what its light counts.
struct CameraRay {
  Ray ray;
  Spectrum weight{
      1.0f};  ///< of the radiance that arrives along it: what glass and the lens's rim leave of it, over its density
};

/// Densities with which a camera ray is drawn when film points are uniform over the whole film.
struct CameraPdf {
  float position = 0;   ///< [1/m^2] on the lens; 1 for a pinhole
  float direction = 0;  ///< [1/sr]
};

class Camera : public Component {
 public:
  using Interface = Camera;
  using Parent = Component;
  static void describe(Description<Camera>&);

  float shutter_open = 0, shutter_close = 0;  ///< [s]
  /// How long the shutter takes to open all the way and to close [s]: its opening grows and shrinks linearly.
  float shutter_opening = 0, shutter_closing = 0;

  /// A time for a uniform number, as likely as the shutter is open.
  float shutter_time(float u) const;
  /// How far open the shutter is at a time, from 0 to 1.
  float shutter_efficiency(float time) const;

  /// Where a camera is, in the coordinates of the world, and about how far from it what it looks at [m]; 0: unknown.
  struct Place {
    DoublePoint3 position;
    double distance = 0;
  };
  /// Where it is when the shutter opens: asked before it is prepared. The renderer counts from near there, or from the middle
  /// of what is seen, so that floats are fine where they have to be. A camera that does not say has everything counted from the
  /// origin.
  virtual std::optional<Place> place() const { return std::nullopt; }
  /// The point of the world that the renderer counts from: for a camera that says its place, rays, lens points and points it is
  /// asked about are relative to it. Set by the Job before the camera is prepared.
  DoublePoint3 world_centre;

  /// What is seen along a ray lies so far from its lens point [m]. A camera may leave out what is nearer than a plane across
  /// its axis, or farther than another: for its own rays, and light on its way to the lens, such things are not there. All
  /// other light knows of them: they cast shadows, and mirrors show them.
  struct Reach {
    float nearest = 0, farthest = infinity;
  };

  /// Told by the Job before rendering: the size of the whole picture in pixels.
  virtual void set_film(int width, int height) = 0;
  /// The ray that brings light to a film point through a lens point given by `lens` (two uniform numbers), as far as it is a
  /// matter of geometry. The ray's cone covers a pixel. It begins and ends where its `reach` does.
  virtual Ray ray(Point2 film, Point2 lens, float time) const = 0;
  /// The same with what real lenses do to light: it may be held back (false: the sample is black, and counts), weakened, and go
  /// ways of its own for each wavelength (Wavelengths::drop_secondary; the factor belongs into the weight). By default `ray`,
  /// with weight 1: a pixel's value is then the mean radiance of its rays. `sample_lens` and `importance` must tell of the
  /// same.
  virtual bool sample_ray(Point2 film, Point2 lens, float time, Wavelengths&, CameraRay& sample) const {
    sample.ray = ray(film, lens, time);
    return true;
  }
  /// Whether `ray` looks at its lens point; cameras that do not may say so, which saves drawing two numbers.
  virtual bool has_lens() const { return true; }
  /// Whether all its rays are parallel: directions are then given by places.
  virtual bool parallel() const { return false; }
  /// The film point a ray from the scene ends at, if it meets lens and film; the ray is given as one the camera could
  /// have sent (from the lens outward).
  virtual std::optional<Point2> film_point(const Ray&) const = 0;
  /// A lens point seen from a point of the scene; empty when light from there cannot reach the film, or it is out of reach.
  /// `importance` is then without what depends on wavelengths; light is multiplied by `lens_weight`, too.
  virtual std::optional<LensSample> sample_lens(const Point3& from, float time, Point2 u) const = 0;
  /// What the lens leaves of light of these wavelengths that comes by a sample of `sample_lens`.
  virtual Spectrum lens_weight(const LensSample&, const Wavelengths&) const { return Spectrum(1.0f); }
  /// Importance W_e of a ray the camera could have sent [1/(m^2 sr)]; 0 outside the film. Its integral over lens area
  /// and projected solid angle is 1 for the whole film (per steradian alone for a pinhole, per area for parallel rays).
  virtual float importance(const Ray&) const = 0;
  virtual CameraPdf pdf(const Ray&) const = 0;
  /// Of a ray from the lens, or one that the camera sent.
  virtual Reach reach(const Ray&) const { return {}; }
  /// Where on the lens a ray begins that the camera sent.
  Point3 lens_point(const Ray& sent) const { return sent.origin - reach(sent).nearest * sent.direction; }
};

}  // namespace etendue
