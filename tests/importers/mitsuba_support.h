#pragma once
// Imports of small scenes of Mitsuba.

#include <gtest/gtest.h>

#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue::mitsuba_test {

struct Imported {
  Ref<Job> job;
  std::vector<Error> notes, errors;

  /// The messages, one per line: "line:column: message".
  std::string told() const {
    std::string all;
    for (const auto* list : {&errors, &notes})
      for (const Error& e : *list)
        all += std::to_string(e.location.line) + ":" + std::to_string(e.location.column) + ": " + e.what() + "\n";
    return all;
  }
  const Component& object(size_t index) const { return *job->scene->objects.at(index); }
};

using Parameters = std::vector<std::pair<std::string, std::string>>;

inline Imported import_file(const std::string& path, const Parameters& parameters = {}) {
  Imported result;
  Importing importing(path, {}, parameters);
  try {
    result.job = ref_cast<Job>(importer_of(path)->import(importing));
    result.notes = importing.notes();
  } catch (const Errors& e) {
    result.errors = e.errors;
  } catch (const Error& e) {
    result.errors = {e};
  }
  return result;
}
inline Imported import_text(const TemporaryFolder& folder, const std::string& text, const Parameters& parameters = {}) {
  return import_file(folder.write("scene.xml", text), parameters);
}
inline Imported import_text(const std::string& text, const Parameters& parameters = {}) {
  const TemporaryFolder folder;
  return import_text(folder, text, parameters);
}

/// A sensor with its transform; by default at the origin, looking along +z.
inline std::string sensor(const std::string& more = "<float name=\"fov\" value=\"1\"/>", int width = 1, int height = 1) {
  return "<sensor type=\"perspective\">" + more + "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" +
         std::to_string(width) + "\"/><integer name=\"height\" value=\"" + std::to_string(height) +
         "\"/><rfilter type=\"box\"/></film><sampler type=\"independent\"><integer name=\"sample_count\" value=\"4096\"/>"
         "</sampler></sensor>\n";
}
inline std::string integrator(int depth = 2, const std::string& type = "path") {
  return "<integrator type=\"" + type + "\"><integer name=\"max_depth\" value=\"" + std::to_string(depth) +
         "\"/></integrator>\n";
}
inline std::string scene(const std::string& content, const std::string& version = "3.0.0") {
  return "<scene version=\"" + version + "\">\n" + content + "</scene>\n";
}
/// A scene with a camera of one pixel.
inline std::string seen_scene(const std::string& content, int depth = 2, const std::string& version = "3.0.0") {
  return scene(sensor() + integrator(depth) + content, version);
}

/// A square of 20 m at z = 5 that faces the camera.
inline std::string wall(const std::string& inside, const std::string& more = "") {
  return "<shape type=\"rectangle\"><transform name=\"to_world\">" + more +
         "<scale value=\"10\"/><rotate y=\"1\" angle=\"180\"/><translate z=\"5\"/></transform>" + inside + "</shape>\n";
}
inline std::string diffuse(const std::string& reflectance) {
  return "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" + reflectance + "\"/></bsdf>";
}

/// The mean of the picture; there must be no message.
inline Xyz seen(const Imported& imported, int samples = 0) {
  EXPECT_EQ(imported.told(), "");
  if (!imported.job) return {};
  if (samples > 0) imported.job->renderer->samples = samples;
  imported.job->outputs.clear();
  return test::measure(imported.job).mean;
}

inline const Component& part(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const Ref<Component>* found = value.as<Ref<Component>>();
  if (!found || !*found) throw Error("no component '" + member + "'");
  return **found;
}
inline double number(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const Number* found = value.as<Number>();
  return found ? found->value : -1e30;
}

}  // namespace etendue::mitsuba_test
