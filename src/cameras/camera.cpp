// What all cameras have in common: the shutter.

#include "etendue/camera.h"

namespace etendue {

void Camera::describe(Description<Camera>& d) {
  d.summary("Where a picture is taken from, and how (a sensor).")
      .member<&Camera::shutter_open>("shutter_open", "s", "time at which the shutter opens")
      .member<&Camera::shutter_close>("shutter_close", "s", "time at which the shutter closes; not before it opens");
}

static const Register<Camera> registered;

}  // namespace etendue
