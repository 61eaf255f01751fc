#pragma once
// Equal-area images of directions: squares in which every pixel has the same solid angle.

#include "images/linear_image.h"

namespace etendue {

/// Resamples such a square to an image in longitude and latitude for an EnvironmentEmission, twice as wide and as high as the
/// square. The middle of the square is the top (+y), its four corners are the bottom (-y); on the horizon its right is towards
/// +x and its lower side towards -z. Throws Error if the image is not square.
LinearImage unfold_equal_area(const LinearImage& square);

}  // namespace etendue
