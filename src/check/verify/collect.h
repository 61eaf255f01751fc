#pragma once
// Which renderers are compared on a scene, and what they measure.

#include <functional>
#include <string>
#include <vector>

#include "agreement.h"
#include "etendue/render/render.h"

namespace etendue::verify {

/// A renderer to compare, ready for the job's scene.
struct Candidate {
  std::string name;  ///< its class, or the expression it was named by
  Ref<Renderer> renderer;
  std::vector<std::string> misses;  ///< of the scene's light, in words; compared all the same when forced
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

/// Without blanks at its ends.
std::string trimmed(const std::string&);

/// The renderer that an expression names: the job's own class alone is the job's own renderer with all its settings; any other,
/// "PathTracer{next_event: false}", is a new one. Throws Errors for what is none.
Ref<Renderer> named_renderer(const Job&, const std::string& expression, const std::string& option);
/// Gives a new renderer the job's sampler, light sampler and max_depth, unless its expression says otherwise; one that holds
/// another inside, for that as well. Throws Error when it cannot take them.
void take_over(Renderer& to, const Renderer& from);
/// The light of a scene that a renderer cannot find, in words.
std::vector<std::string> missed_light(const Renderer&, const SceneTraits&);

/// Renderers that find all light of a prepared job's scene. Without names: the job's own and one of each other class that is
/// unbiased. A name is a class (the job's own class: the job's own renderer) or an expression, "PathTracer{next_event: false}".
/// Those made here take over the job's sampler, light sampler and max_depth unless their expression says otherwise. `force`
/// keeps named ones that miss light. Throws Errors for what cannot be understood.
Choice choose_renderers(const Job&, const std::string& names, bool force);

struct CollectOptions {
  int samples = 4;     ///< per pixel and pass
  int passes = 16;     ///< of each renderer
  double seconds = 0;  ///< of each renderer, when not 0: as many passes as this takes, at least 8
  double inject = 1;   ///< factor on what the first renderer measures
  /// What a renderer cannot follow may be found while it renders. All but the first, which is the job's own, are then left out
  /// instead of ending everything.
  bool leave_out_refusing = false;
  /// Called before each pass with the renderer's place and the passes made; false ends it all.
  std::function<bool(size_t renderer, size_t passes)> go_on = {};
};

/// What one renderer did, besides the measurements.
struct RendererRun {
  Image picture;  ///< X Y Z, of all passes
  double seconds = 0;
  std::uint64_t samples = 0;  ///< over the whole picture, in all passes
  std::uint64_t bad_samples = 0;
  double length_share = 0;  ///< part of its light that it tells the length of
  /// Of a consistent renderer whose limit was measured (limit.h): where its passes were looked at, the means of Y over the
  /// tiles there, [pass][mark][tile], and how much more noise the limit has than the end of a pass. Empty of others.
  std::vector<std::uint32_t> marks;
  std::vector<std::vector<std::vector<double>>> tiles_at_marks;
  double limit_noise = 1;
};

struct Collected {
  Layout layout;
  std::vector<Measured> measured;
  std::vector<RendererRun> runs;
  bool complete = false;  ///< false: it was interrupted
  /// Candidates that refused the scene, by their place among all, and why: they have neither `measured` nor `runs`.
  std::vector<std::pair<size_t, std::string>> refused;
};

/// Sets a job's picture up for measuring: every sample counts for its own pixel alone, lengths are told apart. To be done
/// before the job is prepared.
void prepare_picture(Job&, int lengths);

/// A side [pixels] of tiles that divides a picture into enough of them.
int default_tile(const ImageBuffer&);

/// Whether a renderer's limit can be told from its steps.
bool tells_limit(const Renderer&);

/// Takes those that refused the scene out of what was chosen.
void leave_out_refused(Choice&, const Collected&);

/// Runs all passes. Meanwhile the job has other renderers and seeds.
Collected collect(Render&, const std::vector<Candidate>&, int tile, const CollectOptions&);

}  // namespace etendue::verify
