#pragma once
// USD scenes in tests: reading and rendering them. They need usd-core; without it only the message about it is tested
// (foreign_models_test.cpp).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue::test {

inline const std::string y_up = "#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 1 )\n";

class UsdTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* python = std::getenv("ETENDUE_PYTHON");
    const std::string check = std::string(python && *python ? python : "python3") + " -c 'import pxr, numpy' 2>/dev/null";
    if (std::system(check.c_str()) != 0) GTEST_SKIP() << "usd-core is not installed";
  }

  /// The scene of a file; or null, with the message in error_.
  Ref<Scene> scene(const std::string& text, ImportOptions options = {}) {
    return scene_of(folder_.write("scene" + std::to_string(++number_) + ".usda", text), std::move(options));
  }
  Ref<Scene> scene_of(const std::string& path, ImportOptions options = {}) {
    notes_.clear();
    error_.clear();
    try {
      Importing importing(path, std::move(options));
      const Ref<Component> read = importer_of(path)->import(importing);
      for (const Error& note : importing.notes()) notes_.emplace_back(note.what());
      job_ = ref_cast<Job>(read);
      return job_ ? job_->scene : ref_cast<Scene>(read);
    } catch (const Error& error) {
      EXPECT_STREQ(error.location.file, path.c_str()) << error.what();
      error_ = error.what();
      return nullptr;
    }
  }

  bool told(const std::string& words) const {
    return std::ranges::any_of(notes_, [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }

  /// The picture that a camera takes of a scene and further objects.
  Image picture(const Ref<Scene>& scene, const std::string& camera, int size, int samples = 1, const std::string& more = "") {
    const Ref<Job> job = load_job_text(
        test::job_text("PathTracer { samples: " + std::to_string(samples) + ", max_depth: 2 }", camera, size, more), "t.etd");
    for (const Ref<SceneObject>& object : scene->objects) job->scene->objects.push_back(object);
    return test::rendered(job)->picture();
  }
  static double mean(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.at(x, y, 1);
    return sum / (double(image.width) * image.height);
  }
  /// A value of each of several objects of one file, computed for each alone; they are all called "l".
  std::vector<double> of_each(const std::string& head, const std::vector<std::string>& objects,
                              const std::function<double(const Ref<Scene>&)>& look) {
    std::string text = head;
    for (size_t i = 0; i < objects.size(); ++i) {
      std::string named = objects[i];
      named.replace(named.find("\"l\""), 3, "\"l" + std::to_string(i) + "\"");
      text += named;
    }
    const Ref<Scene> all = scene(text);
    std::vector<double> seen(objects.size(), -1);
    if (!all || all->objects.size() != objects.size()) {
      ADD_FAILURE() << error_ << "\n" << text;
      return seen;
    }
    const std::vector<Ref<SceneObject>> list = all->objects;
    for (size_t i = 0; i < list.size(); ++i) {
      all->objects = {list[i]};
      seen[i] = look(all);
    }
    return seen;
  }
  /// The luminance of a white diffuse patch at the origin that faces +z under each light: its illuminance over pi.
  std::vector<double> lit(const std::vector<std::string>& lights) {
    return of_each(y_up, lights, [&](const Ref<Scene>& s) {
      return mean(
          picture(s, "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], width: 0.001 }", 8, 64,
                  "Rectangle { corner: [-0.001, -0.001, 0] m, edge_u: [0.002, 0, 0] m, edge_v: [0, 0.002, 0] m, shader: "
                  "Lambertian { color: 1 } }"));
    });
  }
  static std::string light(const std::string& type, const std::string& members, double z, const std::string& more = "") {
    return "def " + type + " \"l\" " + more + " {\n" + members + "\ndouble3 xformOp:translate = (0, 0, " + std::to_string(z) +
           ")\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n";
  }

  static MeshData mesh_of(const SceneObject& object) {
    const Value file = get(object, "file"), part = get(object, "part");
    return read_mesh(file.as<FilePath>()->resolved(), *part.as<std::string>());
  }

  std::string written(const Ref<Scene>& s) { return s ? write_description(*s) : error_; }

  const TemporaryFolder folder_;
  std::vector<std::string> notes_;
  std::string error_;
  Ref<Job> job_;
  int number_ = 0;
};

/// One pixel as red, green and blue of linear sRGB.
inline std::array<double, 3> rgb(const Image& image, int x, int y) {
  const double X = image.at(x, y, 0), Y = image.at(x, y, 1), Z = image.at(x, y, 2);
  return {3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
          0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z};
}
inline void expect_rgb(const Image& image, int x, int y, std::array<double, 3> wanted, double within) {
  const auto seen = rgb(image, x, y);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], wanted[i], within) << "pixel " << x << ", " << y << " channel " << i;
}

}  // namespace etendue::test
