#pragma once
// What cannot be computed in three bands.

namespace etendue {

class Job;

/// If the job's paths carry bands (RgbWavelengths), throws an Error at the first part of the job whose light needs wavelengths:
/// an index of refraction that varies, a component that refuses, a film of spectra.
void refuse_bands_where_they_lack(const Job&);

}  // namespace etendue
