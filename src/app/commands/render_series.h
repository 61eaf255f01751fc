#pragma once
// Several renders in one run of the program: files, and frames of films.

#include <functional>
#include <map>

#include "app/render_options.h"

namespace etendue {

/// What the renders of one run have written, so that none takes the place of another.
class Series {
 public:
  /// Throws Errors when a render before wrote, or will have written, one of these files.
  void claim(const std::vector<Ref<Output>>& outputs, const RenderOptions&);

 private:
  std::map<std::string, std::string> claimed_;  // paths in canonical spelling, and which render they are of
};

/// The text with its last run of '#' replaced by the number, with zeros before it to as many digits at least.
std::string numbered(const std::string& text, int frame);

/// Puts the number of the frame into the names of outputs, when there is one. Throws Error where several frames would have one
/// name.
void number_outputs(const std::vector<Ref<Output>>& outputs, const RenderOptions&);

/// Whether all pictures are there, can be read to their end, have the size and are of the same file and options, as far as
/// their formats tell; says on standard output what is left out.
bool are_whole(const std::vector<Ref<Output>>& outputs, const Job&, const RenderOptions&);

/// Renders each frame of each file. What is wrong with one is told and does not keep the others from being rendered; an
/// interruption does.
int render_series(const RenderOptions&, const std::function<int(const RenderOptions&, Series&)>& render);

}  // namespace etendue
