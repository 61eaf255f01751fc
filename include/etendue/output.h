#pragma once
// Output: writes a picture to a file, beside it first and renamed when whole.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/tone_map.h"

namespace etendue {

class Output : public Component {
 public:
  using Interface = Output;
  using Parent = Component;
  static void describe(Description<Output>&);

  FilePath file;          ///< empty: the render description's name with the format's ending
  Ref<ToneMap> tone_map;  ///< null: the Job's for formats that are looked at, none for those that keep radiance

  /// The usual ending, with the dot.
  virtual std::string extension() const = 0;
  /// Where the picture goes, if an output without a file goes to `stem` with the usual ending.
  std::string path(const std::string& stem) const { return file.empty() ? stem + extension() : file.resolved(); }
  /// Whether the format is for looking at (bounded, tone mapped) or keeps the radiance itself.
  virtual bool for_display() const = 0;
  /// Writes the picture (R G B when for_display or tone mapped, else X Y Z, then layers) with its metadata to a path.
  /// Throws Error naming the file and the reason; the path then holds what it held before.
  virtual void write_image(const Image&, const std::string& path) const = 0;
};

}  // namespace etendue
