#pragma once
// Imports of small pbrt scenes.

#include <gtest/gtest.h>

#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue::pbrt_test {

struct Imported {
  Ref<Job> job;
  std::vector<Error> notes;
  std::vector<Error> errors;

  /// The messages, one per line: "line:column: message".
  std::string told() const {
    std::string all;
    for (const auto* list : {&errors, &notes})
      for (const Error& e : *list)
        all += std::to_string(e.location.line) + ":" + std::to_string(e.location.column) + ": " + e.what() + "\n";
    return all;
  }
};

inline Imported import_file(const std::string& path) {
  Imported result;
  const Ref<Importer> importer = importer_of(path);
  Importing importing(path, {});
  try {
    result.job = ref_cast<Job>(importer->import(importing));
    result.notes = importing.notes();
  } catch (const Errors& e) {
    result.errors = e.errors;
  } catch (const Error& e) {
    result.errors = {e};
  }
  return result;
}

inline Imported import_text(const TemporaryFolder& folder, const std::string& text) {
  return import_file(folder.write("scene.pbrt", text));
}
inline Imported import_text(const std::string& text) {
  const TemporaryFolder folder;
  return import_text(folder, text);
}

/// A film of one pixel, and a camera at the origin that looks along +z with +x to the right.
inline std::string v4(const std::string& world, const std::string& film = "", const std::string& camera = "\"float fov\" 1",
                      const std::string& before = "") {
  return before + "Camera \"perspective\" " + camera + "\nFilm \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1 " +
         film + "\nPixelFilter \"box\"\nSampler \"independent\" \"integer pixelsamples\" 1\nWorldBegin\n" + world;
}
inline std::string v3(const std::string& world, const std::string& camera = "\"float fov\" 1", const std::string& before = "") {
  return before + "Camera \"perspective\" " + camera +
         "\nFilm \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\nSampler \"random\" \"integer pixelsamples\" "
         "1\nWorldBegin\n" +
         world + "\nWorldEnd\n";
}

/// The mean of the picture.
inline Xyz seen(const Imported& imported, int samples = 0) {
  if (!imported.job) {
    ADD_FAILURE() << imported.told();
    return {};
  }
  if (samples > 0) imported.job->renderer->samples = samples;
  imported.job->outputs.clear();
  return test::measure(imported.job).mean;
}

inline const Component& part(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const Ref<Component>* found = value.as<Ref<Component>>();
  EXPECT_TRUE(found && *found) << member;
  return **found;
}
inline double number(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const Number* found = value.as<Number>();
  if (found) return found->value;
  if (const Color* color = value.as<Color>(); color && *color) return double((*color)->at(550, ColorUse::coefficient));
  // A map that is a constant number.
  const Ref<Component>* map = value.as<Ref<Component>>();
  if (!map || !*map) return -1e30;
  const Value inner = get(**map, "value");
  if (const Number* n = inner.as<Number>()) return n->value;
  const Color* color = inner.as<Color>();
  return color ? double((*color)->at(550, ColorUse::coefficient)) : -1e30;
}
inline const Component& object(const Imported& imported, size_t index) { return *imported.job->scene->objects.at(index); }

}  // namespace etendue::pbrt_test
