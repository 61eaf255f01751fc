#pragma once
// Queries on a film's saved state that are possible without a film.

#include <span>

#include "etendue/film/film.h"

namespace etendue {

/// The Estimator of the algorithm that made a state. Throws Error if it is not the state of a film.
Estimator estimator_of(std::span<const std::byte> state);

}  // namespace etendue
