#pragma once
// The probability distributions used by the tests.

namespace etendue::verify {

/// The regularised incomplete beta function I_x(a, b), for x in [0, 1] and a, b > 0; to about 14 digits, relative to its value
/// even where it is tiny.
double incomplete_beta(double a, double b, double x);

/// P(|T| >= |t|) for Student's t with `freedom` > 0 degrees of freedom.
double student_two_sided(double t, double freedom);

/// The t > 0 with P(T >= t) = p, for p in (0, 1/2].
double student_upper_quantile(double p, double freedom);

/// The z >= 0 with P(|Z| >= z) = p for the standard normal distribution: a p-value in standard deviations. At most 37.
double normal_two_sided_quantile(double p);

}  // namespace etendue::verify
