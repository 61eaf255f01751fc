#pragma once
// Images of all directions as squares, in which every pixel has the same solid angle.

#include "images/linear_image.h"

namespace etendue {

/// Such a square as an image in longitude and latitude for an EnvironmentEmission, twice as wide and as high as the square.
/// The middle of the square is at the top, its four corners at the bottom; halfway, its right is towards +x and its lower side
/// towards -z. Throws Error when it is no square.
LinearImage unfold_equal_area(const LinearImage& square);

}  // namespace etendue
