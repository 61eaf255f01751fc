#pragma once
// Chooses the renderers to compare on a scene, and measures them.

#include <functional>
#include <string>
#include <vector>

#include "agreement.h"
#include "check/naming/named_renderer.h"
#include "etendue/render/render.h"

namespace etendue::verify {

/// A renderer to compare, ready for the job's scene.
struct Candidate {
  std::string name;  ///< its class, or the expression that names it
  Ref<Renderer> renderer;
  std::vector<std::string>
      misses;  ///< descriptions of the scene's light that it misses; it is compared nevertheless with `force`
};

struct LeftOut {
  std::string name, reason;
};

struct Choice {
  std::vector<Candidate> candidates;
  std::vector<LeftOut> left_out;
};

/// The expressions of a list "A, B{x: [1, 2]}": parts between commas outside of brackets and texts.
std::vector<std::string> split_expressions(const std::string& list);

/// The text without white space at its ends.
std::string trimmed(const std::string&);

/// Descriptions of the scene's light that a renderer misses.
std::vector<std::string> missed_light(const Renderer&, const SceneTraits&);

/// A renderer with the name that results give it.
struct NamedRenderer {
  std::string name;
  Ref<Renderer> renderer;
};

/// The renderers of a list "A,B{x: 1}", whose names are its expressions (named_renderer). Throws Errors for invalid ones.
std::vector<NamedRenderer> named_renderers(const Job&, const std::string& list);

/// The renderers to compare on a prepared job's scene, which find all of its light. Without named ones: the job's own and one
/// of each other class that is unbiased. Renderers other than the job's own take over its sampler, light sampler and max_depth
/// unless these members were written. `force` keeps named ones that miss light. Throws Errors if a name occurs twice.
Choice choose_renderers(const Job&, const std::vector<NamedRenderer>& named, bool force);
/// The same with a list as of named_renderers.
Choice choose_renderers(const Job&, const std::string& list, bool force);
/// Throws Error, with the reasons why others are left out, if there are not two renderers to compare.
void require_two(const Choice&);
/// The name of a renderer that does not report its light by path length, as no class that is declared at run time does, such as
/// one written in Python: the picture has to be without path lengths then. Empty: all renderers report it.
std::string without_lengths(const Choice&);

struct CollectOptions {
  int samples = 4;     ///< per pixel and pass
  int passes = 16;     ///< of each renderer
  double seconds = 0;  ///< of each renderer, when not 0: as many passes as this takes, at least 8
  double inject = 1;   ///< factor on the measurements of the first renderer, for self tests
  /// A renderer may throw during rendering for a feature of the scene that it does not support. All but the first, which is the
  /// job's own, are then left out; without this option the error is rethrown.
  bool leave_out_refusing = false;
  /// Called before each pass with the renderer's index and the number of its finished passes; false ends all.
  std::function<bool(size_t renderer, size_t passes)> go_on = {};
};

/// Statistics of one renderer's passes, in addition to the measurements.
struct RendererRun {
  Image picture;  ///< X Y Z, of all passes
  double seconds = 0;
  std::uint64_t samples = 0;  ///< over the whole image, in all passes
  std::uint64_t bad_samples = 0;
  bool lengths_asked = true;  ///< false: the picture has no layers of path lengths
  double length_share = 0;    ///< fraction of its light whose path length it reports
  /// For a consistent renderer whose limit was estimated (limit.h): the marks (numbers of samples) of its passes, the means of
  /// Y over the tiles at these, [pass][mark][tile], and the factor by which the limit is noisier than the end of a pass. Empty
  /// for others.
  std::vector<std::uint32_t> marks;
  std::vector<std::vector<std::vector<double>>> tiles_at_marks;
  double limit_noise = 1;
};

struct Collected {
  Layout layout;
  std::vector<Measured> measured;
  std::vector<RendererRun> runs;
  bool complete = false;  ///< false: it was interrupted
  /// Candidates that threw for this scene, by index, and the reason: they have neither `measured` nor `runs`.
  std::vector<std::pair<size_t, std::string>> refused;
};

/// Sets up a job's image for measuring: a box filter, so that each sample counts for its own pixel only, and separate path
/// lengths. To be called before the job is prepared.
void prepare_picture(Job&, int lengths);

/// A tile size [pixels] that divides an image into enough tiles.
int default_tile(const ImageBuffer&);

/// Whether a renderer's limit can be estimated from its steps.
bool tells_limit(const Renderer&);

/// Moves the candidates that threw for this scene from the chosen ones to those left out.
void leave_out_refused(Choice&, const Collected&);

/// Renders all passes. Meanwhile the job has other renderers and seeds; both are restored.
Collected collect(Render&, const std::vector<Candidate>&, int tile, const CollectOptions&);

}  // namespace etendue::verify
