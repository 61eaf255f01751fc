#pragma once
// What can be told of a film's saved state before there is a film for it.

#include <span>

#include "etendue/film/film.h"

namespace etendue {

/// Of which kind of algorithm a state is. Throws Error when it is no film's.
Estimator estimator_of(std::span<const std::byte> state);

}  // namespace etendue
