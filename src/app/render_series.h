#pragma once
// Several renders in one process: several files, and frames of an animation.

#include <functional>
#include <map>

#include "app/render_options.h"

namespace etendue {

/// The files that the renders of one process write, so that none overwrites the images of another.
class Series {
 public:
  /// Throws Errors if another render of the series has claimed one of these files.
  void claim(const std::vector<Ref<Output>>& outputs, const RenderOptions&);

 private:
  std::map<std::string, std::string> claimed_;  // canonical paths, and the names of their renders
};

/// The text with its last run of '#' replaced by the number, padded with zeros to at least as many digits.
std::string numbered(const std::string& text, int frame);

/// If there is a frame number, puts it into the names of outputs. Throws Error where several frames would have the same name.
void number_outputs(const std::vector<Ref<Output>>& outputs, const RenderOptions&);

/// Whether all images exist, can be read to their end, have the size, and are of the same file and options as far as their
/// metadata tell. Reports images that are skipped on standard output, those that are rendered again on standard error.
bool are_whole(const std::vector<Ref<Output>>& outputs, const Job&, const RenderOptions&);

/// The options of one frame of one file. `several_frames`: it is one of several.
RenderOptions one_of(const RenderOptions&, const std::string& file, std::optional<int> frame, bool several_frames);

/// Renders each frame of each file. The errors of one render are reported and the others are still rendered; an interruption
/// ends the series.
int render_series(const RenderOptions&, const std::function<int(const RenderOptions&, Series&)>& render);

}  // namespace etendue
