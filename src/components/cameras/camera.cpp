// The shutter, which all cameras have.

#include "etendue/camera.h"

namespace etendue {

void Camera::describe(Description<Camera>& d) {
  d.summary("Where a picture is taken from, and how (a sensor).")
      .group("Shutter")
      .member<&Camera::shutter_open>("shutter_open", "s", "time at which the shutter opens", soft(0, 1))
      .member<&Camera::shutter_close>("shutter_close", "s", "time at which the shutter closes; not before it opens", soft(0, 1))
      .member<&Camera::shutter_opening>(
          "shutter_opening", "s", "how long it takes to open all the way, from shutter_open on; its opening grows linearly",
          at_least(0), soft(0, 1))
      .member<&Camera::shutter_closing>("shutter_closing", "s", "how long it takes to close all the way, until shutter_close",
                                        at_least(0), soft(0, 1));
}

// The opening as a function of time is a trapezium of height 1. With the ramps a and b and the whole time T its area is
// T - (a + b) / 2; the area before t is t^2 / (2 a) in the first ramp, t - a / 2 after it, and in the last ramp the whole area
// less (T - t)^2 / (2 b).
float Camera::shutter_time(float u) const {
  if (!(shutter_close > shutter_open)) return shutter_open;
  if (shutter_opening == 0 && shutter_closing == 0) return lerp(u, shutter_open, shutter_close);
  const double whole = double(shutter_close) - double(shutter_open), a = double(shutter_opening), b = double(shutter_closing);
  const double area = whole - (a + b) / 2, before = double(u) * area, after = area - before;
  const double t = before < a / 2  ? std::sqrt(2 * a * before)
                   : after < b / 2 ? whole - std::sqrt(2 * b * after)
                                   : a / 2 + before;
  return clamp(float(double(shutter_open) + t), shutter_open, shutter_close);
}

float Camera::shutter_efficiency(float time) const {
  if (time < shutter_open || time > shutter_close) return 0;
  const float opened = shutter_opening > 0 ? (time - shutter_open) / shutter_opening : 1;
  const float left = shutter_closing > 0 ? (shutter_close - time) / shutter_closing : 1;
  return std::min({opened, left, 1.0f});
}

static const Register<Camera> registered;

}  // namespace etendue
