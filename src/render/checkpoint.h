#pragma once
// Checkpoint: the state of a render between two passes. It is written to files, compared with a job, and merged with the states
// of other parts of the render.

#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "etendue/film/film.h"
#include "etendue/render/job.h"

namespace etendue {

/// What determines the samples of a job, besides the seed and the indices of the samples.
struct Identity {
  /// A file that the description names.
  struct File {
    std::string name;  ///< as in the text
    std::uint64_t size = 0, hash = 0;
    bool operator==(const File&) const = default;
  };
  /// The description without seed, outputs, tone map, number of samples and limits; paths are relative to its folder.
  std::string text;
  std::vector<File> files;
};

/// Reads every file the description names, once.
Identity identity_of(const Job&);
/// The input files that a component and its parts name; outputs name no inputs.
std::vector<std::string> files_named_by(const Component&);
/// Registers these files as inputs (files/input_files.h), whether or not they have been read yet: files of the components, of
/// spectra, and of plugins that define their classes.
void note_inputs_of(const Component&);
/// The first difference, as a text for the user; empty: there is none. `whose` and `other_whose` name the owners: "the
/// checkpoint".
std::string difference(const Identity&, const std::string& whose, const Identity& other, const std::string& other_whose);

struct Checkpoint {
  /// The results of the passes, from which further passes continue.
  struct State {
    std::vector<std::byte> image, renderer, surfaces;  ///< of the Film, the RenderProcess and the SurfaceFilm
  };

  std::string version;  ///< of the program
  Identity identity;
  std::uint64_t seed = 0;
  std::uint32_t samples_per_pass = 1;
  std::uint32_t samples_wanted = 0;  ///< of the whole render, of which this may be a part
  std::vector<IndexRange> done;      ///< samples of each pixel: sorted disjoint ranges
  double seconds = 0;                ///< spent on these samples
  State state;
  /// The state before the last pass, if that pass was shorter than the others because the number of samples was no multiple of
  /// a pass. A continuation with more samples starts from this state: its sums are then the same as if that many samples had
  /// been wanted from the beginning.
  std::optional<State> before_short_pass;

  // Descriptions of the image, the tone map and the outputs, by which the picture can be written without the scene.
  std::string image, tone_map;
  std::vector<std::string> outputs;
  std::map<std::string, std::string> metadata;
};

/// The checkpoint of a prepared job that has not begun: everything except the state.
Checkpoint empty_checkpoint(const Job&, const Identity&, std::uint32_t samples_per_step);

/// Writes to a temporary file and renames it: the file is complete or unchanged. Throws Error with the path and the reason.
void write_checkpoint(const Checkpoint&, const std::string& path);
/// Writes the same bytes to a stream. Throws Error if the stream fails.
void write_checkpoint(const Checkpoint&, std::ostream&);
/// Throws Error with the path and the reason: not a checkpoint, too short, damaged, of another version.
Checkpoint read_checkpoint(const std::string& path);
/// Reads from a stream that contains one checkpoint and nothing else.
Checkpoint read_checkpoint(std::istream&);
/// Reads a checkpoint without its states, which are large; they are not checked either.
Checkpoint read_checkpoint_header(const std::string& path);
/// Removes the temporary files of this checkpoint that killed processes left in its folder.
void remove_leftovers(const std::string& path);

/// Why the samples of two checkpoints must not be added; empty: they may.
std::string mismatch(const Checkpoint&, const std::string& whose, const Checkpoint& other, const std::string& other_whose);

/// One checkpoint of all the samples in the files, which must be of the same job and have none in common; the order
/// does not matter. Throws Error.
Checkpoint merge_checkpoints(const std::vector<std::string>& paths);

/// The picture of a checkpoint, and a job without a scene whose outputs write it.
struct KeptPicture {
  Ref<Job> job;
  Image picture;
};
KeptPicture picture_of(const Checkpoint&);

// ---- sorted lists of ranges -------------------------------------------------------------------------------------------

/// How many indices are in the ranges.
std::uint32_t count(const std::vector<IndexRange>&);
/// Adds a range, joined to those it touches.
void insert(std::vector<IndexRange>&, IndexRange);
/// The parts of `whole` that are in none of the ranges.
std::vector<IndexRange> missing(const std::vector<IndexRange>&, IndexRange whole);
/// "samples 0 to 63, 128 to 191"
std::string samples_text(const std::vector<IndexRange>&);

/// Removes the incomplete pass from the end of the last range.
void drop_short_pass(std::vector<IndexRange>&, std::uint32_t samples_per_pass);

}  // namespace etendue
