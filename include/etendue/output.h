#pragma once
// Output: the interface of image file formats (part of Image in pbrt, of Bitmap and Film in Mitsuba). Files are written to a
// temporary file and renamed when complete.
//
// A new output must implement `extension`, `for_display` and `write_image`.

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
  Ref<ToneMap> tone_map;  ///< null: the Job's tone map if for_display(), else none

  /// The usual file name extension, with the dot.
  virtual std::string extension() const = 0;
  /// The path of the file: `file` if it is set, else `stem` with the usual extension.
  std::string path(const std::string& stem) const { return file.empty() ? stem + extension() : file.resolved(); }
  /// Whether the format is for display (bounded, tone mapped), or stores radiance.
  virtual bool for_display() const = 0;
  /// Writes the image (R G B if for_display or tone mapped, else X Y Z, then the layers) with its metadata to a path. Throws
  /// Error with the file and the reason; the previous content of the file is then unchanged.
  virtual void write_image(const Image&, const std::string& path) const = 0;
};

}  // namespace etendue
