#pragma once
// The state of a render at a pass boundary: in a file, compared with a job, and added to that of other parts.

#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "etendue/film/film.h"
#include "etendue/render/job.h"

namespace etendue {

/// What determines the samples of a job, besides the seed and the numbers of the samples.
struct Identity {
  /// A file that the description names.
  struct File {
    std::string name;  ///< as in the text
    std::uint64_t size = 0, hash = 0;
    bool operator==(const File&) const = default;
  };
  /// The description without seed, outputs, tone map, number of samples and limits, paths relative to its folder.
  std::string text;
  std::vector<File> files;
};

/// Reads every file the description names, once.
Identity identity_of(const Job&);
/// The files that a component and its parts name to be read; outputs name none.
std::vector<std::string> files_named_by(const Component&);
/// Notes all of them as inputs (files/input_files.h), whether or not they have been read yet: those of its parts, of spectra,
/// of plugins that its classes come from.
void note_inputs_of(const Component&);
/// What differs, in words for the user; empty: nothing. `whose` and `other_whose` say whose they are: "the checkpoint".
std::string difference(const Identity&, const std::string& whose, const Identity& other, const std::string& other_whose);

struct Checkpoint {
  /// What the passes made, from which further ones go on.
  struct State {
    std::vector<std::byte> image, renderer;  ///< of Film::save_state and Renderer::save_state
  };

  std::string version;  ///< of the program
  Identity identity;
  std::uint64_t seed = 0;
  std::uint32_t samples_per_pass = 1;
  std::uint32_t samples_wanted = 0;  ///< of the whole render, of which this may be a part
  std::vector<IndexRange> done;      ///< samples of each pixel: sorted, apart from each other
  double seconds = 0;                ///< spent on them
  State state;
  /// The state before the last pass when that was shorter than others, since the samples wanted were no multiple. Going on
  /// with more samples begins here: sums are then the same as if that many had been wanted at once.
  std::optional<State> before_short_pass;

  // To write the picture without the scene: descriptions of the image, the tone map and the outputs of the file.
  std::string image, tone_map;
  std::vector<std::string> outputs;
  std::map<std::string, std::string> metadata;
};

/// The checkpoint of a prepared job that has not begun: all but the state.
Checkpoint empty_checkpoint(const Job&, const Identity&, std::uint32_t samples_per_step);

/// Writes beside the path and renames: a file is whole or as it was. Throws Error naming the path and the reason.
void write_checkpoint(const Checkpoint&, const std::string& path);
/// The same bytes. Throws Error when the stream does not take them.
void write_checkpoint(const Checkpoint&, std::ostream&);
/// Throws Error naming the path and what is wrong: no checkpoint, too short, damaged, of another version.
Checkpoint read_checkpoint(const std::string& path);
/// Of a stream that holds one, and no more.
Checkpoint read_checkpoint(std::istream&);
/// The same without the states, which are large and are not looked at.
Checkpoint read_checkpoint_header(const std::string& path);
/// Removes what processes that were killed while they wrote this checkpoint left beside it.
void remove_leftovers(const std::string& path);

/// Why the samples of two must not be added; empty: they may.
std::string mismatch(const Checkpoint&, const std::string& whose, const Checkpoint& other, const std::string& other_whose);

/// One checkpoint of all the samples in the files, which must be of the same job and have none in common; the order
/// does not matter. Throws Error.
Checkpoint merge_checkpoints(const std::vector<std::string>& paths);

/// What writes the picture of a checkpoint: a job without a scene, and the picture.
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
/// What is in `whole` and in none of the ranges.
std::vector<IndexRange> missing(const std::vector<IndexRange>&, IndexRange whole);
/// "samples 0 to 63, 128 to 191"
std::string samples_text(const std::vector<IndexRange>&);

/// Removes the incomplete pass from the end of the last range.
void drop_short_pass(std::vector<IndexRange>&, std::uint32_t samples_per_pass);

}  // namespace etendue
