#pragma once
// The parts of the library's table, by subject.

#include <span>

namespace etendue::osl {

struct Row;

std::span<const Row> constructor_rows();
std::span<const Row> mathematics_rows();
std::span<const Row> geometry_rows();
std::span<const Row> transform_rows();
std::span<const Row> color_rows();
std::span<const Row> step_rows();
std::span<const Row> noise_rows();
std::span<const Row> spline_rows();
std::span<const Row> derivative_rows();
std::span<const Row> string_rows();
std::span<const Row> world_rows();
std::span<const Row> dictionary_rows();
std::span<const Row> texture_rows();
std::span<const Row> closure_rows();
std::span<const Row> spectrum_rows();

}  // namespace etendue::osl
