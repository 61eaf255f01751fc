#pragma once
// Denoising: the last stage of a render. It makes a second picture beside the rendered one, for outputs that request it.

#include "etendue/denoised_output.h"
#include "etendue/render/job.h"

namespace etendue {

/// The auxiliary features of each pixel for a denoiser, from this many samples: see Denoiser::denoised. The job must be
/// prepared, and must not change meanwhile; the features depend on it alone.
///
/// A camera path is followed through specular and null scattering to the first vertex that has a non-delta lobe, emits, or is
/// the last one. The albedo feature is the albedo at this vertex times the path's throughput, and the normal feature is the
/// normal on the viewer's side. The albedo of emitters, of infinite ones too, and of media is 1.
Image denoising_guides(const Job&, int samples, int threads);

/// The denoised picture, with the bias recorded in its metadata. Channels that describe noise, or hold parts of the light, are
/// left out. Throws Error.
Image denoised(const Denoiser&, const Job&, const Image& picture, int threads);

/// Wraps all outputs that are not wrapped yet, so that each picture gets a denoised version beside it.
std::vector<Ref<Output>> with_denoising(const std::vector<Ref<Output>>&);

/// The paths of the denoised pictures, for the outputs that have one; `stem` as for Output::path.
std::vector<std::string> denoised_paths(const std::vector<Ref<Output>>&, const std::string& stem);

/// Throws Errors if a denoiser of these outputs cannot run on this machine.
void require_denoisers(const std::vector<Ref<Output>>&);

/// The tone map that is applied to the picture of an output; null: none.
const ToneMap* tone_map_of(const Job&, const Output&);

/// Warns if these outputs denoise a picture of a prepared job whose filter correlates the noise of neighbouring pixels.
void warn_of_wide_filter(const Job&, const std::vector<Ref<Output>>&);

/// Writes the denoised pictures, after the pictures themselves are written. Returns the paths written; failures are added to
/// `errors`.
std::vector<std::string> write_denoised(const Job&, const std::vector<Ref<Output>>&, const Image& picture,
                                        const std::string& stem, int threads, std::vector<Error>& errors);

}  // namespace etendue
