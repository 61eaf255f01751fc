#pragma once
// The last stage of a render: a second picture beside the one that was rendered, where an output wants it.

#include "etendue/denoised_output.h"
#include "etendue/render/job.h"

namespace etendue {

/// What a denoiser is told of each pixel beside its light, from so many samples: see Denoiser::denoised. Of a prepared job,
/// which must not change meanwhile; a function of it alone.
///
/// A camera path is followed through mirrors and clear glass, and what lets it pass, to the first vertex that scatters to all
/// sides, shines, or is the last; there the colour of what is scattered of white light counts, weakened by what the way let
/// through, and the normal towards the viewer. Luminaires, also far ones, are white; a medium has the colour of the way.
Image denoising_guides(const Job&, int samples, int threads);

/// The picture as a denoiser makes it, marked as biased in its texts. Layers that tell of its noise, or of parts of its light,
/// are left out. Throws Error.
Image denoised(const Denoiser&, const Job&, const Image& picture, int threads);

/// Wraps all outputs that are not wrapped yet: all pictures get a denoised one beside them.
std::vector<Ref<Output>> with_denoising(const std::vector<Ref<Output>>&);

/// Where the denoised pictures of those outputs go that have any; `stem` as for Output::path.
std::vector<std::string> denoised_paths(const std::vector<Ref<Output>>&, const std::string& stem);

/// Throws Errors when a denoiser of these outputs cannot work here.
void require_denoisers(const std::vector<Ref<Output>>&);

/// What the picture of an output is shown through; null: nothing.
const ToneMap* tone_map_of(const Job&, const Output&);

/// Warns when these outputs denoise a picture of a prepared job whose filter makes noise alike in neighbouring pixels.
void warn_of_wide_filter(const Job&, const std::vector<Ref<Output>>&);

/// Writes them, when the pictures themselves are written. Returns the paths of those that were; what went wrong is added to
/// `errors`.
std::vector<std::string> write_denoised(const Job&, const std::vector<Ref<Output>>&, const Image& picture,
                                        const std::string& stem, int threads, std::vector<Error>& errors);

}  // namespace etendue
